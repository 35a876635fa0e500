//! [`Comparison`]: two results compared, observable by observable: shifts of their statistics, and tests whether chance explains them.
//!
//! Where both results drew the same samples, about whichever nominal values, they are compared sample by sample (common random numbers): a
//! difference that is small beside the spread of the runs is then seen. Statistics are of all rows, tests of distributions and of pairs of
//! the first [`MOST_EXACT`](crate::analysis::column_counts::MOST_EXACT) samples.
//!
//! An observable of independent samples has two tests, of its mean and of its distribution: its p-value is twice the smaller of both (Bonferroni). Of
//! pairs it has that of its distribution in both results ([`marginals`]): a mean of differences is normal only where no rare one is large, and
//! differences of a quantity that is wrapped to one period have such. Another test, of the pairs' differences ([`signed_ranks`]), tells whether the runs
//! moved, be it so that the distribution did not. There are many observables: p-values are adjusted by Holm's method. Where nothing differs, the
//! probability that any observable is called shifted is then at most [`Comparison::level`], and so is that of being called moved.

use std::num::NonZeroUsize;

use crate::analysis::accumulator::of_files;
use crate::analysis::observed::Observed;
use crate::analysis::pairing::{MOST_ROWS, ResultRows, first_dispersed, pairs};
use crate::analysis::statistics::{self, ColumnStatistics, Statistics};
use crate::analysis::statuses::StatusCounter;
use crate::campaign::Requirement;
use crate::run::{Quantity, Status};
use crate::statistics::moments::Moments;
use crate::statistics::quantile::percent;
use crate::statistics::two_sample::{Difference, holm, kolmogorov_smirnov, marginals, paired, signed_ranks, welch};
use crate::storage::rows_reader::RowsError;

/// Columns that are read at a time.
const AT_A_TIME: usize = 16;

/// The shift of one statistic.
#[derive(Clone, Debug, PartialEq)]
pub struct Shift {
    /// Which statistic: `mean`, `standard deviation`, `p95`.
    pub statistic: String,
    /// Its value in the first result.
    pub first: f64,
    /// Its value in the second.
    pub second: f64,
    /// The magnitude of their difference, in units of [`ColumnComparison::scale`].
    pub relative: f64,
}

/// One observable of two results.
#[derive(Clone, Debug, PartialEq)]
pub struct ColumnComparison {
    /// Name, unit and meaning.
    pub quantity: Quantity,
    /// What shifts are relative to: the standard deviation in the first result; where that is 0 the magnitude of its mean, or 1.
    pub scale: f64,
    /// The shift of each statistic that both results have.
    pub shifts: Vec<Shift>,
    /// The shift of the mean with its interval: of pairs, or by Welch's test.
    pub mean: Option<Difference>,
    /// P-value of the distributions: of [`marginals`] of the pairs, or of Kolmogorov and Smirnov's test.
    pub distribution_p_value: Option<f64>,
    /// P-value of the pairs' differences; `None` without pairs, or where none differs.
    pub moved_p_value: Option<f64>,
    /// The same, adjusted for the number of observables.
    pub adjusted_moved_p_value: Option<f64>,
    pub differing_pairs: u64,
    /// Whether a requirement of either plan names it.
    pub is_required: bool,
    /// P-value of what decides whether it is shifted; `None` where there is none.
    pub p_value: Option<f64>,
    /// The same, adjusted for the number of observables.
    pub adjusted_p_value: Option<f64>,
}

impl ColumnComparison {
    pub fn largest(&self) -> Option<&Shift> {
        self.shifts.iter().max_by(|a, b| a.relative.total_cmp(&b.relative))
    }

    /// The magnitude of that; 0 where there is none.
    pub fn largest_relative(&self) -> f64 {
        self.largest().map_or(0.0, |shift| shift.relative)
    }

    /// Whether any statistic is shifted by more than `tolerance`; what is not a number in one result only is.
    pub fn is_beyond(&self, tolerance: f64) -> bool {
        !self.shifts.iter().all(|shift| shift.relative <= tolerance)
    }
}

