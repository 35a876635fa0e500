//! `spindrift precision`: errors follow tolerances and steps, times are times, files are whole.

use crate::prelude::*;

/// Reduction of the error at least; measured: 8.5e-3 with a quarter of the step, 1.1e-4 with 1e-4 of the tolerance.
const LESS: f64 = 0.01;

#[test]
fn errors_follow_the_settings() {
    let scratch = ScratchFolder::new("settings");
    let arguments = "--samples 3 --methods auto,dop853,runge_kutta_4 --tolerances 1e-4,1e-6,1e-8 --repeats 1 --out p";
    let start = Instant::now();
    let said = scratch.says("precision", "spin_sweep.toml", arguments, 0);
    let wall = start.elapsed().as_secs_f64();
    assert_says(&said, ["3 samples", "us/run"]);
    assert!(!said.contains(" failed"), "{said}");
    let table = scratch.table("p/precision.parquet");
    let head = said.lines().position(|line| line.starts_with("method ")).unwrap();
    let heads: Vec<&str> = said.lines().nth(head).unwrap().split_whitespace().collect();
    let lines = said.lines().skip(head + 1).filter(|line| !line.starts_with(' '));
    for (row, line) in lines.take(table.num_rows()).enumerate() {
        let words: Vec<&str> = line.split_whitespace().collect();
        let number = |name: &str| floats(&table, name)[row];
        let settings = [number("tolerance"), number("step_s")];
        for (head, known) in [
            ("setting", settings.into_iter().find(|value| !value.is_nan()).unwrap()),
            ("us/run", 1e6 * number("cpu_s")),
            ("runs/s", 1.0 / number("cpu_s")),
            ("steps", number("steps_mean")),
            ("rate", number("rate_error_max")),
            ("attitude", number("attitude_error_max_rad")),
            ("energy", number("energy_error_max")),
            ("momentum", number("angular_momentum_error_max")),
        ] {
            let place = heads.iter().position(|other| *other == head).expect(head);
            let found: f64 = words[place].trim_end_matches('s').parse().unwrap();
            let rounding = if head == "steps" { 0.5 } else { 0.0 };
            assert!((found - known).abs() <= 0.051 * known.abs() + rounding, "{head} {found} for {known}: {line}");
        }
    }
    let methods: Vec<&str> = table.column(0).as_string::<i32>().iter().flatten().collect();
    assert_eq!(methods[..4], ["auto", "auto", "auto", "dop853"]);
    assert_eq!(methods.len(), 9);
    for name in ["rate_error_max", "attitude_error_max_rad"] {
        let errors = floats(&table, name);
        for first in [0, 3, 6] {
            let (coarse, fine) = (errors[first], errors[first + 2]);
            assert!(fine < LESS * coarse, "{name} of {}: {coarse:e} {fine:e}", methods[first]);
        }
    }
    for (row, cpu) in floats(&table, "cpu_s").into_iter().enumerate() {
        assert!(cpu > 0.0 && cpu < wall, "row {row}: {cpu} s of {wall} s");
    }
    let (tolerances, steps) = (floats(&table, "tolerance"), floats(&table, "step_s"));
    assert!(tolerances[3] == 1e-4 && steps[3].is_nan() && tolerances[8].is_nan());
    assert_eq!(steps[8] * 4.0, steps[6]);
    let shown = Found::shown_on(&scratch.text("p/precision.html"));
    assert!(shown.iter().any(|(title, _)| title.starts_with("Angular velocity")), "{shown:?}");
}

#[test]
fn no_setting_is_lost() {
    let scratch = ScratchFolder::new("lost");
    let methods = ["dop853", "null_space", "runge_kutta_4", "auto"];
    for (limit, measured) in [("1e-7", Some(0)), ("0.01", None), ("1000", Some(12))] {
        let settings = "--tolerances 1e-4,1e-8,1e-12 --samples 2 --repeats 1 --out p";
        let arguments = format!("--methods {} {settings} --limit-s {limit}", methods.join(","));
        let said = scratch.says("precision", "spin_sweep.toml", &arguments, 0);
        let skipped: Vec<(&str, usize)> = said
            .lines()
            .filter_map(|line| line.strip_prefix("skipped: ")?.split_once(" at "))
            .map(|(method, rest)| (method, rest.split(':').next().unwrap().split(", ").count()))
            .collect();
        let rows = batches(&scratch.path("p/precision.parquet"));
        let of_rows = |method: &str| {
            let names = rows.iter().map(|rows| rows.column(0).as_string::<i32>());
            names.map(|names| names.iter().filter(|name| *name == Some(method)).count()).sum::<usize>()
        };
        for method in methods {
            let named: Vec<usize> =
                skipped.iter().filter(|(name, _)| *name == method).map(|(_, count)| *count).collect();
            assert!(named.len() <= 1, "{limit}: {said}");
            assert_eq!(of_rows(method) + named.iter().sum::<usize>(), 3, "{limit}, {method}: {said}");
        }
        let all: usize = methods.into_iter().map(of_rows).sum();
        assert!(measured.is_none_or(|measured| measured == all), "{limit}: {said}");
    }
}

#[test]
fn wrong_arguments_end_with_code_2() {
    let scratch = ScratchFolder::new("wrong");
    for (arguments, word) in [
        ("--methods euler", "gauss_legendre_6"),
        ("--tolerances 1e-20", "1e-16 to 0.1"),
        ("--samples 0", "0"),
        ("--limit-s -1", "-1"),
    ] {
        let said = scratch.says("precision", "spin_sweep.toml", arguments, 2);
        assert!(said.contains(word), "{arguments}: {said}");
    }
}
