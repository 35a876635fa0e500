//! Screen, long screen, `summary.json`, JUnit and page have the same sentences, numbers and names.

use crate::prelude::*;

fn untagged(page: &str) -> String {
    let texts = page.split('<').map(|part| part.split_once('>').map_or(part, |(_, text)| text));
    texts.collect::<Vec<_>>().concat()
}

fn plain(text: &str) -> String {
    let mut out = text.replace('\u{2212}', "-").replace('\u{202f}', "");
    for (digit, raised) in "⁰¹²³⁴⁵⁶⁷⁸⁹".chars().enumerate() {
        out = out.replace(raised, &digit.to_string());
    }
    let out = out.replace('⁻', "-").replace("\u{d7}10", "e").replace('\u{2264}', "<=").replace('\u{2265}', ">=");
    let out = ["&lt;|<", "&gt;|>", "&quot;|\"", "&#39;|'", "&amp;|&"].into_iter().fold(out, |out, pair| {
        let (mark, letter) = pair.split_once('|').unwrap();
        out.replace(mark, letter)
    });
    out.split_whitespace().collect::<Vec<_>>().join(" ").to_lowercase()
}

fn texts<'v>(list: &'v Value, key: &str) -> Vec<&'v str> {
    list.as_array().unwrap().iter().filter_map(|one| one[key].as_str()).collect()
}

fn with_intervals(text: &str) -> Vec<String> {
    let found = text.match_indices('[').filter_map(|(at, _)| {
        let end = at + text[at..].find(']')?;
        let value = text[..at].trim_end().rsplit(' ').next()?;
        let is_number = |one: &str| one.trim_end_matches('%').parse::<f64>().is_ok();
        let is_interval = text[at + 1..end].split(", ").all(|one| one == "?" || is_number(one));
        (is_number(value) && is_interval).then(|| format!("{value} {}", &text[at..=end]))
    });
    found.collect()
}

struct OutcomeRow {
    title: String,
    unit: String,
    median: String,
    max: String,
}

fn outcome_rows(screen: &str) -> Vec<OutcomeRow> {
    let cells = |line: &str| {
        let cells = line.split("  ").map(str::trim).filter(|cell| !cell.is_empty());
        cells.map(str::to_owned).collect::<Vec<String>>()
    };
    let mut lines = screen.lines().skip_while(|line| !line.starts_with("  outcome "));
    let heads = lines.next().map_or_else(Vec::new, cells);
    let place = |name: &str| heads.iter().position(|head| head == name);
    let (Some(median), Some(max)) = (place("median"), place("max")) else { return Vec::new() };
    let row = |cells: Vec<String>| {
        let (title, unit) = cells[0].rsplit_once(", ").unwrap_or((&cells[0], ""));
        let value = |place: usize| cells[place].split(" [").next().unwrap_or_default().to_owned();
        let [title, unit] = [title, unit].map(str::to_owned);
        OutcomeRow { title, unit, median: value(median), max: value(max) }
    };
    lines.map(cells).take_while(|cells| cells.len() == heads.len()).map(row).collect()
}

/// The numbers of the page are those of the `screen`, each with its unit, which the axis of the figure has too.
fn of_page(name: &str, (rows, screen): (&[OutcomeRow], &str), page: &str, found: &Found) {
    for (at, _) in page.match_indices("median ").filter(|_| !screen.contains(" more outcome")) {
        let rest = &page[at..];
        let said: String = rest.chars().take(120).collect();
        let number = |text: Option<&str>| text?.split([',', ' ']).next()?.parse::<f64>().ok();
        let Some((_, after)) = said.split_once(", max ") else { continue };
        let [median, max] = [number(said.strip_prefix("median ")), number(Some(after))];
        let Some((median, max)) = median.zip(max) else { continue };
        let near = |shown: &str, value: f64| {
            let (digits, power) = shown.split_once('e').unwrap_or((shown, "0"));
            let decimals = digits.split_once('.').map_or(0, |(_, decimals)| decimals.len() as i32);
            // "-40" beside an interval of hundreds has one digit
            let zeros = if decimals == 0 { digits.len() - digits.trim_end_matches('0').len() } else { 0 };
            let place = 10f64.powi(power.parse::<i32>().unwrap_or(0) - decimals + zeros as i32);
            shown.parse::<f64>().is_ok_and(|shown| (shown - value).abs() <= 0.51 * place + 6e-3 * value.abs())
        };
        let is_unit = |unit: &str| after[after.find(' ').map_or(0, |at| at + 1)..].starts_with(&unit.to_lowercase());
        let is_it = |row: &OutcomeRow| near(&row.median, median) && near(&row.max, max) && is_unit(&row.unit);
        assert!(rows.iter().any(is_it), "{name}: {said}");
    }
    for figure in found.figures() {
        let text = |value: &Value| value.as_str().unwrap_or_default().to_owned();
        let is_of_it = |row: &&OutcomeRow| {
            text(&figure["name"]).starts_with("histogram_") && text(&figure["title"]).to_lowercase() == row.title
        };
        for row in rows.iter().filter(is_of_it) {
            assert_eq!(text(&figure["x"]["unit"]), row.unit, "{name}: {}", row.title);
        }
    }
}

