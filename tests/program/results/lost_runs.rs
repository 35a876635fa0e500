//! Campaigns that lose runs, or whose audits fail.

use crate::prelude::*;

use spindrift::statistics::binomial::interval;

const RUNS: usize = 120;

fn number(summary: &Value, path: &str) -> f64 {
    summary.pointer(path).and_then(Value::as_f64).unwrap_or_else(|| panic!("{path}"))
}

#[test]
fn a_loss_is_said_first_and_is_not_random() {
    let scratch = ScratchFolder::new("lost-runs");
    let alone = DETUMBLE.split("[[require]]").next().unwrap();
    let stepped = alone.replace("method = \"auto\"", "method = \"dop853\"");
    let short = stepped.replace("\"10 min\"", "\"60 s\"").replace("samples = 1024", &format!("samples = {RUNS}"));
    let text = short + "\n[[require]]\nobservable = \"angular_rate_final_rad_s\"\nquantile = 0.95\nat_most = 4000.0\n";
    scratch.file("all.toml", &text);
    let run = |name: &str, code: i32| {
        let mut command = scratch.command(&format!("campaign {name}.toml --out {name} --junit {name}.xml --verbose"));
        scratch.outputs(command.env("COLUMNS", "400"), code)
    };
    let said = run("all", 0);
    assert!(!said.contains("NOT COMPUTED") && !scratch.text("all/report.html").contains("id=\"warnings\""), "{said}");
    let mut steps = column(&scratch.rows("all"), "steps").split_off(1);
    steps.sort_by(f64::total_cmp);
    let limited = text.replace("tolerance = 1e-12", &format!("tolerance = 1e-12\nmax_steps = {}", steps[RUNS / 4]));
    scratch.file("lost.toml", &limited);
    let said = run("lost", 3);
    let rows = scratch.rows("lost");
    let ended = ended(&rows);
    let missing = ended[1..].iter().filter(|(_, status)| status == "step_limit").count();
    let runs = RUNS - 1;
    assert!(2 * missing > runs && missing < runs, "{missing} of {runs}");

    // first of all, with what decides it
    let share = 100.0 * missing as f64 / runs as f64;
    says(
        &said,
        "NOT COMPUTED: # of # dispersed runs, #% (step_limit #)",
        &[missing as f64, runs as f64, share, missing as f64],
    );
    let warning = said.find("NOT COMPUTED").unwrap();
    assert!(warning < said.find("requirement,").unwrap(), "{said}");
    let summary = scratch.summary("lost");
    let warnings = summary["warnings"].as_array().unwrap();
    assert_says(warnings[0].as_str().unwrap(), ["What decides it: initial"]);
    let page = scratch.text("lost/report.html");
    let place = |anchor: &str| page.find(&format!("<section id=\"{anchor}\"")).unwrap_or_else(|| panic!("{anchor}"));
    assert!(place("warnings") < place("status") && page.contains("<b>NOT COMPUTED:</b>"));
    assert!(scratch.prints("campaign lost.toml --out lost", 3).contains("NOT COMPUTED"));

    let failures = column(&rows, "failure");
    let ok = (1..RUNS).filter(|row| ended[*row].1 == "ok");
    let failed = ok.clone().filter(|row| failures[*row] != 0.0).count();
    let ends = summary["missions"].as_array().unwrap();
    let none = ends.iter().find(|end| end["end"] == "not_failed").unwrap();
    let count = ok.count() - failed;
    assert_eq!(
        [&none["count"], &none["runs"], &none["not_computed"]].map(Value::as_u64),
        [count, runs, missing].map(|n| Some(n as u64))
    );
    let low = interval(count as u64, runs as u64, 0.95)[0];
    let high = interval((count + missing) as u64, runs as u64, 0.95)[1];
    let shares = [count, count + missing].map(|count| count as f64 / runs as f64);
    let known = [count as f64, runs as f64, 100.0 * shares[0], 100.0 * shares[1], 100.0 * low, 100.0 * high];
    says(&said, "# of # missions did not fail: #% to #% [#, #]", &known);

    // no interval takes the loss for random, and no number contradicts a verdict
    for line in summary["observables"].as_array().unwrap() {
        assert!(line["mean_interval"].as_array().unwrap().iter().all(Value::is_null), "{line}");
        for quantile in line["quantiles"].as_array().unwrap() {
            assert!(quantile["interval"].as_array().unwrap().iter().all(Value::is_null), "{line}");
        }
    }
    let one = &summary["requirements"]["list"][0];
    assert_eq!((&one["verdict"], &one["value"]), (&"FAIL".into(), &Value::Null));
    assert_eq!(number(one, "/runs_without_a_value"), missing as f64);
    for text in [&said, &scratch.text("lost.xml")] {
        let found = text.split_once("p95 is among the runs without a value; ").unwrap().1;
        let interval = interval((runs - missing) as u64, runs as u64, 0.95).map(|end| 100.0 * end);
        let known = [(runs - missing) as f64, runs as f64, 100.0 - share, interval[0], interval[1], missing as f64];
        says(found, "# of # runs within the limit: #% [#, #]; # runs without a value count as violations", &known);
    }
    assert_eq!(said.matches("in brackets:").count(), 1, "{said}");
    assert_eq!(said.matches("two-sided 95% intervals").count(), 1, "{said}");
    assert!(scratch.text("lost.xml").contains("two-sided 95% intervals"));
}

