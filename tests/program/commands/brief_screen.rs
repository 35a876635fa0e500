//! One screen of 24 lines of 80 characters for a campaign: its question first, its verdict last.

use crate::prelude::*;

fn said(scratch: &ScratchFolder, command: &mut Command, code: i32) -> (String, String) {
    said_at(80, scratch, command, code)
}

fn said_at(width: usize, scratch: &ScratchFolder, command: &mut Command, code: i32) -> (String, String) {
    let output = command.current_dir(&scratch.0).env("COLUMNS", width.to_string()).output().unwrap();
    let [out, err] = [output.stdout, output.stderr].map(|text| String::from_utf8_lossy(&text).into_owned());
    assert_eq!(output.status.code(), Some(code), "{command:?}\n{out}{err}");
    (out.clone(), out + &err)
}

#[test]
fn a_campaign_fits_a_screen() {
    let scratch = ScratchFolder::new("brief-screen");
    let shipped = root().join("campaigns");
    for (name, code, question) in [
        ("spin_sweep", 0, "How large are the conservation errors of a run, "),
        ("net_launch", 5, "How likely is the spacecraft to reach the state "),
        ("slew_closed", 5, "How far off does a small satellite point after a slew "),
        ("detumble", 0, "How long do wheels and thrusters take "),
        ("acceptance", 3, "Does this spacecraft, integrated by the default method, "),
    ] {
        let file = shipped.join(format!("{name}.toml"));
        let run = |options: &[&str]| {
            let mut command = scratch.command("campaign");
            said(&scratch, command.arg(&file).args(["--samples", "200"]).args(options), code)
        };
        let (out, all) = run(&[]);
        assert_fits(&all, 24, 80);
        assert!(out.starts_with(question), "{name}:\n{out}");
        answers_all(&scratch, name, code);

        let summary = scratch.summary(&format!("results/{name}"));
        let list = summary["requirements"]["list"].as_array().unwrap();
        let count = |word: &str| list.iter().filter(|one| one["verdict"] == word).count();
        let counted = ["PASS", "FAIL", "UNDECIDED"].map(|word| (count(word), word));
        let counted = counted.iter().filter(|(count, _)| *count > 0).map(|(count, word)| format!("{count} {word}"));
        let verdict =
            if list.is_empty() { "200 runs computed".to_owned() } else { counted.collect::<Vec<_>>().join(", ") };
        let page = format!("results/{name}/report.html");
        assert_eq!(out.lines().last(), Some(format!("{verdict} -> {page}").as_str()), "{out}");
        assert!(scratch.path(&page).is_file());

        let is_verdict =
            |line: &&str| ["PASS", "FAIL", "UNDECIDED"].iter().any(|word| line.trim_start().starts_with(word));
        let words = out.lines().filter(is_verdict);
        assert_eq!(words.count(), list.len(), "{out}");
        for (name, words) in
            [("omega_se_s_x_", "angular velocity about s1"), ("energy_error_max", "maximum energy error")]
        {
            let is_asked = list.is_empty()
                || list.iter().any(|one| one["observable"].as_str().is_some_and(|of| of.starts_with(name)));
            assert_eq!(out.contains(words), is_asked, "{out}");
        }
        let (verbose, _) = run(&["--verbose", "--overwrite"]);
        assert_eq!((verbose.lines().next(), verbose.lines().last()), (out.lines().next(), out.lines().last()));
        assert!(verbose.lines().count() > 2 * out.lines().count() || name == "spin_sweep", "{verbose}");
        assert_says(&verbose, ["maximum energy error", "worst conservation error"]);
    }
}

/// Law: at every width the screen says what was asked, whether it is met and how sure that is, what decides it, and the
/// run to look at with the command that replays it; runs that were lost or failed are counted.
fn answers_all(scratch: &ScratchFolder, name: &str, code: i32) {
    let result = format!("results/{name}");
    let summary = scratch.summary(&result);
    for width in [80, 120] {
        let mut command = scratch.command("show");
        let (_, out) = said_at(width, scratch, command.arg(&result), code);
        assert_fits(&out, 24, width);
        let words = out.split_whitespace().collect::<Vec<_>>().join(" ");
        for one in summary["requirements"]["list"].as_array().unwrap() {
            let [short, found] = ["in_short", "found"].map(|key| one[key].as_str().unwrap());
            assert!(words.contains(short) && words.contains(found), "{width}: {short}, {found}\n{out}");
        }
        let drivers = summary["drivers"].as_array().unwrap();
        let has_driver = drivers.iter().any(|one| !one["inputs"].as_array().unwrap().is_empty());
        let is_said = |one: &Value| words.contains(one["says"].as_str().unwrap());
        assert!(drivers.iter().any(is_said) || !has_driver, "{width}: no driver\n{out}");
        for one in summary["missions"].as_array().into_iter().flatten() {
            let is_counted = words.contains(&format!("{} ", one["count"]));
            let is_good = ["launched", "not_failed"].iter().any(|end| one["end"] == *end) || one["count"] == 0;
            assert!(is_counted || is_good, "{width}: {one}\n{out}");
        }
        let replay = words.split_once(": spindrift simulate ").expect(&out).1;
        let sample = replay.split_once("--sample ").expect(&out).1.split(' ').next().unwrap();
        scratch.prints(&format!("simulate {result}/plan.toml --sample {sample}"), 0);
    }
}

