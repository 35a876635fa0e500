//! Runs that are not `ok`: garbage is not `ok`, every such row says why, and so do the screen and `simulate`.

use crate::prelude::*;

use crate::commands::screen_numbers::junit_counts;

fn ends(batch: &RecordBatch) -> Vec<(String, Option<String>)> {
    let statuses = texts(batch, "status");
    let reasons = texts(batch, "reason");
    let text = |row: usize| (!reasons.is_null(row)).then(|| reasons.value(row).to_owned());
    (0..batch.num_rows()).map(|row| (statuses.value(row).to_owned(), text(row))).collect()
}

fn reasons<'s>(said: &'s str, status: &str) -> Vec<(usize, &'s str)> {
    let lines = said.lines().filter(|line| line.starts_with("    ") && line.contains(&format!(" {status}: ")));
    lines.map(|line| (line.split_whitespace().next().and_then(|word| word.parse().ok()).unwrap(), line)).collect()
}

#[test]
fn reasons_are_said_and_counted() {
    let scratch = folder("grouped-reasons");
    let stuck = campaign().replace("tolerance = 1e-10", "tolerance = 1e-10\nmax_steps = 1");
    scratch.file("stuck.toml", &stuck);
    let said = scratch.prints_wide("check stuck.toml", 1);
    let first: Vec<&str> = said.lines().skip(1).take(3).collect();
    assert!(said.starts_with("small: 600 runs") && first[0].starts_with("EVERY RUN FAILS"), "{said}");
    let [(count, line)] = reasons(&said, "step_limit")[..] else { panic!("one reason: {said}") };
    assert!(first[2] == line && line.contains("integrator.max_steps does not suffice: the run reached 0."), "{said}");
    assert!(first[1].starts_with(&format!("{count} of the first {count} runs failed")), "{said}");

    scratch.file("negative.toml", &[campaign(), NEGATIVE_WALLS.replace("max = 0.04", "max = -0.01")].concat());
    let said = scratch.prints_wide("check negative.toml", 1);
    assert!(said.lines().nth(3).is_some_and(|line| line.contains("wall_thickness_m")), "{said}");

    for arguments in ["--out whole", "--out parts --threads 1"] {
        let said = scratch.prints(&format!("campaign stuck.toml {arguments}"), 1);
        assert_eq!(reasons(&said, "step_limit").iter().map(|(count, _)| *count).collect::<Vec<_>>(), [600], "{said}");
    }
    let value = scratch.summary("whole");
    assert_eq!(value, scratch.summary("parts"));
    let reason = &value["failure_reasons"][0];
    assert_eq!(
        (&reason["status"], &reason["count"], &reason["sample"]),
        (&"step_limit".into(), &600.into(), &0.into())
    );
    let of_row = ends(&scratch.table("whole/runs/part-000000.parquet"))[0].1.clone();
    assert_eq!(reason["reason"].as_str(), of_row.as_deref());

    scratch.file("thin.toml", &(campaign() + NEGATIVE_WALLS));
    let said = scratch.prints_wide("check thin.toml", 0);
    assert!(!said.contains("EVERY RUN FAILS") && reasons(&said, "invalid_sample").len() == 1, "{said}");
    let said = scratch.prints("campaign thin.toml --out thin", 1);
    let counted: usize = reasons(&said, "invalid_sample").iter().map(|(count, _)| count).sum();
    let failed = ended(&scratch.rows("thin")).iter().filter(|(_, status)| status == "invalid_sample").count();
    assert_eq!(counted, failed);
    assert!(failed > 100, "{failed}");
}