/// Of a comparison with another seed: names, verdicts and numbers are those of the results.
fn compares(scratch: &ScratchFolder, name: &str, samples: &str, first: &Value) {
    let run = |arguments: &str| {
        let output = scratch.command(arguments).env("COLUMNS", "2000").output().unwrap();
        assert!(output.status.code().is_some_and(|code| ![2, 4].contains(&code)), "{name}: {arguments}: {output:?}");
        String::from_utf8(output.stdout).unwrap()
    };
    run(&format!("campaign {name} {samples} --seed 5 --out other --overwrite --no-report"));
    let second: Value = serde_json::from_str(&scratch.text("other/summary.json")).unwrap();
    let brief = run("compare r other");
    let (plain_brief, verbose) = (plain(&brief), plain(&run("compare r other --verbose --out c.json")));
    let file: Value = serde_json::from_str(&scratch.text("c.json")).unwrap();
    let list = |summary: &Value| summary["requirements"]["list"].as_array().unwrap().clone();
    for (place, (one, other)) in list(first).iter().zip(list(&second)).enumerate() {
        for requirement in [one, &other] {
            let (value, _) = requirement["found"].as_str().unwrap().split_once(" [").unwrap_or_default();
            let judged = format!("{} {value}", requirement["verdict"].as_str().unwrap());
            assert!(verbose.contains(&plain(judged.trim_end())), "{name}: {judged}: {verbose}");
        }
        assert!(verbose.contains(&plain(one["in_short"].as_str().unwrap())), "{name}: {verbose}");
        let compared = &file["requirements"][place];
        assert_eq!([&compared["first"], &compared["second"]], [&one["verdict"], &other["verdict"]], "{name}");
    }
    for line in brief.lines().filter(|line| !line.contains("--verbose")) {
        let words = plain(line);
        let cells = line.split("  ").map(plain).filter(|cell| !cell.is_empty());
        assert!(verbose.contains(&words) || cells.into_iter().all(|cell| verbose.contains(&cell)), "{name}: {line}");
    }
    for found in with_intervals(&plain_brief) {
        assert!(verbose.contains(&found), "{name}: {found}: {verbose}");
    }
}

