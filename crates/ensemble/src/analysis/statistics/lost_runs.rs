//! Intervals of campaigns with lost runs, against known truths.

use super::*;
use crate::analysis::column_counts::GroupCounts;
use crate::analysis::small_plan::small_plan;
use crate::sampling::{SampleId, Stream};
use crate::statistics::binomial::at_least;

struct Uniform(Stream, u64);

impl Uniform {
    fn new(seed: u64) -> Self {
        Uniform(Stream::new(seed, "lost"), 0)
    }

    fn next(&mut self) -> f64 {
        self.1 += 1;
        self.0.uniform(SampleId(self.1))
    }
}

fn described_of(plan: &Plan, groups: &[Vec<f64>], lost: &[u64]) -> ColumnStatistics {
    let mut counts = ColumnCounts::default();
    for values in groups {
        let moments = Moments::of_block(values);
        counts.moments.merge(&moments);
        counts.groups.push(GroupCounts { moments, values: values.clone(), ..GroupCounts::default() });
    }
    let missing: u64 = lost.iter().sum();
    let loss = Loss { missing, runs: missing + counts.moments.count(), outside: 0 };
    let population = Population::of(plan).after(loss);
    let common = CommonRanks::new(plan, population, loss.runs);
    described(plan, (population, loss, lost), (&Observed::all(plan)[0], false), counts, &common)
}

/// A plan with a requirement on the mean of its first observable, within [0, 2].
fn bounded_plan(more: &str) -> Plan {
    let name = Observed::all(&small_plan(7, ""))[0].quantity.name().to_owned();
    let require =
        format!("require = [{{ observable = \"{name}\", mean = true, at_most = 9.0, bounded = [0.0, 2.0] }}]");
    small_plan(201, &format!("{require}\n{more}"))
}

const CAMPAIGNS: u64 = 300;
const RUNS: usize = 200;
const ALPHA: f64 = 1e-3;

/// H0: a 95% interval of a quantile or of the mean covers the truth in at least 95% of campaigns of 200 runs, uniform
/// in [0, 2], whichever runs are lost: the largest 2, 3.5 or 4.5%, the smallest, both, or any. 300 campaigns each,
/// seeds 1 to 300, alpha = 1e-3 for each interval. p50 is always bounded on both sides, p95 on at least one, the mean
/// only if its range is known. Counter-test: intervals of the values alone usually miss p95.
#[test]
fn intervals_cover_whichever_runs_are_lost() {
    let (bounded, plain) = (bounded_plan(""), small_plan(201, ""));
    let shares: [[f64; 3]; 6] = [
        [0.0, 0.02, 0.0],
        [0.0, 0.035, 0.0],
        [0.0, 0.045, 0.0],
        [0.035, 0.0, 0.0],
        [0.02, 0.02, 0.0],
        [0.0, 0.0, 0.04],
    ];
    for [slowest, fastest, any] in shares {
        let mut misses = [0_u64; 4];
        let (mut said, mut of_values) = (0, 0);
        for seed in 1..=CAMPAIGNS {
            let mut uniform = Uniform::new(seed);
            let drawn: Vec<[f64; 2]> = (0..RUNS).map(|_| [uniform.next(), uniform.next()]).collect();
            let kept = drawn.iter().filter(|[u, v]| *u >= slowest && *u <= 1.0 - fastest && *v >= any);
            let values: Vec<f64> = kept.map(|[u, _]| 2.0 * u).collect();
            let lost = (RUNS - values.len()) as u64;
            let found = described_of(&bounded, std::slice::from_ref(&values), &[lost]);
            assert!(
                lost == 0 || described_of(&plain, std::slice::from_ref(&values), &[lost]).mean_interval == [None; 2]
            );
            if !Population::of(&bounded).after(Loss { missing: lost, runs: RUNS as u64, outside: 0 }).has_intervals() {
                continue;
            }
            said += 1;
            let of = |p: f64| found.quantiles.iter().find(|one| one.p == p).expect("a quantile").interval;
            let ends = [(of(0.5), 1.0), (of(0.95), 1.9), (of(0.99), 1.98), (found.mean_interval, 1.0)];
            assert!(of(0.5).iter().chain(&found.mean_interval).all(Option::is_some) && of(0.95) != [None; 2]);
            for (misses, ([low, high], truth)) in misses.iter_mut().zip(ends) {
                *misses += u64::from(low.is_some_and(|low| low > truth) || high.is_some_and(|high| high < truth));
            }
            let alone = described_of(&plain, &[values], &[0]);
            let [_, high] = alone.quantiles.iter().find(|one| one.p == 0.95).expect("a quantile").interval;
            of_values += u64::from(high.is_some_and(|high| high < 1.9));
        }
        for misses in misses {
            assert!(at_least(misses, said, 0.05) > ALPHA, "{misses} of {said}: {slowest} {fastest} {any}");
        }
        assert!(fastest < 0.03 || 2 * of_values > said, "{of_values} of {said}: {fastest}");
    }
}

/// Law: the interval of replicates is the hull of those with the lost runs below and above all others, each in its own
/// replicate; for the mean, at the ends of the range.
#[test]
fn replicates_have_the_hull_too() {
    let plan = bounded_plan("design = { kind = \"sobol\", replicates = 10 }");
    let mut uniform = Uniform::new(1);
    let groups: Vec<Vec<f64>> = (0..10).map(|_| (0..20).map(|_| 2.0 * uniform.next()).collect()).collect();
    let lost = [0, 2, 0, 0, 1, 0, 0, 3, 0, 0];
    let kept: Vec<Vec<f64>> = groups.iter().zip(lost).map(|(group, lost)| group[lost..].to_vec()).collect();
    let found = described_of(&plan, &kept, &lost.map(|lost| lost as u64));
    let filled = |value: f64| {
        let group = |(group, lost): (&Vec<f64>, usize)| [vec![value; lost], group.clone()].concat();
        let groups: Vec<Vec<f64>> = kept.iter().zip(lost).map(group).collect();
        described_of(&plan, &groups, &[0; 10])
    };
    let [low, high] = [filled(0.0), filled(2.0)];
    for (place, one) in found.quantiles.iter().enumerate() {
        let ends = [low.quantiles[place].interval[0], high.quantiles[place].interval[1]];
        let known = [ends[0].filter(|end| *end > 0.0), ends[1].filter(|end| *end < 2.0)];
        assert_eq!(one.interval, known, "{}", one.p);
    }
    let median = found.quantiles.iter().find(|one| one.p == 0.5).expect("the median");
    assert!(median.interval.iter().all(Option::is_some), "{median:?}");
    for (end, filled) in [low.mean_interval[0], high.mean_interval[1]].into_iter().enumerate() {
        let (found, filled) = (found.mean_interval[end].expect("an end"), filled.expect("an end"));
        assert!((found - filled).abs() < 1e-14, "{found} {filled}");
    }
    assert_eq!((found.mean_error, found.deviation_interval), (None, [None; 2]));
}
