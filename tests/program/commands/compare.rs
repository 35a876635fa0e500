//! `spindrift compare`: equal results, results of other methods, seeds and plans.

use crate::prelude::*;
use spindrift::statistics::two_sample::kolmogorov_smirnov;

#[test]
fn results_are_compared() {
    let scratch = folder("compare");
    scratch.small("--out a", 0);
    scratch.small("--out b --threads 1", 0);
    let said = scratch.prints_wide("compare a b --tolerance 0", 0);
    for words in ["the plans are the same", "599 samples drawn alike", "have the same statistics", "PASS: no shift"] {
        assert_says(&said, [words]);
    }

    let other = campaign().replace("method = \"auto\"", "method = \"dop853\"");
    scratch.file("other.toml", &other);
    scratch.prints("campaign other.toml --out c", 0);
    let said = scratch.prints_wide("compare a c --tolerance 0 --verbose", 3);
    assert!(says_key(&said, ["integrator.method", "\"auto\"", "\"dop853\""]), "{said}");
    assert_says(&said, ["599 samples drawn alike", "FAIL: a shift is beyond 0.0"]);
    assert!(said.contains("steps "), "other methods take other steps: {said}");

    scratch.small("--seed 8 --out d", 0);
    let said = scratch.prints_wide("compare a d", 0);
    let is_said = says_key(&said, ["campaign.seed", "7", "8"]);
    assert!(is_said && said.contains("compared as independent samples"), "{said}");
    scratch.prints("compare a d --tolerance 0.01", 3);

    scratch.small("--samples 300 --out e", 0);
    let said = scratch.prints_wide("compare a e", 0);
    let is_said = says_key(&said, ["campaign.samples", "600", "300"]);
    assert!(is_said && said.contains("299 samples drawn alike"), "{said}");

    scratch.file("chosen.toml", &campaign().replace("[campaign]", "[campaign]\nonly = [7, 8, 11, 250]"));
    scratch.prints("campaign chosen.toml --out f", 0);
    for (results, pairs) in [("a f", 4), ("f a", 4), ("f e", 4), ("f f", 4)] {
        let said = scratch.prints_wide(&format!("compare {results}"), 0);
        assert!(said.contains(&format!("{pairs} samples drawn alike")), "{results}: {said}");
    }

    scratch.prints("compare a nothing", 2);
    scratch.prints("compare a b --tolerance -1", 2);
    std::fs::write(scratch.path("b/runs/part-000001.parquet"), "damaged").unwrap();
    scratch.shows("compare a b", 4, "part-000001.parquet");
}

fn says_key(said: &str, words: [&str; 3]) -> bool {
    said.lines().any(|line| line.split_whitespace().eq(words))
}

/// Law: a shift of the share of ok runs beyond the tolerance is seen, whichever result has more of them.
#[test]
fn failures_alone_are_a_shift() {
    let scratch = folder("compare-failures");
    let thin = campaign_without_debris() + NEGATIVE_WALLS;
    scratch.file("thin.toml", &thin);
    scratch.prints("campaign thin.toml --out all --no-report", 1);
    let dispersed = ended(&scratch.rows("all")).into_iter().skip(1);
    let ok: Vec<u64> = dispersed.filter(|(_, status)| status == "ok").map(|(sample, _)| sample).collect();
    scratch.file("ok.toml", &thin.replace("[campaign]", &format!("[campaign]\nonly = {ok:?}")));
    scratch.prints("campaign ok.toml --out ok --no-report", 0);
    let failed = 1.0 - ok.len() as f64 / 599.0;
    assert!((0.2..0.5).contains(&failed), "{failed}");
    for (results, share, code) in [("all ok", 0.99, 3), ("all ok", 1.01, 0), ("ok all", 0.99, 3), ("ok all", 1.01, 0)] {
        scratch.prints(&format!("compare {results} --tolerance {}", share * failed), code);
    }
}