#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    pub statistics: [Statistics; 2],
    /// Samples of both that were drawn alike and are `ok` in both; 0 where the results are not paired.
    pub pairs: u64,
    /// The observables that both have: the most significant first, and before all others those that a requirement names.
    pub columns: Vec<ColumnComparison>,
    /// The observables that only one has: of the first, of the second.
    pub alone: [Vec<String>; 2],
}

impl Comparison {
    /// The shift of the fraction of runs that are `ok`.
    pub fn shift_of_ok(&self) -> f64 {
        let [first, second] = self.statistics.each_ref().map(|of| of.ok() as f64 / of.samples().max(1) as f64);
        second - first
    }

    /// Whether any statistic, or the fraction of runs that are `ok`, is shifted by more than `tolerance`; what is not a number in one
    /// result only is.
    pub fn is_beyond(&self, tolerance: f64) -> bool {
        self.shift_of_ok().abs() > tolerance || self.columns.iter().any(|column| column.is_beyond(tolerance))
    }

    /// The probability that any observable is called shifted where none is: one less the confidence of the intervals, and at most a tenth.
    pub fn level(&self) -> f64 {
        (1.0 - self.statistics[0].confidence).min(MOST_LEVEL)
    }

    /// Whether chance does not explain the difference between the values of an observable.
    pub fn is_shifted(&self, column: &ColumnComparison) -> bool {
        column.largest_relative() > 0.0 && column.adjusted_p_value.is_some_and(|p| p <= self.level())
    }
}

impl Comparison {
    /// Whether the runs of an observable moved, each a little or most of them one way, and chance does not explain it, while its distribution is not shifted.
    pub fn is_moved(&self, column: &ColumnComparison) -> bool {
        !self.is_shifted(column) && column.adjusted_moved_p_value.is_some_and(|p| p <= self.level())
    }
}

/// Largest probability of a false alarm, whatever the confidence of the intervals.
const MOST_LEVEL: f64 = 0.1;

/// Compares `first` with `second`.
///
/// # Errors
/// Where a file cannot be read.
pub fn compare(
    first: ResultRows<'_>,
    second: ResultRows<'_>,
    threads: Option<NonZeroUsize>,
) -> Result<Comparison, RowsError> {
    let of = |ResultRows { plan, reader, .. }: ResultRows<'_>| {
        let ended = of_files(&StatusCounter::new(plan), reader, threads)?;
        statistics::compute(plan, reader, &ended, None, threads)
    };
    let statistics = [of(first)?, of(second)?];
    let pairs = pairs(first, second)?.unwrap_or_default();
    let starts = [first_dispersed(first.plan), first_dispersed(second.plan)];
    let confidence = first.plan.analysis.confidence;
    let (all, others) = (Observed::all(first.plan), Observed::all(second.plan));
    let other = |name: &str| others.iter().find(|observed| observed.quantity.name() == name);
    let shared: Vec<(&Observed, &Observed)> =
        all.iter().filter_map(|observed| Some((observed, other(observed.quantity.name())?))).collect();
    let mut columns = Vec::with_capacity(shared.len());
    for batch in shared.chunks(AT_A_TIME) {
        let of_first = values(first, batch.iter().map(|(observed, _)| *observed))?;
        let of_second = values(second, batch.iter().map(|(_, observed)| *observed))?;
        for (((observed, _), a), b) in batch.iter().zip(&of_first).zip(&of_second) {
            let name = observed.quantity.name();
            if let Some((of_a, of_b)) = statistics[0].column(name).zip(statistics[1].column(name)) {
                columns.push(compared([of_a, of_b], [a, b], &pairs, starts, confidence));
            }
        }
    }
    let required: Vec<&str> = [first.plan, second.plan]
        .into_iter()
        .flat_map(|plan| plan.analysis.requirements.iter().filter_map(Requirement::observable))
        .collect();
    columns.iter_mut().for_each(|column| column.is_required = required.contains(&column.quantity.name()));
    adjust(&mut columns);
    let names = |list: &[Observed]| -> Vec<String> {
        list.iter().map(|observed| observed.quantity.name().to_owned()).collect()
    };
    let (names_of_first, names_of_second) = (names(&all), names(&others));
    let without = |names: &[String], other: &[String]| -> Vec<String> {
        names.iter().filter(|name| !other.contains(name)).cloned().collect()
    };
    let alone = [without(&names_of_first, &names_of_second), without(&names_of_second, &names_of_first)];
    Ok(Comparison { statistics, pairs: pairs.len() as u64, columns, alone })
}

