//! Campaigns of known truth and their comparison, for tests here and in the package of findings.

use crate::analysis::comparison::{Absence, Comparison, adjust, compared};
use crate::analysis::population::Population;
use crate::analysis::statistics::{ColumnStatistics, Statistics};
use crate::math::normal::quantile;
use crate::run::{Quantity, Status};
use crate::sampling::{SampleId, Stream};
use crate::statistics::moments::Moments;

const NAMES: [&str; 3] = ["a", "b", "c"];

/// Compares two campaigns with these observables, NaN for none; `are_pairs`: of the same samples.
pub fn comparison(rows: [&[[f64; 3]]; 2], are_pairs: bool) -> Comparison {
    let statistics = |columns: Vec<ColumnStatistics>, runs: usize| Statistics {
        population: Population::Independent,
        confidence: 0.95,
        statuses: Status::ALL.map(|status| if status == Status::Done { runs as u64 } else { 0 }),
        quantile_error: 0.0,
        columns,
    };
    let pairs: Vec<[usize; 2]> = (0..rows[0].len()).filter(|_| are_pairs).map(|run| [run; 2]).collect();
    let ranges = rows.map(|rows| 0..rows.len());
    let is_ok = |_: usize| Some(false);
    let mut failures = Absence::of([&is_ok, &is_ok], ranges.clone(), &pairs);
    let mut columns: Vec<_> = NAMES
        .iter()
        .enumerate()
        .map(|(place, name)| {
            let values = rows.map(|rows| rows.iter().map(|row| row[place]).collect::<Vec<f64>>());
            let known =
                values.each_ref().map(|values| Moments::of(values.iter().copied().filter(|value| !value.is_nan())));
            let of = known.map(|moments| ColumnStatistics {
                quantity: Quantity::new(name, "", "A test."),
                moments,
                ..ColumnStatistics::default()
            });
            let lacks = values.each_ref().map(|values| move |row: usize| Some(values[row].is_nan()));
            let absence = Absence::of([&lacks[0], &lacks[1]], ranges.clone(), &pairs);
            compared([&of[0], &of[1]], values.each_ref().map(Vec::as_slice), &pairs, [0; 2], absence, 0.95)
        })
        .collect();
    adjust(&mut columns, &mut failures);
    let statistics = rows.map(|rows| statistics(Vec::new(), rows.len()));
    Comparison { statistics, pairs: pairs.len() as u64, failures, columns, alone: [Vec::new(), Vec::new()] }
}

/// Runs with three observables: normal, skewed, and one that is missing with probability `lacking`. `scene` seeds the
/// samples, `noise` is the part that runs of one sample do not share.
pub fn rows(runs: u64, [scene, other]: [u64; 2], noise: f64, lacking: f64) -> Vec<[f64; 3]> {
    let (mut of_scene, mut own) = (Stream::new(scene, "scene"), Stream::new(other, "own"));
    (0..runs)
        .map(|run| {
            let mut score = |k: u64| {
                let [x, y] =
                    [of_scene.uniform(SampleId(3 * run + k)), own.uniform(SampleId(4 * run + k))].map(quantile);
                libm::sqrt(1.0 - noise * noise) * x + noise * y
            };
            let [a, b, c] = [score(0), libm::exp(score(1)), score(2)];
            [a, b, if own.uniform(SampleId(4 * run + 3)) < lacking { f64::NAN } else { c }]
        })
        .collect()
}