/// An observable of known truth: the initial rate about x, normal with a standard deviation of 0.5.
const RATE: &str = r#"
[[observable]]
name = "rate"
unit = "rad/s"
expression = "initial.angular_velocity_rad_s.x"
[[require]]
observable = "rate"
fraction = 0.5
at_most = 5.0
"#;

fn with_rate(scratch: &ScratchFolder, nominal: f64, seed: u32, samples: u32) -> String {
    let name = format!("n{nominal}s{seed}");
    let text = campaign().replace("[0, 3.141", &format!("[{nominal}, 3.141")) + RATE;
    scratch.file(&format!("{name}.toml"), &text);
    let arguments = format!("campaign {name}.toml --seed {seed} --samples {samples} --out {name} --no-report");
    scratch.prints(&arguments, if nominal > 5.0 { 3 } else { 0 });
    name
}

fn compared(scratch: &ScratchFolder, first: &str, second: &str) -> Value {
    ended_with(scratch, first, second, 0)
}

fn ended_with(scratch: &ScratchFolder, first: &str, second: &str, code: i32) -> Value {
    scratch.prints(&format!("compare {first} {second} --out c.json"), code);
    serde_json::from_str(&scratch.text("c.json")).unwrap()
}

fn row<'v>(compared: &'v Value, name: &str) -> &'v Value {
    let rows = compared["observables"].as_array().unwrap();
    rows.iter().find(|row| row["observable"] == name).unwrap_or_else(|| panic!("no row {name}"))
}

#[test]
fn equal_differences_have_equal_ranks() {
    let scratch = folder("compare-ties");
    for (name, expression) in [
        ("none", "0 * initial.angular_velocity_rad_s.x"),
        ("signs", "if(initial.angular_velocity_rad_s.x > 0.1, 1, -1)"),
    ] {
        let observable = format!("[[observable]]\nname = \"sign\"\nexpression = \"{expression}\"\n");
        scratch.file("one.toml", &(campaign_without_debris() + &observable));
        scratch.prints(&format!("campaign one.toml --out {name} --no-report"), 0);
    }
    let rates = column(&scratch.rows("signs"), "initial_angular_velocity_x_rad_s");
    let above = rates[1..].iter().filter(|rate| **rate > 0.1).count() as f64;
    let expected = libm::erfc((2.0 * above - 599.0).abs() / libm::sqrt(2.0 * 599.0));
    let compared = compared(&scratch, "none", "signs");
    let found = row(&compared, "sign")["p_value_moved"].as_f64().unwrap();
    // rounding of sums of 599 ranks
    assert!((1e-6..0.9).contains(&expected) && (found / expected - 1.0).abs() < 1e-11, "{found} {expected}");
}

#[test]
fn inaccurate_runs_have_no_part_in_the_test_of_distributions() {
    let scratch = folder("compare-inaccurate");
    scratch.file("mixed.toml", &mixed_failures());
    let results = [("first", 7), ("second", 8)];
    for (name, seed) in results {
        scratch.prints(&format!("campaign mixed.toml --samples 300 --seed {seed} --out {name} --no-report"), 1);
    }
    let rows = results.map(|(name, _)| scratch.rows(name));
    let ended = rows.each_ref().map(|rows| ended(rows));
    for ended in &ended {
        assert!(ended.iter().filter(|(_, status)| status == "inaccurate").count() > 20);
    }
    let compared = compared(&scratch, "first", "second");
    assert_eq!(compared["pairs"], 0);
    let (mut checked, mut changed) = (0, 0);
    for row in compared["observables"].as_array().unwrap() {
        let name = row["observable"].as_str().unwrap();
        let p_value = |statuses: &[&str]| {
            let [first, second] = [0, 1].map(|which| {
                let numbers = column(&rows[which], name).into_iter().zip(&ended[which]);
                let counted = numbers.filter(|(value, (sample, status))| {
                    *sample > 0 && statuses.contains(&status.as_str()) && !value.is_nan()
                });
                let mut values: Vec<f64> = counted.map(|(value, _)| value).collect();
                values.sort_by(f64::total_cmp);
                values
            });
            kolmogorov_smirnov(&first, &second).unwrap().1
        };
        let expected = p_value(&["ok"]);
        assert_eq!(row["p_value_distribution"].as_f64(), Some(expected), "{name}");
        changed += usize::from((p_value(&["ok", "inaccurate"]) - expected).abs() > 1e-3);
        checked += 1;
    }
    assert!(checked > 50 && changed > 20, "{checked} {changed}");
}