#[test]
fn garbage_is_inaccurate() {
    let scratch = folder("inaccurate");
    let too_long =
        campaign().replace("method = \"auto\"\ntolerance = 1e-10", "method = \"runge_kutta_4\"\nstep_s = 0.25");
    scratch.file("long.toml", &too_long);
    let said = scratch.prints("campaign long.toml --samples 40 --out long", 1);
    let flat = said.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(flat.contains("inaccurate") && flat.contains("(first sample 0)"), "{said}");
    let batch = &scratch.table("long/runs/part-000000.parquet");
    let estimates = floats(batch, "state_error_estimate");
    let balances = ["energy_error_max", "angular_momentum_error_max"].map(|name| (name, floats(batch, name)));
    for (row, (status, reason)) in ends(batch).into_iter().enumerate() {
        assert_eq!(status, "inaccurate", "row {row}");
        let reason = reason.unwrap();
        assert_eq!(reason.contains("state_error_estimate"), estimates[row] >= 0.1, "row {row}: {reason}");
        for (name, values) in &balances {
            assert_eq!(reason.contains(name), values[row] >= 1e-2, "row {row}: {reason}");
        }
    }
    assert_eq!(scratch.summary("long")["statuses"]["inaccurate"], 40);
    scratch.shows("simulate long.toml --sample 3", 1, "the run ended with inaccurate: ");
    scratch.file("short.toml", &too_long.replace("step_s = 0.25", "step_s = 0.001"));
    scratch.prints("campaign short.toml --samples 40 --out short", 0);
    let batch = &scratch.table("short/runs/part-000000.parquet");
    for (row, end) in ends(batch).into_iter().enumerate() {
        assert_eq!(end, ("ok".to_owned(), None), "row {row}");
    }
}

#[test]
fn failed_runs_violate_what_their_values_keep() {
    let scratch = folder("failed-violate");
    let limits = [
        ("fraction = 0.95", "at_most", 1e300),
        ("quantile = 0.95", "at_most", 1e300),
        ("quantile = 0.05", "at_least", -1e300),
        ("fraction = 0.5", "at_most", 315.0),
        ("quantile = 0.5", "at_least", 315.0),
    ];
    let require = |(statement, side, limit): (&str, &str, f64)| {
        format!("[[require]]\nobservable = \"rate_w1_final_rad_s\"\n{statement}\n{side} = {limit:?}\n")
    };
    scratch.file("mixed.toml", &[mixed_failures(), limits.map(require).concat()].concat());
    scratch.prints("campaign mixed.toml --samples 300 --out r --no-report --junit junit.xml", 3);
    let rows = scratch.rows("r");
    let (ended, rates) = (ended(&rows), column(&rows, "rate_w1_final_rad_s"));
    let population: Vec<(&str, f64)> =
        ended.iter().zip(&rates).skip(1).map(|((_, status), rate)| (status.as_str(), *rate)).collect();
    let failed_with_value = population.iter().filter(|(status, rate)| *status != "ok" && !rate.is_nan()).count();
    assert!(failed_with_value > 20, "{failed_with_value} runs failed and have a value");
    let summary = scratch.summary("r");
    let list = summary["requirements"]["list"].as_array().unwrap();
    let runs: Vec<_> = population.iter().filter(|(status, _)| *status != "invalid_sample").collect();
    let outside = &summary["requirements"]["samples_that_are_not_physical"];
    assert_eq!((&summary["requirements"]["samples"], outside), (&299.into(), &(299 - runs.len()).into()));
    for ((statement, side, limit), found) in limits.into_iter().zip(list) {
        let is_within = |rate: f64| if side == "at_most" { rate <= limit } else { rate >= limit };
        let violations = runs.iter().filter(|(status, rate)| *status != "ok" || !is_within(*rate)).count();
        let failed = runs.iter().filter(|(status, _)| *status != "ok").count();
        let counts = ["runs", "violations", "failed_runs"].map(|name| found[name].as_u64().unwrap() as usize);
        assert_eq!(counts, [runs.len(), violations, failed], "{statement} {side} {limit}");
    }
    assert!(list[..3].iter().all(|one| one["verdict"] == "FAIL"), "{list:?}");
    // what decides whether a requirement is missed is asked of the same runs; those that are ok are no sample of all
    let inputs = scratch.table("r/sensitivity.parquet");
    let of = |name: &str| floats(&inputs, name);
    assert!(of("event_runs").iter().all(|runs| Some(*runs as u64) == list[0]["violations"].as_u64()));
    let has = |name: &str| of(name).iter().any(|number| !number.is_nan());
    let known = ["first_order", "event_share", "event_share_lower", "first_order_lower", "pearson_lower"].map(has);
    assert_eq!(known, [true, true, true, false, false]);
    let xml = scratch.text("junit.xml");
    let failures = list.iter().filter(|one| one["verdict"] == "FAIL").count();
    assert_eq!(junit_counts(&xml)[1], failures + 1, "one more for the failed runs: {xml}");
}