/// The values of observables for the first samples, indexed by sample; NaN for a run without one or one that is not `ok`.
fn values<'o>(
    result: ResultRows<'_>,
    observed: impl Iterator<Item = &'o Observed> + Clone,
) -> Result<Vec<Vec<f64>>, RowsError> {
    let mut columns = vec![Vec::new(); observed.clone().count()];
    for part in result.reader.first_parts(MOST_ROWS) {
        let part = part?;
        let statuses = part.statuses()?;
        for (column, observed) in columns.iter_mut().zip(observed.clone()) {
            let values = observed.values(&part)?.into_iter().zip(&statuses);
            column.extend(values.map(|(value, status)| if *status == Status::Done { value } else { f64::NAN }));
        }
    }
    columns.iter_mut().for_each(|column: &mut Vec<f64>| column.truncate(MOST_ROWS));
    Ok(columns)
}

fn compared(
    statistics: [&ColumnStatistics; 2],
    values: [&[f64]; 2],
    pairs: &[[usize; 2]],
    starts: [usize; 2],
    confidence: f64,
) -> ColumnComparison {
    let moments = statistics.map(|of| of.moments);
    let deviation = moments[0].standard_deviation().filter(|deviation| *deviation > 0.0);
    let magnitude = moments[0].mean().map(f64::abs).filter(|mean| *mean > 0.0);
    let scale = deviation.or(magnitude).unwrap_or(1.0);
    let mut shifts = Vec::new();
    let mut shift = |statistic: String, [first, second]: [Option<f64>; 2]| {
        let Some((first, second)) = first.zip(second) else { return };
        let relative = if first == second { 0.0 } else { (second - first).abs() / scale };
        shifts.push(Shift { statistic, first, second, relative });
    };
    shift("mean".to_owned(), moments.map(|of| of.mean()));
    shift("standard deviation".to_owned(), moments.map(|of| of.standard_deviation()));
    for quantile in &statistics[0].quantiles {
        if let Some(other) = statistics[1].quantiles.iter().find(|other| other.p == quantile.p) {
            shift(format!("p{}", percent(quantile.p)), [quantile.value, other.value]);
        }
    }
    let tests = tested(moments, values, pairs, starts, confidence);
    ColumnComparison {
        quantity: statistics[0].quantity.clone(),
        scale,
        shifts,
        mean: tests.mean,
        distribution_p_value: tests.distribution,
        moved_p_value: tests.moved,
        adjusted_moved_p_value: None,
        differing_pairs: tests.differing,
        is_required: false,
        p_value: tests.p_value,
        adjusted_p_value: None,
    }
}

/// The tests of one observable.
struct Tests {
    mean: Option<Difference>,
    distribution: Option<f64>,
    /// Of the differences of pairs.
    moved: Option<f64>,
    /// What decides whether it is shifted.
    p_value: Option<f64>,
    differing: u64,
}

