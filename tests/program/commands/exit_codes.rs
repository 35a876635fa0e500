//! The exit code of every way in which a campaign ends, and which comes first.

use crate::prelude::*;

fn require(statement: &str, limit: &str) -> String {
    format!("[[require]]\nobservable = \"energy_error_max\"\n{statement}\n{limit}\n")
}

/// Law: the code follows from failed runs and verdicts, also for a result that is there already.
#[test]
fn exit_codes() {
    let scratch = folder("exit-codes");
    let pass = require("quantile = 0.95", "at_most = 1e-9");
    let fail = require("fraction = 0.5", "at_most = 1e-30");
    let undecided = require("quantile = 0.9999", "at_most = 1e-9");
    let mean = require("mean = true", "at_most = 1e-9");
    let derived = |expression: &str| {
        let observable = format!("[[observable]]\nname = \"flag\"\nexpression = \"{expression}\"\n");
        observable + &mean.replace("energy_error_max", "flag")
    };
    let [equal, constant] = ["if(initial.angular_velocity_rad_s.x > 1e9, 1, 0)", "0"].map(derived);
    let stuck = campaign().replace("tolerance = 1e-10", "tolerance = 1e-10\nmax_steps = 1");
    let thin = campaign() + NEGATIVE_WALLS;
    fs::create_dir(scratch.path("foreign")).unwrap();
    scratch.file("foreign/thesis.tex", "precious");
    let cases: &[(&str, String, &str, i32)] = &[
        ("done", campaign(), "", 0),
        ("passed", [campaign(), pass.clone(), mean.clone()].concat(), "", 0),
        ("failed runs", thin.clone(), "", 1),
        ("failed runs outside of the population", [thin.clone(), pass.clone()].concat(), "", 1),
        ("bad file", campaign().replace("seed = 7", "sead = 7"), "", 2),
        ("bad requirement", require("quantile = 95", "at_most = 1") + &campaign(), "", 2),
        ("a requirement failed", [campaign(), pass.clone(), fail.clone()].concat(), "", 3),
        ("one failed, one is undecided", [campaign(), undecided.clone(), fail.clone()].concat(), "", 3),
        ("one failed, and runs failed", [thin.clone(), fail.clone()].concat(), "", 3),
        ("runs that failed violate", [stuck.clone(), pass.clone()].concat(), "", 3),
        ("runs that failed have no mean", [stuck, mean].concat(), "", 3),
        ("foreign folder", campaign(), "--out foreign", 4),
        ("foreign folder and a failed requirement", [campaign(), fail].concat(), "--out foreign", 4),
        ("undecided", [campaign(), pass, undecided.clone()].concat(), "", 5),
        ("equal values", campaign() + &equal, "", 5),
        ("a constant", campaign() + &constant, "", 0),
        ("undecided, and runs failed", [thin, undecided].concat(), "", 5),
        ("no interval", campaign() + "[design]\nkind = \"sobol\"\n" + &require("quantile = 0.5", "at_most = 1"), "", 5),
    ];
    for (index, (name, text, arguments, code)) in cases.iter().enumerate() {
        scratch.file("case.toml", text);
        let out = if arguments.contains("--out") { String::new() } else { format!("--out r{index}") };
        let said = scratch.prints(&format!("campaign case.toml --samples 300 {out} {arguments}"), *code);
        assert!(!said.contains("panicked"), "{name}: {said}");
        if !out.is_empty() && *code != 2 {
            for again in [format!("campaign case.toml --samples 300 {out}"), format!("finish r{index}")] {
                scratch.prints(&again, *code);
            }
        }
    }
    assert_eq!(fs::read_dir(scratch.path("foreign")).unwrap().count(), 1);
}

#[test]
fn a_missing_result_is_bad_input() {
    let scratch = folder("no-result");
    fs::create_dir(scratch.path("empty")).unwrap();
    scratch.file("file", "no result");
    scratch.small("--samples 20 --out there", 0);
    for missing in ["absent", "empty", "file"] {
        for command in [
            format!("verify {missing}"),
            format!("verify {missing} --repair"),
            format!("report {missing}"),
            format!("finish {missing}"),
            format!("compare {missing} there"),
            format!("compare there {missing}"),
            format!("index {missing}"),
            format!("campaign small.toml --only-failed-of {missing} --out again"),
        ] {
            let said = scratch.prints(&command, 2);
            assert!(said.contains(&format!("`{missing}`")) && !said.contains("os error"), "{command}: {said}");
        }
    }
    assert!(!scratch.path("absent").exists() && !scratch.path("again").exists());
    for command in ["verify there", "report there", "finish there", "compare there there"] {
        scratch.prints(command, 0);
    }
    scratch.small("--only-failed-of there --out again", 0);
}

#[test]
fn what_is_in_the_way_is_named() {
    let scratch = folder("in-the-way");
    scratch.file("file", "precious");
    fs::create_dir_all(scratch.path("all/index.html")).unwrap();
    scratch.small("--samples 20 --out all/one", 0);
    for (command, said) in [
        ("new file", "is there already, and is not replaced"),
        ("new all", "is a folder"),
        ("new nowhere/c.toml", "there is no folder `nowhere`"),
        ("new file/c.toml", "`file` is a file and not a folder"),
        ("index all", "not a regular file; move it away"),
        ("report all/one --figures file", "is there already, and is not replaced"),
        ("campaign small.toml --samples 20 --out file", "`file` is a file and not a folder"),
        ("campaign small.toml --samples 20 --out file/below", "`file` is a file and not a folder"),
        ("simulate small.toml --out nowhere/s.csv", "there is no folder `nowhere`"),
        ("simulate small.toml --plot file/p.svg", "`file` is a file and not a folder"),
        ("sample small.toml --samples 5 --out file/s.csv", "`file` is a file and not a folder"),
    ] {
        let found = scratch.prints(command, 4);
        assert!(found.contains(said) && !found.contains("os error"), "{command}: {found}");
    }
    assert_eq!(scratch.text("file"), "precious");
}

#[test]
fn one_is_singular_on_screens() {
    let scratch = folder("one-of-all");
    let one = sized(1);
    scratch.file("one.toml", &(one + &require("quantile = 0.95", "at_most = 1e-9")));
    for (command, code) in [
        ("check one.toml", 0),
        ("check one.toml --verbose", 0),
        ("campaign one.toml --samples 1 --out r --verbose --figures figures", 5),
        ("campaign one.toml --samples 1 --out r", 5),
        ("campaign one.toml --samples 1 --out again", 5),
        ("verify r", 0),
        ("report r", 0),
        ("compare r again", 0),
        ("index .", 0),
        ("sample one.toml --samples 2 --out s.csv", 0),
        ("simulate one.toml --times 0.5 --out t.csv", 0),
        ("campaign one.toml --samples 2 --out two", 5),
        ("precision one.toml --samples 1 --methods auto --tolerances 1e-8 --repeats 1 --out p", 0),
    ] {
        let said = scratch.prints_wide(command, code);
        let words: Vec<&str> =
            said.split_whitespace().map(|word| word.trim_matches(|c: char| !c.is_alphanumeric())).collect();
        let is_plural = |word: &str| {
            word.len() > 3 && word.ends_with('s') && word.chars().all(|letter| letter.is_ascii_lowercase())
        };
        for pair in words.windows(2) {
            assert!(pair[0] != "1" || !is_plural(pair[1]), "{command}: {pair:?} in\n{said}");
        }
    }
}