#[test]
fn failed_rows_have_reasons() {
    let scratch = folder("reasons");
    scratch.file("thin.toml", &(campaign() + NEGATIVE_WALLS));
    scratch.prints("campaign thin.toml --samples 100 --out thin", 1);
    let batch = &scratch.table("thin/runs/part-000000.parquet");
    let walls = floats(batch, "body_parts_fuselage_wall_thickness_m");
    let errors = batch.column_by_name("energy_error_max").unwrap();
    let ends = ends(batch);
    for (row, (status, reason)) in ends.iter().enumerate() {
        let is_physical = walls[row] > 0.0;
        assert_eq!(status, if is_physical { "ok" } else { "invalid_sample" }, "row {row}, wall {}", walls[row]);
        assert_eq!((errors.is_null(row), reason.is_none()), (!is_physical, is_physical), "row {row}");
        let names = reason.as_ref().is_none_or(|reason| reason.contains("body.parts.fuselage.wall_thickness_m"));
        assert!(names, "row {row}: {reason:?}");
    }
    let invalid = ends.iter().filter(|(status, _)| status == "invalid_sample").count();
    assert!((10..60).contains(&invalid), "{invalid} of 100");
    assert_eq!(scratch.summary("thin")["statuses"]["invalid_sample"], invalid);
    let row = ends.iter().position(|(status, _)| status == "invalid_sample").unwrap();
    let said = scratch.prints(&format!("simulate thin.toml --sample {row}"), 2);
    let reason = said.lines().find(|line| line.starts_with("  ")).unwrap();
    assert!(said.contains("invalid_sample") && reason.contains("wall_thickness_m"), "{said}");
    scratch.shows(&format!("sample thin.toml --sample {row}"), 0, reason);

    scratch.file("short.toml", &campaign().replace("tolerance = 1e-10", "tolerance = 1e-10\nmax_steps = 1"));
    scratch.prints("campaign short.toml --samples 5 --out short", 1);
    let batch = &scratch.table("short/runs/part-000000.parquet");
    for (status, reason) in self::ends(batch) {
        let reason = reason.unwrap();
        assert!(status == "step_limit" && reason.starts_with("integrator.max_steps does not suffice"), "{reason}");
    }
    assert_eq!(batch.column_by_name("energy_error_max").unwrap().null_count(), 5);
    scratch.prints("simulate short.toml", 1);
}

#[test]
fn a_run_ends_with_its_debris() {
    let scratch = folder("debris-steps");
    let fast = campaign()
        .replace("side_m = 0.2", "size_m = [0.1, 0.25, 0.6]")
        .replace("duration_s = 1.0", "duration_s = 10.0");
    for (method, few, many) in [("taylor", 300, 3000), ("dormand_prince", 8000, 100_000)] {
        for (steps, code, status) in [(few, 1, "step_limit"), (many, 0, "ok")] {
            let text = fast
                .replace("method = \"auto\"", &format!("method = \"{method}\""))
                .replace("tolerance = 1e-10", &format!("tolerance = 1e-10\nmax_steps = {steps}"));
            scratch.file("fast.toml", &text);
            scratch.prints("campaign fast.toml --samples 3 --out r --overwrite --no-report", code);
            let batch = &scratch.table("r/runs/part-000000.parquet");
            let found = ends(batch);
            assert!(found.iter().all(|(found, _)| found == status), "{method}, {steps}: {found:?}");
            let energy = batch.column_by_name("energy_error_max").unwrap();
            assert_eq!(energy.null_count(), if status == "ok" { 0 } else { 3 }, "{method}, {steps}");
        }
    }
}
