//! Hundreds of invalid files, made by one change of a valid one.

use crate::prelude::*;

/// Values that hardly any key takes; each key gets three.
const VALUES: [&str; 18] = [
    "-1",
    "nan",
    "\"text\"",
    "[]",
    "1e300",
    "true",
    "inf",
    "{}",
    "0",
    "1979-05-27",
    "\"\"",
    "1e-300",
    "[[1], [2]]",
    "-inf",
    "1000000000000000000",
    "\"5 furlong\"",
    "[nan, 1, 2]",
    "-0.0",
];

fn other_texts() -> Vec<(&'static str, String)> {
    vec![
        ("nothing", String::new()),
        ("a line end", "\n".to_owned()),
        ("a comment", "# nothing\n".to_owned()),
        ("a byte order mark", format!("\u{feff}{EVERY_TABLE}")),
        ("Windows line ends", EVERY_TABLE.replace('\n', "\r\n")),
        ("old Mac line ends", EVERY_TABLE.replace('\n', "\r")),
        ("NUL", "\0\0\0\0".to_owned()),
        ("JSON", "{\"campaign\": {\"name\": \"x\", \"samples\": 10}}\n".to_owned()),
        ("YAML", "campaign:\n  name: x\n  samples: 10\n".to_owned()),
        ("XML", "<?xml version=\"1.0\"?>\n<campaign name=\"x\"/>\n".to_owned()),
        ("INI", "[campaign]\nname: x\n; a comment\n".to_owned()),
        ("a script", "#!/bin/sh\nset -e\nspindrift campaign x\n".to_owned()),
        ("CSV", "time_s,value\n0.0,1.5\n0.1,1.6\n".to_owned()),
        ("much CSV", "0.5,0.25,7\n".repeat(1000)),
        ("keys", (0..1000).map(|key| format!("k{key} = {key}\n")).collect()),
        ("tables", (0..1000).map(|key| format!("[t{key}]\n")).collect()),
        ("a long line", "x".repeat(100_000)),
        ("quotes", "\"".repeat(1000)),
        ("deep arrays", format!("a = {}1{}\n", "[".repeat(1000), "]".repeat(1000))),
        ("deep tables", format!("a = {}1{}\n", "{b = ".repeat(1000), "}".repeat(1000))),
        ("deep keys", format!("a{} = 1\n", ".a".repeat(1000))),
        ("a deep header", format!("[a{}]\n", ".a".repeat(1000))),
        ("an open text", "[campaign]\nname = \"x\n".to_owned()),
        ("an open long text", "[campaign]\nname = \"\"\"x\n".to_owned()),
        ("an open array", "[campaign]\nname = [1, 2\n".to_owned()),
        ("an open header", "[campaign\nname = \"x\"\n".to_owned()),
        ("half a file", EVERY_TABLE[..EVERY_TABLE.len() / 2].to_owned()),
        ("a file twice", EVERY_TABLE.repeat(2)),
        ("a file backwards", EVERY_TABLE.lines().rev().map(|line| format!("{line}\n")).collect()),
    ]
}

fn cases() -> Vec<(String, String)> {
    let lines: Vec<&str> = EVERY_TABLE.lines().collect();
    let with = |at: usize, changed: &[String]| -> String {
        let (before, after) = (&lines[..at], &lines[at + 1..]);
        let kept = |lines: &[&str]| lines.iter().map(|line| format!("{line}\n")).collect::<String>();
        kept(before) + &changed.iter().map(|line| format!("{line}\n")).collect::<String>() + &kept(after)
    };
    let mut cases = Vec::new();
    let mut keys = 0;
    for (at, line) in lines.iter().enumerate().filter(|(_, line)| !line.is_empty()) {
        let number = at + 1;
        cases.push((format!("line {number} is not there: {line}"), with(at, &[])));
        cases.push((format!("line {number} twice: {line}"), with(at, &[(*line).to_owned(), (*line).to_owned()])));
        let Some((key, _)) = line.split_once(" = ") else {
            let inner = line.trim_matches(['[', ']']);
            let other = if line.starts_with("[[") { format!("[{inner}]") } else { format!("[[{inner}]]") };
            cases.push((format!("line {number}: {other}"), with(at, &[other])));
            continue;
        };
        for third in 0..3 {
            let changed = format!("{key} = {}", VALUES[(3 * keys + third) % VALUES.len()]);
            cases.push((format!("line {number}: {changed}"), with(at, &[changed])));
        }
        keys += 1;
    }
    cases.extend(other_texts().into_iter().map(|(name, text)| (name.to_owned(), text)));
    cases
}

