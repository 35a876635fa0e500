//! Requirements over time, at each time and at all times.

use crate::prelude::*;
use spindrift::statistics::binomial::{lower_bound, upper_bound};

const RUNS: usize = 599;
const SERIES: &str = "energy_body_j";

fn series(scratch: &ScratchFolder) -> (Vec<f64>, Vec<Vec<f64>>) {
    scratch.file("all.toml", &format!("{}\n[retain]\ntrajectories = \"all\"\n", campaign()));
    scratch.prints("campaign all.toml --out all --no-report", 0);
    let table = |sample: usize| scratch.table(&format!("all/trajectories/sample-{sample:06}.parquet"));
    let values = (1..=RUNS).map(|sample| floats(&table(sample), SERIES)).collect();
    (floats(&table(1), "time_s"), values)
}

fn entry(scratch: &ScratchFolder, result: &str) -> Value {
    scratch.summary(result)["requirements"]["list"][0].clone()
}

fn verdict(scratch: &ScratchFolder, requirement: &str, code: i32) -> Value {
    scratch.file("gate.toml", &format!("{}\n[[require]]\nband = \"{SERIES}\"\n{requirement}\n", campaign()));
    scratch.prints("campaign gate.toml --out gate --no-report", code);
    entry(scratch, "gate")
}

/// Law: the worst time is that with the fewest runs within the limit, and the verdict is the exact test's.
#[test]
fn counts_are_those_of_the_time_series() {
    let scratch = folder("band-requirements");
    let (times, runs) = series(&scratch);
    assert_eq!((times.len(), runs.len()), (11, RUNS));
    // a limit that 97% of the runs keep at the worst point, as the greatest quantile over time says
    let at = |point: usize| {
        let mut values: Vec<f64> = runs.iter().map(|run| run[point]).collect();
        values.sort_by(f64::total_cmp);
        values
    };
    let limit = (0..times.len()).map(|point| at(point)[RUNS * 97 / 100]).fold(f64::NEG_INFINITY, f64::max);
    let within = |point: usize| runs.iter().filter(|run| run[point] <= limit).count() as u64;
    let worst = (0..times.len()).map(within).min().unwrap();
    assert!(worst < RUNS as u64 && worst > RUNS as u64 * 9 / 10, "{worst}");

    let all = verdict(&scratch, &format!("fraction = 0.9\nat_most = {limit:?}"), 0);
    assert_eq!((&all["verdict"], &all["runs"]), (&Value::from("PASS"), &Value::from(RUNS)));
    let number = |value: &Value| value.as_u64().unwrap_or_else(|| panic!("{value}"));
    let (violations, unresolved) = (number(&all["violations"]), number(&all["band"]["unresolved"]));
    let exact = RUNS as u64 - worst;
    assert!(
        exact <= violations && violations - unresolved <= exact,
        "{exact} of {violations}, {unresolved} unresolved"
    );
    assert_eq!(all["band"]["points"], 11);
    let worst_at = all["band"]["worst_at_s"].as_f64().unwrap();
    let point = times.iter().position(|time| *time == worst_at).unwrap();
    assert!(within(point) <= worst + unresolved, "{worst_at} s has {}", within(point));

    // the bands know the count at a limit between two numbers only, and the bounds are those of both
    let mut are_apart = [false; 2];
    for percent in [75, 79, 83, 87, 91] {
        let limit = (0..times.len()).map(|point| at(point)[RUNS * percent / 100]).fold(f64::NEG_INFINITY, f64::max);
        let within = |point: usize| runs.iter().filter(|run| run[point] <= limit).count() as u64;
        let exact = (0..times.len()).map(within).min().unwrap();
        let found = verdict(&scratch, &format!("fraction = 0.5\nat_most = {limit:?}"), 0);
        let least = RUNS as u64 - number(&found["violations"]);
        let most = least + number(&found["band"]["unresolved"]);
        let [lower, upper] = [0, 1].map(|end| found["bounds"][end].as_f64().unwrap());
        let bounds = [lower_bound(exact, RUNS as u64, 0.95), upper_bound(exact, RUNS as u64, 0.95)];
        assert!(lower <= bounds[0] && bounds[1] <= upper, "{bounds:?}: {found}");
        are_apart = [are_apart[0] || exact < most, are_apart[1] || least < exact];
    }
    assert_eq!(are_apart, [true; 2]);

    // a share that is missed; too few runs to tell; a part of the time, in which more runs keep the limit
    assert_eq!(verdict(&scratch, &format!("fraction = 0.999\nat_most = {limit:?}"), 3)["verdict"], "FAIL");
    assert_eq!(verdict(&scratch, &format!("quantile = 0.97\nat_most = {limit:?}"), 5)["verdict"], "UNDECIDED");
    let high = (0..times.len()).map(|point| *at(point).last().unwrap()).fold(f64::NEG_INFINITY, f64::max);
    let every = verdict(&scratch, &format!("fraction = 0.99\nat_most = {high:?}\nfrom_s = 0.05\nto_s = 0.95"), 0);
    assert_eq!((&every["violations"], &every["band"]["points"]), (&Value::from(0), &Value::from(9)));
    assert_eq!(
        every["requirement"],
        format!("energy of the body <= {high:?} J at each time from 0.05 s to 0.95 s in 99%, with 95% confidence")
    );
    // the value is the quantile at the worst time of the interval, whichever time it begins at
    for (from, to) in [(0, 10), (3, 10), (6, 8), (9, 9)] {
        let limits = format!("from_s = {:?}\nto_s = {:?}", times[from], times[to]);
        let some = verdict(&scratch, &format!("quantile = 0.5\nat_most = {high:?}\n{limits}"), 0);
        let worst_at = some["band"]["worst_at_s"].as_f64().unwrap();
        let point = times.iter().position(|time| *time == worst_at).unwrap();
        assert!((from..=to).contains(&point), "{some}");
        let (value, exact) = (some["value"].as_f64().unwrap(), at(point)[RUNS / 2]);
        assert!((value / exact - 1.0).abs() < 0.05, "{value} for {exact} at {worst_at} s");
    }
    // both ends of an interval belong to it, to rounding; a number that is visibly beyond a point does not reach it
    let beyond = 1.0 + 1e-14;
    for (from, to, points) in [
        (times[2], times[7], 6),
        (times[2].next_up(), times[7].next_down(), 6),
        (times[2] * beyond, times[7] / beyond, 4),
        (times[4], times[4], 1),
    ] {
        let some =
            verdict(&scratch, &format!("fraction = 0.99\nat_most = {high:?}\nfrom_s = {from:?}\nto_s = {to:?}"), 0);
        assert_eq!(some["band"]["points"], points, "from {from:?} s to {to:?} s");
    }
}

