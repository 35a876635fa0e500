//! [`Comparison`]: two results compared, observable by observable: shifts of their statistics, and tests whether chance explains them.
//!
//! Where both results drew the same parameters for the same samples, they are compared sample by sample (common random numbers): a
//! difference that is small beside the spread of the runs is then seen. Statistics are of all rows, tests of distributions and of pairs of
//! the first [`MOST_EXACT`] samples.

use std::num::NonZeroUsize;

use crate::campaign::Plan;
use crate::dataset::observed::Observed;
use crate::dataset::rows_reader::{RowsError, RowsReader};
use crate::dataset::statistics::{self, ColumnStatistics, MOST_EXACT, Statistics};
use crate::run::{Quantity, Status};
use crate::statistics::moments::Moments;
use crate::statistics::quantile::percent;
use crate::statistics::two_sample::{Difference, kolmogorov_smirnov, paired, signed_ranks, welch};

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
    /// P-value of the distributions: of signed ranks of the pairs, or of Kolmogorov and Smirnov's test.
    pub distribution_p_value: Option<f64>,
    /// Pairs whose values differ.
    pub differing_pairs: u64,
}

impl ColumnComparison {
    /// The largest shift.
    pub fn largest(&self) -> Option<&Shift> {
        self.shifts.iter().max_by(|a, b| a.relative.total_cmp(&b.relative))
    }
}

/// Two results compared.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// The statistics of each.
    pub statistics: [Statistics; 2],
    /// Samples of both that were drawn alike and are `ok` in both; 0 where the results are not paired.
    pub pairs: u64,
    /// The observables that both have, in the order of the first.
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
        let within = |shift: &Shift| shift.relative <= tolerance;
        self.shift_of_ok().abs() > tolerance || self.columns.iter().any(|column| !column.shifts.iter().all(within))
    }
}

/// So many rows are compared one by one: the nominal sample and the first [`MOST_EXACT`].
const MOST_ROWS: usize = MOST_EXACT as usize + 1;

/// A result: its plan and the files of its rows.
#[derive(Clone, Copy, Debug)]
pub struct ResultRows<'r> {
    /// The plan.
    pub plan: &'r Plan,
    /// The rows.
    pub reader: &'r RowsReader,
}

/// Compares `first` with `second`.
///
/// # Errors
/// Where a file cannot be read.
pub fn compare(
    first: ResultRows<'_>,
    second: ResultRows<'_>,
    threads: Option<NonZeroUsize>,
) -> Result<Comparison, RowsError> {
    let of = |result: ResultRows<'_>| statistics::compute(result.plan, result.reader, None, threads);
    let statistics = [of(first)?, of(second)?];
    let pairs = pairs(first, second)?;
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

/// The rows of the samples that both results drew alike, among the first; empty where they did not disperse the same parameters in the same way.
fn pairs(first: ResultRows<'_>, second: ResultRows<'_>) -> Result<Vec<[usize; 2]>, RowsError> {
    let names = |plan: &Plan| -> Vec<String> {
        let columns = plan.dispersions.columns().iter();
        columns.map(|column| column.parameter.column_name(column.component)).collect()
    };
    let (of_first, of_second) = (names(first.plan), names(second.plan));
    if of_first.len() != of_second.len() || !of_first.iter().all(|name| of_second.contains(name)) {
        return Ok(Vec::new());
    }
    let drawn = |result: ResultRows<'_>, name: &str| -> Result<Vec<f64>, RowsError> {
        let mut column = Vec::new();
        for part in result.reader.first_parts(MOST_ROWS) {
            column.extend(part?.numbers(name)?);
        }
        Ok(column)
    };
    let mut pairs = shared_rows(first.plan, second.plan);
    let (rows, others) = (rows(first)?, rows(second)?);
    pairs.retain(|[row, other]| *row < rows && *other < others);
    for name in &of_first {
        let (a, b) = (drawn(first, name)?, drawn(second, name)?);
        let bits = |column: &[f64], row: usize| column.get(row).map(|value| value.to_bits());
        if pairs.iter().any(|[row, other]| bits(&a, *row) != bits(&b, *other)) {
            return Ok(Vec::new());
        }
    }
    Ok(pairs)
}

/// How many rows there are, of those that are compared: fewer than in the plan where it was stopped when it was precise enough.
fn rows(result: ResultRows<'_>) -> Result<usize, RowsError> {
    let rows = result.reader.first_parts(MOST_ROWS).map(|part| Ok(part?.rows())).sum::<Result<usize, RowsError>>()?;
    Ok(rows.min(MOST_ROWS))
}

/// The first rows of each plan that are of the same dispersed sample.
fn shared_rows(first: &Plan, second: &Plan) -> Vec<[usize; 2]> {
    let planned = |plan: &Plan| usize::try_from(plan.rows()).unwrap_or(usize::MAX).min(MOST_ROWS);
    let (mut row, mut other, mut shared) = (first_dispersed(first), first_dispersed(second), Vec::new());
    // samples ascend in both
    while row < planned(first) && other < planned(second) {
        let (a, b) = (first.sample(row as u64), second.sample(other as u64));
        if a == b {
            shared.push([row, other]);
        }
        row += usize::from(a <= b);
        other += usize::from(b <= a);
    }
    shared
}

/// The first row that is not that of the nominal sample.
fn first_dispersed(plan: &Plan) -> usize {
    usize::from(plan.dispersed_rows() < plan.rows())
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
    let differences: Vec<f64> = pairs
        .iter()
        .map(|[row, other]| (values[0][*row], values[1][*other]))
        .map(|(first, second)| if first == second { 0.0 } else { second - first })
        .filter(|difference| !difference.is_nan())
        .collect();
    let (mean, distribution_p_value) = if pairs.is_empty() {
        let ascending = |which: usize| {
            let dispersed = values[which].iter().skip(starts[which]).copied();
            let mut values: Vec<f64> = dispersed.filter(|value| !value.is_nan()).collect();
            values.sort_unstable_by(f64::total_cmp);
            values
        };
        let test = kolmogorov_smirnov(&ascending(0), &ascending(1));
        (welch(&moments[0], &moments[1], confidence), test.map(|(_, p)| p))
    } else {
        (paired(&Moments::of_block(&differences), confidence), signed_ranks(&differences))
    };
    ColumnComparison {
        quantity: statistics[0].quantity.clone(),
        scale,
        shifts,
        mean,
        distribution_p_value,
        differing_pairs: differences.iter().filter(|difference| **difference != 0.0).count() as u64,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dataset::small_plan::small_plan;

    /// Law: the rows of the same dispersed sample are compared, as many as both campaigns have; the nominal sample is not.
    #[test]
    fn rows_of_the_same_sample_are_paired() {
        let plan = |samples: u64| small_plan(samples, "");
        assert_eq!(shared_rows(&plan(7), &plan(4)), [[1, 1], [2, 2], [3, 3]]);
        assert_eq!(shared_rows(&plan(1), &plan(4)), Vec::<[usize; 2]>::new());
    }
}