/// The fastest runs need the most steps.
const FASTEST: &str = r#"
[campaign]
name = "fastest"
samples = 401
seed = 1
duration_s = 8.0
[observe]
points = 17
groups = ["motion"]
[body]
mass_kg = 100.0
inertia_kg_m2 = [[10, 0, 0], [0, 10, 0], [0, 0, 20]]
[integrator]
method = "dop853"
max_steps = 27
[[thrusters]]
name = "p1"
position_m = [0, 0, 0]
direction = [0, 0, 1]
[[actuation]]
name = "u"
start_s = 0.0
end_s = 8.0
thrust_n = { p1 = 1.0 }
[initial]
angular_velocity_rad_s = [0.3, 0.0, 0.1]
[[disperse]]
parameter = "initial.angular_velocity_rad_s.x"
distribution = "uniform"
min = 0.0
max = 1.97
[[disperse]]
parameter = "actuation.u.switch_off_delay_s"
distribution = "uniform"
min = -1
max = 0
[[observable]]
name = "rate"
expression = "initial.angular_velocity_rad_s.x + 0 * angular_rate_max_rad_s"
[[require]]
observable = "rate"
fraction = 0.7
at_most = 1.5
[summary]
columns = ["rate"]
"#;

#[test]
fn intervals_hold_whatever_lost_runs_are() {
    let scratch = ScratchFolder::new("few-lost");
    let bounded = "[[require]]\nobservable = \"rate\"\nmean = true\nat_most = 1.9\nbounded = [0.0, 1.97]\n";
    scratch.file("open.toml", FASTEST);
    scratch.file("bounded.toml", &format!("{FASTEST}{bounded}"));
    let outcome = |file: &str, seed: u64, steps: u64| {
        let set =
            format!("--set campaign.seed={seed} --set integrator.max_steps={steps} --no-report --out {file}{steps}");
        let mut command = scratch.command(&format!("campaign {file}.toml --overwrite {set}"));
        let out = command.output().unwrap();
        assert!([0, 1, 3, 5].contains(&out.status.code().unwrap_or(-1)), "{out:?}");
        let summary = scratch.summary(&format!("{file}{steps}"));
        let lines = summary["observables"].as_array().unwrap();
        let line = lines.iter().find(|line| line["name"] == "rate").unwrap().clone();
        let rows = ended(&scratch.rows(&format!("{file}{steps}")));
        (line, rows.iter().filter(|(_, status)| status == "step_limit").count())
    };
    let ends = |value: &Value| {
        let ends = value.as_array().unwrap();
        [ends[0].as_f64().unwrap_or(f64::NEG_INFINITY), ends[1].as_f64().unwrap_or(f64::INFINITY)]
    };
    for seed in 1..=6 {
        let (few, lost) = outcome("open", seed, 27);
        let (all, none) = outcome("open", seed, 100);
        assert!((1..20).contains(&lost) && none == 0, "seed {seed}: {lost} of 400 lost");
        let quantiles = |line: &Value| line["quantiles"].as_array().unwrap().clone();
        let (mut bounded, mut wider) = (0, 0);
        for (one, other) in quantiles(&few).iter().zip(&quantiles(&all)) {
            assert_eq!(one["p"], other["p"]);
            let ([low, high], [from, to]) = (ends(&one["interval"]), ends(&other["interval"]));
            assert!(low <= from && to <= high, "seed {seed}, {}: {one} {other}", one["p"]);
            bounded += usize::from(low.is_finite() && high.is_finite());
            wider += usize::from(low < from || to < high);
        }
        assert!(bounded >= 3 && wider >= 5, "seed {seed}: {bounded} bounded, {wider} wider: {few}");
        assert_eq!(ends(&few["mean_interval"]), [f64::NEG_INFINITY, f64::INFINITY], "seed {seed}");
        let (ranged, _) = outcome("bounded", seed, 27);
        let [low, high] = ends(&ranged["mean_interval"]);
        let mean = number(&all, "/mean");
        assert!(low < mean && mean < high && high - low < 0.5, "seed {seed}: {mean} [{low}, {high}]");
    }
    let (_, lost) = outcome("open", 6, 20);
    assert!(lost > 100, "{lost}");
    scratch.shows("compare open100 open20", 3, "WORSE");
}