fn tested(
    moments: [Moments; 2],
    values: [&[f64]; 2],
    pairs: &[[usize; 2]],
    starts: [usize; 2],
    confidence: f64,
) -> Tests {
    if pairs.is_empty() {
        let ascending = |which: usize| {
            let dispersed = values[which].iter().skip(starts[which]).copied();
            let mut values: Vec<f64> = dispersed.filter(|value| !value.is_nan()).collect();
            values.sort_unstable_by(f64::total_cmp);
            values
        };
        let distribution = kolmogorov_smirnov(&ascending(0), &ascending(1)).map(|(_, p)| p);
        let mean = welch(&moments[0], &moments[1], confidence);
        return Tests { mean, distribution, moved: None, p_value: of_both(mean, distribution), differing: 0 };
    }
    let both = pairs.iter().map(|[row, other]| [values[0][*row], values[1][*other]]);
    let both: Vec<[f64; 2]> = both.filter(|pair| !pair.iter().any(|value| value.is_nan())).collect();
    // equal infinities do not differ
    let difference = |[first, second]: &[f64; 2]| if first == second { 0.0 } else { second - first };
    let differences: Vec<f64> = both.iter().map(difference).collect();
    let distribution = marginals(&both);
    Tests {
        mean: paired(&Moments::of_block(&differences), confidence),
        distribution,
        moved: signed_ranks(&differences),
        p_value: distribution,
        differing: differences.iter().filter(|difference| **difference != 0.0).count() as u64,
    }
}

/// The p-value of two tests of one hypothesis. A test of means that saw no spread has none to judge a shift by: then the other one decides.
fn of_both(mean: Option<Difference>, distribution: Option<f64>) -> Option<f64> {
    let mean = mean.filter(|found| found.shift.value == 0.0 || found.shift.lower < found.shift.upper);
    match (mean.map(|found| found.p_value), distribution) {
        (Some(a), Some(b)) => Some((2.0 * a.min(b)).min(1.0)),
        (a, b) => a.or(b),
    }
}