/// Law: campaigns with the same samples about other nominal values are compared in pairs, which find a small shift.
#[test]
fn planted_shifts_are_found_by_pairs() {
    let scratch = folder("compare-planted");
    let [base, moved, other, far] =
        [(0.0, 7), (0.01, 7), (0.01, 8), (10.0, 7)].map(|(nominal, seed)| with_rate(&scratch, nominal, seed, 600));

    let pairs = compared(&scratch, &base, &moved);
    let rate = row(&pairs, "rate");
    assert_eq!((&pairs["pairs"], &pairs["compared_as"]), (&Value::from(599), &Value::from("pairs")));
    let number = |key: &str| rate[key].as_f64().unwrap();
    assert!((number("mean_shift") - 0.01).abs() < 1e-15 && number("adjusted_p_value_moved") < 1e-9, "{rate}");
    assert_eq!(
        (&rate["is_moved"], &rate["is_shifted"], &rate["is_required"], &rate["differing_pairs"]),
        (&1.into(), &0.into(), &1.into(), &599.into())
    );
    let both: Vec<&str> =
        ["first", "second"].into_iter().filter_map(|key| pairs["requirements"][0][key].as_str()).collect();
    assert_eq!(both, ["PASS", "PASS"]);

    let independent = compared(&scratch, &base, &other);
    let rate = row(&independent, "rate");
    assert_eq!((&independent["pairs"], &rate["is_shifted"]), (&0.into(), &0.into()));
    assert!((rate["mean_shift"].as_f64().unwrap() - 0.01).abs() < 4.0 * 0.029, "{rate}");

    for (results, tolerance, mark, code) in [
        (format!("{base} {far}"), "", "WORSE", 3),
        (format!("{base} {far}"), " --tolerance 1e9", "WORSE", 3),
        (format!("{far} {base}"), "", "BETTER", 0),
    ] {
        let said = scratch.prints(&format!("compare {results}{tolerance}"), code);
        let verdict = said.lines().find(|line| line.contains(mark)).unwrap();
        assert_says(verdict, ["PASS", "FAIL", "rate"]);
        assert_eq!(said.contains("FAIL: 1 verdict is worse than before"), code == 3, "{said}");
    }
    let worse = ended_with(&scratch, &base, &far, 3);
    assert_eq!(worse["requirements"][0]["is_worse"], true);
    assert_eq!(row(&worse, "rate")["is_shifted"], 1);
    for compared in [&pairs, &independent, &worse] {
        let rows = compared["observables"].as_array().unwrap();
        assert_eq!(rows[0]["observable"], "rate");
        let key = |row: &Value, key: &str| row[key].as_f64();
        for pair in rows[1..].windows(2) {
            let p = |row: &Value| key(row, "p_value").unwrap_or(1.0);
            assert!(p(&pair[0]) <= p(&pair[1]), "{pair:?}");
        }
        for row in rows {
            let p = key(row, "adjusted_p_value");
            let is_shifted = p.is_some_and(|p| p <= 0.05) && key(row, "largest_shift") > Some(0.0);
            assert_eq!(row["is_shifted"], u64::from(is_shifted), "{row}");
        }
    }
}