/// Seen at three points: the estimate of the error knows too little of the motion.
const FLIPS: &str = r#"
initial = { angular_velocity_rad_s = [1.0, 1e-6, 1e-6] }
integrator = { method = "auto", tolerance = 1e-14 }
observe = { points = 3 }
[campaign]
name = "flips"
seed = 1
duration_s = 150
samples = 20
[body]
mass_kg = 500.0
center_of_mass_m = [0.0, 0.0, 0.0]
inertia_kg_m2 = [[120.0, 0.0, 0.0], [0.0, 150.0, 0.0], [0.0, 0.0, 90.0]]
includes_wheels = false
[audit]
fraction = 1.0
[[disperse]]
parameter = "initial.angular_velocity_rad_s.x"
distribution = "normal"
std = 0.05
[[disperse]]
parameter = "initial.angular_velocity_rad_s.y"
distribution = "normal"
std = 1e-4
"#;

#[test]
fn an_audit_that_fails_is_no_success() {
    let scratch = ScratchFolder::new("audit-fails");
    scratch.file("few.toml", FLIPS);
    scratch.file("many.toml", &FLIPS.replace("points = 3", "points = 301"));
    let said = scratch.prints("campaign few.toml --out few --junit few.xml", 1);
    let rows = scratch.rows("few");
    let [estimates, errors] =
        ["audit_state_error_estimate", "audit_state_error"].map(|name| column(&rows, name).split_off(1));
    let covered = estimates.iter().zip(&errors).filter(|(estimate, error)| estimate >= error).count();
    assert!(covered < 10 && errors.iter().all(|error| *error < 0.1), "{covered} of {}", errors.len());
    let words = format!("AUDIT FAILED: state error estimate covers the true error in {covered} of {}", errors.len());
    let flat = said.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(flat.find(&words).unwrap() < flat.find("outcome").unwrap(), "{said}");
    assert!(scratch.summary("few")["warnings"][0].as_str().is_some_and(|text| text.starts_with(&words)));
    let page = scratch.text("few/report.html");
    assert!(page.find("<b>AUDIT FAILED:</b>").unwrap() < page.find("id=\"status\"").unwrap());
    assert_eq!(scratch.text("few.xml").matches("<failure type=\"audit\"").count(), 1);
    for again in ["campaign few.toml --out few", "finish few"] {
        assert!(scratch.prints(again, 1).contains("AUDIT FAILED"), "{again}");
    }
    let kept = scratch.prints("campaign many.toml --out many --junit many.xml", 0);
    assert!(!kept.contains("AUDIT FAILED") && !scratch.text("many.xml").contains("<failure"), "{kept}");
}
