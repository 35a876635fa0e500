//! The exit code of every way in which a campaign ends, and what comes first where several would apply: 2, 4, 3, 5, 1, 0.

use std::fs;

use crate::commands::screen_numbers::junit_counts;
use crate::small_campaign::{NEGATIVE_WALLS, campaign, folder};

/// A requirement on the energy error.
fn require(statement: &str, limit: &str) -> String {
    format!("[[require]]\nobservable = \"energy_error_max\"\n{statement}\n{limit}\n")
}

/// Law: the code follows from failed runs and verdicts, and is the same where the result is there already.
/// Every run within 1e-9 shows at least p95 of 299 runs; none is within 1e-30. Sixteen runs show nothing of p95.
#[test]
fn exit_codes() {
    let scratch = folder("exit-codes");
    let pass = require("quantile = 0.95", "at_most = 1e-9");
    let fail = require("fraction = 0.5", "at_most = 1e-30");
    let undecided = require("quantile = 0.9999", "at_most = 1e-9");
    let mean = require("mean = true", "at_most = 1e-9");
    // a hundred zeros may hide a rare one; a constant hides nothing
    let derived = |expression: &str| {
        let observable = format!("[[observable]]\nname = \"flag\"\nexpression = \"{expression}\"\n");
        observable + &mean.replace("energy_error_max", "flag")
    };
    let [equal, constant] = ["if(initial.angular_velocity_rad_s.x > 1e9, 1, 0)", "0"].map(derived);
    // a hundred steps are too few for some of the runs
    let stuck = campaign().replace("tolerance = 1e-10", "tolerance = 1e-10\nmax_steps = 1");
    let thin = campaign() + NEGATIVE_WALLS;
    fs::create_dir(scratch.path("foreign")).expect("a folder");
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
        // a finished result ends as before, whichever command finds it
        if !out.is_empty() && *code != 2 {
            for again in [format!("campaign case.toml --samples 300 {out}"), format!("finish r{index}")] {
                scratch.prints(&again, *code);
            }
        }
    }
    assert_eq!(fs::read_dir(scratch.path("foreign")).expect("a folder").count(), 1);
}

/// Law: the shipped campaign has one requirement of each verdict; screen, summary and JUnit file say the same.
#[test]
fn the_acceptance_campaign_has_every_verdict() {
    let scratch = folder("acceptance");
    let said = scratch.says("campaign", "acceptance.toml", "--out r --junit junit.xml --verbose", 3);
    let summary: serde_json::Value = scratch.summary("r");
    let list = summary["requirements"]["list"].as_array().expect("a list");
    let verdicts: Vec<&str> = list.iter().filter_map(|one| one["verdict"].as_str()).collect();
    assert_eq!(verdicts, ["PASS", "FAIL", "UNDECIDED"]);
    let xml = scratch.text("junit.xml");
    assert_eq!(junit_counts(&xml), [4, 1, 1]);
    for one in list {
        let (verdict, sentence) =
            (one["verdict"].as_str().expect("a word"), one["requirement"].as_str().expect("words"));
        assert!(said.contains(&format!("{verdict:<10} {sentence}")), "{said}");
        assert!(xml.contains(&format!("name=\"{sentence}\"")), "{xml}");
    }
    assert!(list[2]["runs_that_would_decide"].as_u64().is_some_and(|runs| runs > 1000), "{list:?}");
    assert_eq!((list[0]["runs"].as_u64(), list[0]["violations"].as_u64()), (Some(1000), Some(0)));
    // the counter-test: fewer requirements, other codes
    let text = fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/campaigns/acceptance.toml")).expect("readable");
    let tables: Vec<&str> = text.split("[[require]]").collect();
    for (kept, code) in [(vec![1], 0), (vec![1, 3], 5), (vec![1, 2], 3), (vec![], 0)] {
        let kept: String = kept.iter().map(|index| format!("[[require]]{}", tables[*index])).collect();
        scratch.file("fewer.toml", &format!("{}{kept}", tables[0]));
        scratch.prints("campaign fewer.toml --out fewer --overwrite", code);
    }
}