#[test]
fn brackets_have_their_own_confidence() {
    let scratch = folder("brackets");
    let required =
        "[[require]]\nobservable = \"rate_w1_final_rad_s\"\nfraction = 0.5\nat_most = 1e9\nconfidence = 0.8\n";
    scratch.file("c.toml", &(campaign() + required + "[statistics]\nconfidence = 0.9\n"));
    let out = scratch.prints_at("campaign c.toml --samples 60 --out r", 0, 120);
    assert_says(&out, ["requirement, with 80% confidence", "found [90%]"]);
    assert!(!out.contains("[80%]"), "{out}");
}

#[test]
fn the_last_line_is_the_verdict_and_the_page() {
    let scratch = folder("last-line");
    let require = "[[require]]\nobservable = \"rate_w1_final_rad_s\"\nfraction = 0.01\nat_most = 1e9\n";
    scratch.file("mixed.toml", &(mixed_failures() + require));
    let last = |arguments: &str, code: i32| {
        let (out, _) = said(&scratch, &mut scratch.command(arguments), code);
        out.lines().last().unwrap_or_default().to_owned()
    };
    let made = last("campaign mixed.toml --out r", 1);
    let ok = ended(&scratch.rows("r")).iter().filter(|(_, status)| status == "ok").count();
    let all = column(&scratch.rows("r"), "sample_id").len();
    assert!(ok < all, "some fail");
    assert_eq!(made, format!("1 PASS, {ok} of {all} runs computed -> r/report.html"));
    for again in ["campaign mixed.toml --out r", "finish r"] {
        assert_eq!(last(again, 1), made, "{again}");
    }
    assert!(last("report r", 0).starts_with(&format!("{made} (")));
    scratch.file("plain.toml", &campaign());
    assert_eq!(last("campaign plain.toml --samples 20 --no-report --out p", 0), "20 runs computed -> p");
    assert_eq!(last("report p", 0).split(" (").next(), Some("20 runs computed -> p/report.html"));
}

#[test]
fn colour_adds_only_itself() {
    let scratch = folder("colour");
    scratch.prints("new mine.toml", 0);
    let plain = |text: &str| {
        let mut rest = text.split('\x1b');
        let first = rest.next().unwrap_or_default().to_owned();
        rest.fold(first, |text, part| text + part.split_once('m').unwrap().1)
    };
    for (arguments, code, word) in [
        ("campaign mine.toml --out r", 0, "\x1b[32m\x1b[1mPASS\x1b[0m"),
        ("campaign --help", 0, "\x1b[1mUsage:\x1b[0m"),
        ("campaign mine.toml --samples many", 2, "\x1b[31m\x1b[1merror:\x1b[0m"),
        ("campaign absent.toml", 2, "\x1b[31m\x1b[1merror:\x1b[0m"),
    ] {
        scratch.prints("campaign mine.toml --out r", 0);
        let without = scratch.prints(arguments, code);
        assert!(!without.contains('\x1b'), "{arguments}: {without:?}");
        assert_eq!(without, scratch.prints(&format!("{arguments} --color never"), code));
        let with = scratch.prints(&format!("{arguments} --color=always"), code);
        assert!(with.contains(word), "{arguments}: {with:?}");
        assert_eq!(plain(&with), without);
    }
    scratch.file("named.toml", &campaign().replace("[campaign]", "[campaign]\ndescription = \"\\u001b[31mred\""));
    let refused = scratch.prints("campaign named.toml --color always", 2);
    assert!(!refused.contains("\x1b[31mred"), "{refused:?}");
}