#[test]
fn comparisons_are_files() {
    let scratch = folder("compare-files");
    let [base, moved] = [(0.0, 7), (0.01, 7)].map(|(nominal, seed)| with_rate(&scratch, nominal, seed, 60));
    let compared = compared(&scratch, &base, &moved);
    scratch.prints(&format!("compare {base} {moved} --out c.parquet"), 0);
    let (rows, table) = (compared["observables"].as_array().unwrap(), scratch.table("c.parquet"));
    let statistics = scratch.table(&format!("{base}/statistics.parquet")).num_rows();
    assert_eq!((rows.len(), table.num_rows()), (statistics, statistics));
    let names = texts(&table, "observable");
    for name in
        ["adjusted_p_value", "mean_shift", "mean_first", "mean_second", "standard_deviation_second", "p95_first"]
    {
        for (row, value) in floats(&table, name).into_iter().enumerate() {
            assert_eq!(names.value(row), rows[row]["observable"]);
            let known = Some(value).filter(|x| !x.is_nan());
            assert_eq!(rows[row][name].as_f64().map(f64::to_bits), known.map(f64::to_bits), "{name}");
        }
    }
    let keys: Vec<&str> =
        compared["differing_keys"].as_array().unwrap().iter().filter_map(|key| key["key"].as_str()).collect();
    assert!(keys.contains(&"initial.angular_velocity_rad_s"), "{keys:?}");
    for path in ["c.csv".to_owned(), "c".to_owned(), format!("{base}/c.json"), format!("{moved}/c.json")] {
        scratch.prints(&format!("compare {base} {moved} --out {path}"), 2);
        assert!(!scratch.path(&path).exists(), "{path}");
    }
    scratch.prints(&format!("compare {base} {moved} --out missing/c.json"), 4);
}

#[test]
fn verdicts_and_scales_are_those_of_their_result() {
    let scratch = folder("compare-sides");
    scratch.small("--out plain --no-report", 0);
    let require = "\n[[require]]\nobservable = \"energy_error_max\"\nquantile = 0.9\nat_most = 1e-30\n";
    scratch.file("wide.toml", &(campaign().replace("std = [0.5, 0.5, 1.5]", "std = [1.0, 1.0, 3.0]") + require));
    scratch.prints("campaign wide.toml --out wide --no-report", 3);
    let deviation = |result: &str| {
        let table = scratch.table(&format!("{result}/statistics.parquet"));
        let names = texts(&table, "observable");
        let row = names.iter().position(|name| name == Some("exchange_w1_peak_to_peak_j")).unwrap();
        floats(&table, "standard_deviation")[row]
    };
    for (first, second) in [("plain", "wide"), ("wide", "plain")] {
        let found = compared(&scratch, first, second);
        let verdicts = &found["requirements"].as_array().unwrap()[..];
        let [verdict] = verdicts else { panic!("{verdicts:?}") };
        let expected =
            if first == "wide" { [Value::from("FAIL"), Value::Null] } else { [Value::Null, Value::from("FAIL")] };
        assert_eq!([&verdict["first"], &verdict["second"]], [&expected[0], &expected[1]], "{first}, {second}");
        let row = row(&found, "exchange_w1_peak_to_peak_j");
        let number = |name: &str| row[name].as_f64().unwrap_or_else(|| panic!("{name}"));
        let statistic = row["largest_shift_of"].as_str().unwrap().replace([' ', '.'], "_");
        let [before, after] = ["first", "second"].map(|side| number(&format!("{statistic}_{side}")));
        let expected = (after - before).abs() / deviation(first);
        assert!((number("largest_shift") - expected).abs() < 1e-9 * expected, "{first}, {second}: {row}");
    }
    assert!(deviation("wide") > 1.5 * deviation("plain"));
}

#[test]
fn a_stopped_campaign_is_paired_in_all_its_samples() {
    let scratch = folder("compare-stopped");
    let stop = "\n[stop]\nobservable = \"exchange_w1_peak_to_peak_j\"\nquantile = 0.5\nhalf_width = 1e-30\nmax_samples \
        = 800\n";
    scratch.file("stop.toml", &(sized(100) + stop));
    scratch.prints("campaign stop.toml --out stopped --no-report", 5);
    scratch.small("--out plain --no-report", 0);
    for (first, second, pairs) in [("stopped", "plain", 599), ("plain", "stopped", 599), ("stopped", "stopped", 799)] {
        assert_eq!(compared(&scratch, first, second)["pairs"], pairs, "{first} {second}");
    }
}
