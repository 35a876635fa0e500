//! Requirements over time: their counts are those of the time series, and their verdicts those of exact binomial tests.

use serde_json::Value;
use spindrift::statistics::binomial::{lower_bound, upper_bound};

use super::small_campaign::{campaign, folder};
use crate::support::scratch_folder::{ScratchFolder, floats};

/// Dispersed samples: all but the nominal one.
const RUNS: usize = 599;
/// A quantity with bands in the default groups.
const SERIES: &str = "energy_body_j";

/// The time series of every dispersed run at the points of the bands, which are all of the grid: times, and values run by run.
fn series(scratch: &ScratchFolder) -> (Vec<f64>, Vec<Vec<f64>>) {
    scratch.file("all.toml", &format!("{}\n[retain]\ntrajectories = \"all\"\n", campaign()));
    scratch.prints("campaign all.toml --out all --no-report", 0);
    let table = |sample: usize| scratch.table(&format!("all/trajectories/sample-{sample:06}.parquet"));
    let values = (1..=RUNS).map(|sample| floats(&table(sample), SERIES)).collect();
    (floats(&table(1), "time_s"), values)
}

/// Runs the campaign with one requirement; its entry in the summary.
fn verdict(scratch: &ScratchFolder, requirement: &str, code: i32) -> Value {
    scratch.file("gate.toml", &format!("{}\n[[require]]\nband = \"{SERIES}\"\n{requirement}\n", campaign()));
    scratch.prints("campaign gate.toml --out gate --no-report", code);
    let summary: Value = serde_json::from_slice(&std::fs::read(scratch.path("gate/summary.json")).unwrap()).unwrap();
    summary["requirements"]["list"][0].clone()
}

/// Law: the worst point of time is that with the fewest runs within the limit, their number is within what the bands resolve, and the
/// verdict is that of the exact test at every point; an interval of time leaves out what is outside. The bounds of the share contain those of
/// the exact count.
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

    // the counter-tests: a share that is missed; too few runs to tell; a part of the time, in which more runs keep the limit
    assert_eq!(verdict(&scratch, &format!("fraction = 0.999\nat_most = {limit:?}"), 3)["verdict"], "FAIL");
    assert_eq!(verdict(&scratch, &format!("quantile = 0.97\nat_most = {limit:?}"), 5)["verdict"], "UNDECIDED");
    let high = (0..times.len()).map(|point| *at(point).last().unwrap()).fold(f64::NEG_INFINITY, f64::max);
    let every = verdict(&scratch, &format!("fraction = 0.99\nat_most = {high:?}\nfrom_s = 0.05\nto_s = 0.95"), 0);
    assert_eq!((&every["violations"], &every["band"]["points"]), (&Value::from(0), &Value::from(9)));
    assert_eq!(
        every["requirement"],
        format!("99% of runs with {SERIES} at most {high:?} J from 0.05 s to 0.95 s, with 95% confidence")
    );
}