#[test]
fn the_worst_campaigns_fit_a_screen() {
    let scratch = ScratchFolder::new("worst-screens");
    let shipped = root().join("campaigns");
    let run = |name: &str, options: &str, code: i32| {
        let mut command = scratch.command("campaign");
        let command = command.arg(shipped.join(format!("{name}.toml"))).args(options.split_whitespace());
        let (out, _) = said(&scratch, command, code);
        let is_fit = |line: &str| line.chars().count() <= 80 || line.contains(": spindrift simulate ");
        assert!(out.lines().count() <= 24 && out.lines().all(is_fit), "{options}: {}\n{out}", out.lines().count());
        assert!(out.lines().last().is_some_and(|line| line.contains(" -> ")), "{out}");
        out
    };
    let out = run("net_launch", "--samples 60 --set integrator.max_steps=4600 --out lost --no-report", 3);
    let ended = ended(&scratch.rows("lost"));
    let lost = ended[1..].iter().filter(|(_, status)| status != "ok").count();
    assert!((40..59).contains(&lost), "{lost}");
    let words = out.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(words.contains(&format!("NOT COMPUTED: {lost} of 59 dispersed runs")), "{out}");
    let is_said =
        words.contains(&format!("{lost} step_limit: ")) && words.contains("to fix: increase integrator.max_steps");
    assert!(is_said, "{out}");
    let count = words.split([' ', ';', ',', ')', '(']).filter(|word| *word == lost.to_string()).count();
    assert!(count <= 3 && !words.contains("not computed"), "{count} times {lost}:\n{out}");

    let out = run("spin_sweep", "--samples 50 --set integrator.max_steps=3 --out all --no-report", 1);
    let is_said = !["driver", "no statistics"].iter().any(|word| out.contains(word));
    assert!(is_said && out.contains("NOT COMPUTED: 49 of 49 dispersed runs"), "{out}");
    assert_says(run("net_launch", "--samples 3 --out three --no-report", 5), ["6 UNDECIDED"]);
    let out = run("net_launch", "--samples 1 --out one --no-report", 5);
    let value = out.lines().find(|line| line.contains("total impulse, N s")).unwrap();
    let impulse = column(&scratch.rows("one"), "impulse_total_n_s")[0];
    let numbers: Vec<f64> = value.split_whitespace().filter_map(|word| word.parse().ok()).collect();
    assert!(numbers.len() == 1 && (numbers[0] / impulse - 1.0).abs() < 6e-3 && !out.contains("driver"), "{out}");
    run("spin_sweep", "--samples 3 --out few --no-report", 0);
}

#[test]
fn every_screen_fits_its_width() {
    let scratch = folder("every-screen");
    for (command, code) in [
        ("campaign small.toml --samples 20 --out whole --verbose", 0),
        ("campaign small.toml --samples 20 --out lost --verbose --set integrator.max_steps=3", 1),
        ("campaign small.toml --samples 20 --out brief --set integrator.max_steps=3", 1),
        ("verify whole", 0),
        ("verify lost", 0),
        ("simulate small.toml --sample 3", 0),
        ("simulate small.toml --set integrator.max_steps=3", 1),
        ("check small.toml --set integrator.max_steps=3", 1),
        ("check small.toml --set colour=1", 2),
        ("columns nonsense", 2),
    ] {
        let (_, all) = said(&scratch, &mut scratch.command(command), code);
        let is_fit = |line: &str| line.chars().count() <= 80 || line.trim_start().starts_with("spindrift ");
        assert!(all.lines().all(is_fit), "{command}:\n{all}");
        let digits = |word: &str| word.chars().filter(char::is_ascii_digit).count();
        let is_long = |word: &str| word.contains('.') && word.parse::<f64>().is_ok() && digits(word) > 12;
        assert!(!all.split_whitespace().any(is_long), "{command}:\n{all}");
    }
}

#[test]
#[cfg(target_os = "linux")]
fn messages_are_wrapped_on_a_terminal() {
    let scratch = folder("wrapped-messages");
    let comment = "seed = -7   # a comment that is longer than sixty letters of a line, as it is here";
    scratch.file("bad.toml", &campaign().replace("seed = 7", comment));
    let arguments = "check bad.toml --set colour=1";
    let piped = scratch.prints(arguments, 2);
    let is_long = |line: &str| line.contains("colour = 1: not a key of a campaign file (") && line.len() > 200;
    assert!(piped.lines().any(is_long), "{piped}");
    let program = env!("CARGO_BIN_EXE_spindrift");
    let mut command = Command::new("script");
    command.args(["-qec", &format!("stty cols 60; '{program}' {arguments} --color never"), "/dev/null"]);
    let Ok(output) = command.current_dir(&scratch.0).env_remove("COLUMNS").stdin(std::process::Stdio::null()).output()
    else {
        println!("skipped: no command `script`");
        return;
    };
    let shown = String::from_utf8_lossy(&output.stdout).replace('\r', "");
    let words = |text: &str| text.split_whitespace().map(str::to_owned).collect::<Vec<_>>();
    assert_eq!(words(&shown), words(&piped));
    let marked = shown.lines().filter(|line| line.trim_start().starts_with('|')).count();
    assert!(marked == 2 && shown.lines().count() > piped.lines().count(), "{shown}");
    assert!(shown.lines().all(|line| line.chars().count() <= 60 || line.trim_start().starts_with('|')), "{shown}");
}