/// Adjusts the p-values of `columns` for their number, those of each question for itself, and sorts them: required ones first, then by significance, then by the largest shift.
fn adjust(columns: &mut [ColumnComparison]) {
    let of_all = |of: &dyn Fn(&ColumnComparison) -> Option<f64>| {
        holm(&columns.iter().filter_map(of).collect::<Vec<f64>>()).into_iter()
    };
    let (mut adjusted, mut moved) = (of_all(&|column| column.p_value), of_all(&|column| column.moved_p_value));
    for column in columns.iter_mut() {
        column.adjusted_p_value = column.p_value.and_then(|_| adjusted.next());
        column.adjusted_moved_p_value = column.moved_p_value.and_then(|_| moved.next());
    }
    // a p-value that underflows is no better than another one: the shift decides
    columns.sort_by(|a, b| {
        let p = |column: &ColumnComparison| column.p_value.unwrap_or(1.0);
        let by_p = p(a).total_cmp(&p(b)).then_with(|| b.largest_relative().total_cmp(&a.largest_relative()));
        b.is_required.cmp(&a.is_required).then(by_p)
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::normal::quantile;
    use crate::sampling::{SampleId, Stream};

    const RUNS: usize = 40;
    /// Pairs show a shift that is small beside their spread where many of them go through a limit.
    const PAIRED_RUNS: usize = 400;
    const OBSERVABLES: usize = 12;

    /// The next `count` standard normal scores of a stream that has given `drawn`.
    fn scores(stream: &mut Stream, drawn: &mut u64, count: usize) -> Vec<f64> {
        *drawn += count as u64;
        (*drawn - count as u64..*drawn).map(|k| quantile(stream.uniform(SampleId(k)))).collect()
    }

    /// An observable of a score: normal, skewed, heavy tailed, never negative, a rare event, a count, or constant.
    fn shape(observable: usize, score: f64) -> f64 {
        match observable % 7 {
            0 => score,
            1 => libm::exp(score),
            2 => score * score * score,
            3 => score * score,
            4 => f64::from(score > 2.0),
            5 => libm::round(3.0 * score),
            _ => 5.0,
        }
    }

    /// Whether the first observable, and whether any other one, is called shifted in a pair of campaigns: of two that drew the same samples but
    /// for `noise`, or of independent ones; `shift` is that of the first observable.
    fn found(campaign: usize, noise: Option<f64>, as_pairs: bool, shift: f64) -> [bool; 2] {
        let runs = if as_pairs { PAIRED_RUNS } else { RUNS };
        let (mut stream, mut drawn) = (Stream::new(campaign as u64, "comparison"), 0);
        let mut scores = || scores(&mut stream, &mut drawn, runs);
        let common = scores();
        let pairs: Vec<[usize; 2]> = (0..runs).filter(|_| as_pairs).map(|run| [run; 2]).collect();
        let p_values: Vec<Option<f64>> = (0..OBSERVABLES)
            .map(|observable| {
                let own = scores();
                let values = ["first", "second"].map(|which| {
                    let moved = if observable == 0 && which == "second" { shift } else { 0.0 };
                    let other = scores();
                    let rows = common.iter().zip(&own).zip(&other);
                    // observables depend on each other
                    let score = |((common, own), other): ((&f64, &f64), &f64)| match noise {
                        Some(noise) => 0.6 * common + 0.8 * own + noise * other,
                        None => *other,
                    };
                    rows.map(|row| shape(observable, score(row)) + moved).collect::<Vec<f64>>()
                });
                let moments = values.each_ref().map(|values| Moments::of_block(values));
                tested(moments, values.each_ref().map(Vec::as_slice), &pairs, [0; 2], 0.95).p_value
            })
            .collect();
        let tested: Vec<f64> = p_values.iter().copied().flatten().collect();
        let adjusted = holm(&tested);
        [adjusted[0] <= 0.05, adjusted[1..].iter().any(|p| *p <= 0.05)]
    }

    /// Part of 250 pairs of campaigns for which `is` holds, seeds 0 to 249.
    fn part(is: impl Fn(usize) -> bool) -> f64 {
        (0..250).filter(|campaign| is(*campaign)).count() as f64 / 250.0
    }

    /// H0: nothing is shifted; the probability of any alarm among all observables is at most 0.05. Of 250 pairs of campaigns at most 0.0927 have one
    /// (3.1 standard deviations, alpha = 1e-3; measured: 0.024, 0 and 0). Power: a shift of one standard deviation, 4.5 standard
    /// errors, of one observable is found in 0.90 (bound 0.8); 400 pairs with a noise of a tenth find one of a quarter in every campaign, of which as many
    /// independent samples find one in none.
    #[test]
    fn false_alarms_are_as_rare_as_stated() {
        for (noise, as_pairs) in [(None, false), (Some(0.1), true), (Some(0.1), false)] {
            let alarms = part(|campaign| found(campaign, noise, as_pairs, 0.0).contains(&true));
            println!("alarms {noise:?} {as_pairs}: {alarms}");
            assert!(alarms <= 0.0927, "{noise:?} {as_pairs}: {alarms}");
        }
        let power = |noise, as_pairs, shift| part(|campaign| found(campaign, noise, as_pairs, shift)[0]);
        let (independent, pairs) = (power(None, false, 1.0), power(Some(0.1), true, 0.25));
        println!("power {independent} {pairs}");
        assert!(independent > 0.8 && pairs > 0.8, "{independent} {pairs}");
        let without = power(Some(0.1), false, 0.25);
        println!("without {without}");
        assert!(without < 0.3, "{without}");
    }

    /// Pairs whose distributions are the same and whose differences are not symmetric: a phase that moves on by 0.1 or 1 and is wrapped to one period, an
    /// exponential number that is replaced by a new one or grows a little, and one whose order is turned round about its median.
    fn unshifted(which: usize, u: f64, other: f64) -> [f64; 2] {
        let exponential = |u: f64| -libm::log1p(-u);
        let (step, fresh) = (0.1 / core::f64::consts::TAU, exponential(other));
        match which {
            0 => [u, libm::fmod(u + step, 1.0)],
            1 => [u, libm::fmod(u + 10.0 * step, 1.0)],
            // quantiles go up by a hundredth, and those of the largest hundredth to the smallest
            2 => [exponential(u), exponential(libm::fmod(u + 0.01, 1.0))],
            3 => [exponential(u), if u < 0.5 { exponential(u) } else { fresh + core::f64::consts::LN_2 }],
            _ => [exponential(u), exponential(1.0 - u)],
        }
    }

    /// H0: the distributions are the same, and each test is at the level 0.05. Of 1,000 pairs of campaigns of 30, 105 or 1,000 runs at most 0.0735 are called
    /// shifted (3.4 standard deviations, alpha = 3e-4 of each of 15). The counter-tests: signed ranks call the wrapped phase moved nearly always, as it is, and Student's t
    /// of the differences shifted. Power: the same steps without the wrap, of numbers that are normal, are found.
    #[test]
    fn asymmetric_differences_are_no_shift() {
        const CAMPAIGNS: u64 = 1000;
        let at_level = |count: u64| count as f64 / CAMPAIGNS as f64;
        for (which, runs) in (0..5).flat_map(|which| [30, 105, 1000].map(|runs| (which, runs))) {
            let mut counts = [0_u64; 3];
            for campaign in 0..CAMPAIGNS {
                let mut stream = Stream::new(campaign, "asymmetric");
                let pair = |k: u64, stream: &mut Stream| {
                    let [u, other] = [2 * k, 2 * k + 1].map(|k| stream.uniform(SampleId(k)));
                    unshifted(which, u, other)
                };
                let both: Vec<[f64; 2]> = (0..runs).map(|k| pair(k, &mut stream)).collect();
                let [first, second] = [0, 1].map(|place| both.iter().map(|pair| pair[place]).collect::<Vec<f64>>());
                let pairs: Vec<[usize; 2]> = (0..both.len()).map(|run| [run; 2]).collect();
                let moments = [&first, &second].map(|values| Moments::of_block(values));
                let tests = tested(moments, [&first, &second], &pairs, [0; 2], 0.95);
                let p_values = [tests.p_value, tests.moved, tests.mean.map(|mean| mean.p_value)];
                counts
                    .iter_mut()
                    .zip(p_values)
                    .for_each(|(count, p)| *count += u64::from(p.is_some_and(|p| p <= 0.05)));
            }
            let [shifted, moved, means] = counts.map(at_level);
            println!("{which}, {runs} runs: shifted {shifted}, moved {moved}, mean of differences {means}");
            assert!(shifted <= 0.0735, "{which} {runs}: {shifted}");
            if which == 0 && runs == 105 {
                assert!(moved > 0.99 && means > 0.15, "the counter-tests: {moved} {means}");
            }
        }
        // a step of a tenth of the spread, up through each limit and never down
        for (runs, least) in [(400_u64, 0.8), (1000, 0.99)] {
            let shifted = |campaign: &u64| {
                let mut stream = Stream::new(*campaign, "shifted");
                let first: Vec<f64> = (0..runs).map(|k| quantile(stream.uniform(SampleId(k)))).collect();
                marginals(&first.iter().map(|x| [*x, x + 0.1]).collect::<Vec<_>>()).is_some_and(|p| p <= 0.05)
            };
            let power = (0..100_u64).filter(shifted).count() as f64 / 100.0;
            println!("power of {runs}: {power}");
            assert!(power >= least, "{runs}: {power}");
        }
    }

    /// Law: a test of means that saw no spread does not decide; without the other test there is no verdict.
    #[test]
    fn a_shift_without_spread_is_judged_by_the_other_test() {
        let certain = paired(&Moments::of_block(&[2.0; 3]), 0.95);
        assert_eq!(certain.map(|found| found.p_value), Some(0.0));
        assert_eq!((of_both(certain, Some(0.3)), of_both(certain, None), of_both(None, None)), (Some(0.3), None, None));
        let spread = paired(&Moments::of_block(&[1.0, 2.0, 3.0]), 0.95);
        assert_eq!(of_both(spread, Some(0.001)), Some(0.002));
    }
}