#[test]
fn all_times_are_those_of_each_run() {
    let scratch = folder("all-times");
    let long = |tables: &str| {
        let replaced = [("duration_s = 1.0", "duration_s = 20.0"), ("points = 11", "points = 41"), ("1e-10", "1e-14")];
        replaced.into_iter().fold(campaign(), |text, (old, new)| text.replace(old, new)) + tables
    };
    scratch.file("series.toml", &long("\n[retain]\ntrajectories = \"all\"\n"));
    scratch.prints("campaign series.toml --out series --no-report", 0);
    let tables: Vec<_> =
        (1..=RUNS).map(|sample| scratch.table(&format!("series/trajectories/sample-{sample:06}.parquet"))).collect();
    let times = floats(&tables[0], "time_s");
    let plain = scratch.rows("series");
    let mut seen = Vec::new();
    for (series, sides) in [("energy_error", &[true, false][..]), ("spin_axis_angle_rad", &[true])] {
        let runs: Vec<Vec<f64>> = tables.iter().map(|table| floats(table, series)).collect();
        for (from, to) in [(None, None), (Some(times[7]), Some(times[22]))] {
            let points: Vec<usize> = (0..41)
                .filter(|point| {
                    from.is_none_or(|from| from <= times[*point]) && to.is_none_or(|to| times[*point] <= to)
                })
                .collect();
            for is_highest in sides.iter().copied() {
                let beyond = |run: &[f64]| {
                    let values = points.iter().map(|point| run[*point]);
                    if is_highest {
                        values.fold(f64::NEG_INFINITY, f64::max)
                    } else {
                        values.fold(f64::INFINITY, f64::min)
                    }
                };
                let mut extremes: Vec<f64> = runs.iter().map(|run| beyond(run)).collect();
                extremes.sort_by(f64::total_cmp);
                let limit = extremes[RUNS / 2];
                let is_met = |value: f64| if is_highest { value <= limit } else { value >= limit };
                let within = runs.iter().filter(|run| is_met(beyond(run))).count();
                let end = |key: &str, end: Option<f64>| end.map_or(String::new(), |end| format!("{key} = {end:?}\n"));
                let side = if is_highest { "at_most" } else { "at_least" };
                let tables = |all: bool| {
                    format!(
                        "\n[[require]]\nband = \"{series}\"\nfraction = 0.6\n{side} = {limit:?}\nat_all_times = \
                        {all}\n{}{}",
                        end("from_s", from),
                        end("to_s", to)
                    )
                };
                scratch.file("all.toml", &long(&tables(true)));
                scratch.prints("campaign all.toml --out all --no-report --overwrite", 3);
                let found = entry(&scratch, "all");
                let named = (&found["verdict"], &found["violations"], &found["band"]["at_all_times"]);
                assert_eq!(named, (&Value::from("FAIL"), &Value::from(RUNS - within), &Value::from(true)), "{found}");
                let column = found["observable"].as_str().unwrap();
                let rows = scratch.rows("all");
                let shown: Vec<f64> = rows.iter().flat_map(|rows| floats(rows, column)).skip(1).collect();
                assert!(shown.iter().zip(&runs).all(|(shown, run)| *shown == beyond(run)), "{column}");
                for (rows, plain) in rows.iter().zip(&plain) {
                    assert_eq!(rows.num_columns(), plain.num_columns() + 1);
                    assert!(
                        plain
                            .schema()
                            .fields()
                            .iter()
                            .all(|field| rows.column_by_name(field.name()) == plain.column_by_name(field.name()))
                    );
                }
                let share = |point: &usize| runs.iter().filter(|run| is_met(run[*point])).count() as f64 / RUNS as f64;
                let worst = points.iter().map(share).fold(1.0, f64::min);
                if worst > 0.75 {
                    scratch.file("each.toml", &long(&tables(false)));
                    scratch.prints("campaign each.toml --out each --no-report --overwrite", 0);
                }
                seen.push(worst > 0.75);
            }
        }
    }
    assert!(seen.iter().filter(|passes| **passes).count() >= 2, "each time passes and all times fail: {seen:?}");
}