#[test]
fn every_key_is_told_by_line_key_and_value() {
    let lines: Vec<&str> = EVERY_TABLE.lines().collect();
    let (mut wrong, mut count) = (Vec::new(), 0);
    for (at, line) in lines.iter().enumerate() {
        let Some((key, was)) = line.split_once(" = ") else { continue };
        // a type that no key has, and a unit that no number has
        let values = if was.contains('"') { &["1979-05-27"][..] } else { &["1979-05-27", "\"5 furlong\""] };
        for value in values {
            let mut text = lines.clone();
            let changed = format!("{key} = {value}");
            text[at] = &changed;
            count += 1;
            let said = Plan::from_text("bad.toml", &text.join("\n"), Overrides::default());
            let problems = said.map_or_else(|error| error.problems, |_| Vec::new());
            let is_told = problems.iter().any(|problem| {
                problem.line == Some(at + 1)
                    && problem.key.rsplit('.').next() == Some(key)
                    && problem.value.as_deref() == Some(value)
            });
            if !is_told {
                wrong.push(format!("{}: {changed}: {problems:?}", at + 1));
            }
        }
    }
    assert!(wrong.is_empty() && count > 130, "{} of {count}:\n{}", wrong.len(), wrong.join("\n"));
}

/// Law: a message names file, key, what is allowed and a remedy; at most twenty problems are listed.
#[test]
fn invalid_files_are_refused_in_words() {
    let cases = cases();
    let (mut wrong, mut refused) = (Vec::new(), 0);
    let mut slowest = (0.0, String::new());
    for (name, text) in &cases {
        let start = Instant::now();
        if let Err(error) = Plan::from_text("bad.toml", text, Overrides::default()) {
            refused += 1;
            for problem in &error.problems {
                let is_said = !problem.key.is_empty() && !problem.allowed.is_empty() && !problem.remedy.is_empty();
                if problem.file != "bad.toml" || !is_said || problem.allowed.starts_with("must") {
                    wrong.push(format!("{name}: {problem}"));
                }
            }
            let with_excerpts = error.with_excerpts();
            if with_excerpts.lines().count() > 70 || with_excerpts.lines().any(|line| line.len() > 2000) {
                wrong.push(format!("{name}: {with_excerpts}"));
            }
        }
        let seconds = start.elapsed().as_secs_f64();
        if seconds > slowest.0 {
            slowest = (seconds, name.clone());
        }
    }
    assert!(wrong.is_empty(), "{} wrong:\n{}", wrong.len(), wrong.join("\n\n"));
    assert!(refused >= 300, "{refused} refused");
}

#[test]
fn many_problems_are_counted() {
    let text = format!("{EVERY_TABLE}{}", "\n[[actuation]]\nstart_s = -1\nend_s = -2\n".repeat(20_000));
    let error = Plan::from_text("bad.toml", &text, Overrides::default()).expect_err("40,000 problems");
    let said = error.to_string();
    assert_eq!(said.lines().count(), 21, "{said}");
    let more = said.lines().last().unwrap_or_default();
    let count: usize = more.split(' ').nth(1).and_then(|count| count.parse().ok()).unwrap_or_else(|| panic!("{more}"));
    assert!(more.starts_with("and ") && more.ends_with(" more problems") && count > 20_000, "{more}");
    let lines: Vec<usize> = error.problems.iter().filter_map(|problem| problem.line).collect();
    assert!(lines.is_sorted() && lines[0] > 100, "{lines:?}");
}

#[test]
fn large_files_have_a_limit() {
    let head = EVERY_TABLE.replace("duration_s = 10.0", "duration_s = 1e6");
    let arcs = |count: usize| -> String {
        let arc = |arc: usize| {
            format!("\n[[actuation]]\nstart_s = {}\nend_s = {}\nthrust_n = {{ p1 = 1 }}\n", 10 + arc, 11 + arc)
        };
        (0..count).map(arc).collect()
    };
    let read = |text: &str| Plan::from_text("bad.toml", text, Overrides::default());
    let plan = read(&(head.clone() + &arcs(20_000))).unwrap();
    assert_eq!(plan.nominal.actuation.len(), 20_001);
    let keys: String = (0..500_000).map(|key| format!("k{key}=1\n")).collect();
    let said = read(&keys).expect_err("too many keys").to_string();
    assert!(said.starts_with("bad.toml: file = 500000 keys: must be a campaign file of at most 400000 keys"), "{said}");
    assert_says(
        read(&"#".repeat(9 << 20)).expect_err("too large").to_string(),
        ["9437184 bytes: must be a campaign file of at most 8388608 bytes"],
    );
}

#[test]
fn problems_have_excerpts() {
    let text = EVERY_TABLE.replace("samples = 10", "samples = -10").replace("seed = 1", "sede = 1");
    let text =
        text.replace("axis = [0, 1, 0]", "axis = [0, 0, 0]").replace("half_width = 0.002", "half_width = 'wide'");
    let said = Plan::from_text("bad.toml", &text, Overrides::default()).expect_err("four problems").with_excerpts();
    for excerpt in [
        "    | samples = -10\n    |           ^^^\n",
        "    | sede = 1\n    | ^^^^\n",
        "    | axis = [0, 0, 0]\n    |        ^^^^^^^^^\n",
        "    | half_width = 'wide'\n    |              ^^^^^^",
    ] {
        assert!(said.contains(excerpt), "{excerpt}\n{said}");
    }
}