fn agrees(scratch: &ScratchFolder, name: &str, samples: &str) {
    let run = |arguments: &str| {
        let output = scratch.command(arguments).env("COLUMNS", "2000").output().unwrap();
        assert!(output.status.code().is_some_and(|code| ![2, 4].contains(&code)), "{name}: {arguments}: {output:?}");
        String::from_utf8(output.stdout).unwrap()
    };
    let brief = run(&format!("campaign {name} {samples} --out r --overwrite --junit j.xml"));
    let (again, verbose, json) = (run("show r"), plain(&run("show r --verbose")), run("show r --json"));
    assert_eq!(json, scratch.text("r/summary.json"), "{name}");
    let body = |text: &str| {
        text.lines().filter(|line| line.starts_with(' ')).map(str::to_owned).collect::<Vec<_>>().join("\n")
    };
    assert_eq!(body(&brief.replace(name, "r/plan.toml")), body(&again), "{name}");
    let summary: Value = serde_json::from_str(&json).unwrap();
    let page = scratch.text("r/report.html");
    let page = page.split("<script").next().unwrap().replace("</summary>", " </summary>");
    let page = plain(&untagged(&page));
    let brief_text = brief;
    let (brief, junit) = (plain(&body(&brief_text)), plain(&scratch.text("j.xml")));
    let has = |place: &str, text: &str, said: &str| {
        assert!(
            text.contains(&plain(said).trim_end_matches('.').to_owned()),
            "{name}: {place} has not `{said}`: {text}"
        );
    };
    let list = &summary["requirements"]["list"];
    for one in list.as_array().unwrap() {
        let [short, found, says] = ["in_short", "found", "says"].map(|key| one[key].as_str().unwrap());
        for (place, text) in [("screen", &brief), ("long screen", &verbose), ("page", &page), ("JUnit", &junit)] {
            has(place, text, short);
        }
        has("screen", &brief, found);
        has("page", &page, found);
        has("long screen", &verbose, says);
        has("page", &page, says);
        if one["verdict"] != "PASS" {
            has("JUnit", &junit, says);
        }
    }
    for said in summary["warnings"].as_array().unwrap().iter().map(|said| said.as_str().unwrap()) {
        for (place, text) in [("screen", &brief), ("long screen", &verbose), ("page", &page)] {
            has(place, text, said);
        }
    }
    let drivers = texts(&summary["drivers"], "says");
    for said in &drivers {
        has("long screen", &verbose, said);
        if summary["samples"] != 1 {
            has("page", &page, said);
        }
    }
    for (_, rest) in brief.match_indices("what drives ").map(|(at, _)| brief.split_at(at)) {
        assert!(drivers.iter().any(|said| rest.contains(&plain(said))), "{name}: {rest}");
    }
    for found in with_intervals(&brief) {
        has("long screen", &verbose, &found);
    }
    let rows = outcome_rows(&brief_text);
    of_page(name, (&rows, &brief), &page, &Found::of_page(&scratch.text("r/report.html")));
    compares(scratch, name, samples, &summary);
    for column in texts(&summary["observables"], "name").into_iter().filter(|column| column.contains('_')) {
        assert!(!brief.contains(column), "{name}: {column} is no name for people: {brief}");
    }
    for wrong in ["more than 100%", "nan", "inf "] {
        assert!(!brief.contains(wrong), "{name}: {wrong}: {brief}");
    }
}

/// Law: each sentence, number and name of one renderer is that of the others, in every shipped campaign; of those of
/// the CubeSat in the shortest.
#[test]
fn shipped_campaigns_are_said_once() {
    let campaigns = root().join("campaigns");
    let mut files: Vec<_> = fs::read_dir(&campaigns).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.retain(|file| {
        let name = file.file_stem().unwrap().to_string_lossy();
        file.extension().is_some_and(|kind| kind == "toml") && (!name.starts_with("cubesat") || name == "cubesat_slew")
    });
    files.sort();
    let some = &|half: usize| {
        let scratch = folder(&format!("said-once-{half}"));
        for file in files.iter().skip(half).step_by(2) {
            let text = fs::read_to_string(file).unwrap();
            let samples = if text.contains("kind = \"table\"") { "" } else { "--samples 24" };
            agrees(&scratch, &file.display().to_string(), samples);
        }
    };
    // the longest test of the program, on two threads
    std::thread::scope(|scope| {
        for half in [0, 1] {
            scope.spawn(move || some(half));
        }
    });
}

/// The same of hard ones: runs that fail in several ways, all runs lost, one run, few events, every run the same.
#[test]
fn hard_campaigns_are_said_once() {
    let scratch = folder("said-once-hard");
    let require = |statement: &str| format!("[[require]]\nobservable = \"energy_error_max\"\n{statement}\n");
    let free = campaign_without_debris().replace("samples = 600", "samples = 60");
    let events = "[[event]]\nname = \"slow\"\nquantity = \"angular_rate_rad_s\"\nvalue = 31.0\n";
    let lost = free.replace("tolerance = 1e-10", "tolerance = 1e-10\nmax_steps = 1");
    for (name, text) in [
        ("mixed", mixed_failures() + &require("quantile = 0.9\nat_most = 1e-9")),
        ("lost", lost + &require("fraction = 0.9\nat_most = 1e-9")),
        ("one", free.replace("samples = 60", "samples = 1") + &require("mean = true\nat_most = 1.0")),
        ("none", free.clone()),
        ("events", free.clone() + events),
        ("two", free.clone() + &require("quantile = 0.9\nat_most = 3e-16") + &require("fraction = 0.5\nat_most = 1.0")),
    ] {
        scratch.file(&format!("{name}.toml"), &text);
        agrees(&scratch, &format!("{name}.toml"), "");
    }
}
