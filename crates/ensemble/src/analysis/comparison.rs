//! [`Comparison`]: shifts of the observables of two results, and tests whether chance explains them.
//!
//! If both drew the same samples, about any nominal values, runs are compared in pairs (common random numbers), which
//! resolves differences much smaller than the spread. Statistics use all rows, tests the first
//! [`MOST_EXACT`](crate::analysis::column_counts::MOST_EXACT) samples.
//!
//! Independent samples: twice the smaller p-value of tests of means and distributions (Bonferroni). Pairs: a test of
//! the marginal distributions ([`marginals`]), since a mean of differences is normal only without rare large ones, as
//! wrapped quantities have; tests of the differences ([`signed_ranks`], [`spread_of_pairs`]) show whether runs moved
//! one way, or apart. [`fisher`], or [`mcnemar`] for pairs, tests the share of runs without a value. P-values are
//! adjusted for the number of observables (Holm): if nothing differs, any observable is called shifted, moved, or
//! changed in its share without a value with probability [`Comparison::level`] each.

use super::accumulator::of_files;
use super::observed::Observed;
use crate::analysis::pairing::{MOST_ROWS, ResultRows, first_dispersed, pairs};
use crate::analysis::statistic::{STATISTICS, Statistic};
use crate::analysis::statistics::{self, ColumnStatistics, Statistics};
use crate::analysis::statuses::StatusCounter;
use crate::campaign::Requirement;
use crate::ensemble::threads::Threads;
use crate::run::{Quantity, Status};
use crate::statistics::contingency::{Occurrence, fisher};
use crate::statistics::moments::Moments;
use crate::statistics::quantile::percent;
use crate::statistics::two_sample::{
    Difference, holm, kolmogorov_smirnov, marginals, mcnemar, paired, signed_ranks, spread_of_pairs, welch,
};
use crate::storage::rows_reader::Result;

/// Columns read at a time.
const AT_A_TIME: usize = 16;

#[derive(Clone, Debug, PartialEq)]
pub struct Shift {
    /// `mean`, `standard deviation`, `p95`.
    pub statistic: String,
    /// In the first result and in the second.
    pub first: f64,
    pub second: f64,
    /// Magnitude of the difference in units of [`ColumnComparison::scale`].
    pub relative: f64,
}

/// Runs without a value, or not computed, in both results.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Absence {
    /// Runs without, of all runs, in both results.
    pub of: [Occurrence; 2],
    /// Probability of at least this difference by chance.
    pub p_value: f64,
    pub adjusted_p_value: f64,
}

impl Absence {
    /// `lacks` tells whether a row is without.
    pub fn of(
        lacks: [&dyn Fn(usize) -> Option<bool>; 2],
        rows: [std::ops::Range<usize>; 2],
        pairs: &[[usize; 2]],
    ) -> Self {
        let counted = |which: usize| {
            let of: Vec<bool> = rows[which].clone().filter_map(lacks[which]).collect();
            Occurrence { events: of.iter().filter(|lacks| **lacks).count() as u64, runs: of.len() as u64 }
        };
        let of = [counted(0), counted(1)];
        let mut alone = [0; 2];
        for [row, other] in pairs {
            if let Some((first, second)) = lacks[0](*row).zip(lacks[1](*other)) {
                alone[0] += u64::from(first && !second);
                alone[1] += u64::from(second && !first);
            }
        }
        let p_value = if pairs.is_empty() { fisher(of[0], of[1]) } else { mcnemar(alone) };
        Absence { of, p_value, adjusted_p_value: 1.0 }
    }

    /// Shares of runs without, in both results.
    pub fn shares(&self) -> [f64; 2] {
        self.of.map(|of| of.events as f64 / of.runs.max(1) as f64)
    }
}

#[derive(Clone, Debug, Default, PartialEq)]
pub struct ColumnComparison {
    pub quantity: Quantity,
    /// Unit of shifts: the standard deviation in the first result, else the magnitude of its mean, else 1.
    pub scale: f64,
    /// Comparisons of the statistics that both results have.
    pub shifts: Vec<Shift>,
    /// Shift of the mean with its interval, of pairs or by Welch's test.
    pub mean: Option<Difference>,
    /// By [`marginals`] or the test of Kolmogorov and Smirnov.
    pub distribution_p_value: Option<f64>,
    /// P-value of symmetric differences; `None` without pairs, or if none differs.
    pub moved_p_value: Option<f64>,
    pub spread_p_value: Option<f64>,
    /// Twice the smaller of these two, adjusted for the number of observables.
    pub adjusted_moved_p_value: Option<f64>,
    /// Dispersed `ok` runs without a value.
    pub absence: Absence,
    pub differing_pairs: u64,
    /// True if a requirement of either plan is on the observable.
    pub is_required: bool,
    /// Decides whether the observable is shifted.
    pub p_value: Option<f64>,
    pub adjusted_p_value: Option<f64>,
}

impl ColumnComparison {
    pub fn largest(&self) -> Option<&Shift> {
        self.shifts.iter().max_by(|a, b| a.relative.total_cmp(&b.relative))
    }

    pub fn largest_relative(&self) -> f64 {
        self.largest().map_or(0.0, |shift| shift.relative)
    }

    /// True if a statistic, or the share of runs without a value, shifts by more than `tolerance`, or is NaN in only
    /// one result.
    pub fn is_beyond(&self, tolerance: f64) -> bool {
        let [first, second] = self.absence.shares();
        (second - first).abs() > tolerance || !self.shifts.iter().all(|shift| shift.relative <= tolerance)
    }

    /// The p-value of the differences of pairs, from their signs and spread.
    pub fn p_of_pairs(&self) -> Option<f64> {
        let (signs, spread) = self.moved_p_value.zip(self.spread_p_value)?;
        Some((2.0 * signs.min(spread)).min(1.0))
    }

    /// True if the spread of the pairs changed more clearly than their location.
    pub fn moves_apart(&self) -> bool {
        self.moved_p_value.zip(self.spread_p_value).is_some_and(|(signs, spread)| spread < signs)
    }
}

#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    pub statistics: [Statistics; 2],
    /// `ok` pairs of samples drawn alike; 0 for unpaired results.
    pub pairs: u64,
    /// Dispersed, physical runs that are not `ok`.
    pub failures: Absence,
    /// Observables of both results, required ones first, then by significance.
    pub columns: Vec<ColumnComparison>,
    /// Observables of only one result.
    pub alone: [Vec<String>; 2],
}

impl Comparison {
    pub fn shift_of_ok(&self) -> f64 {
        let [first, second] = self.statistics.each_ref().map(|of| of.ok() as f64 / of.samples().max(1) as f64);
        second - first
    }

    /// True if an observable, or the fraction of `ok` runs, shifts by more than `tolerance`.
    pub fn is_beyond(&self, tolerance: f64) -> bool {
        self.shift_of_ok().abs() > tolerance || self.columns.iter().any(|column| column.is_beyond(tolerance))
    }

    /// Probability of a false alarm: one minus the confidence of the intervals, at most a tenth.
    pub fn level(&self) -> f64 {
        (1.0 - self.statistics[0].confidence).min(MOST_LEVEL)
    }

    /// True if the shift of an observable exceeds chance.
    pub fn is_shifted(&self, column: &ColumnComparison) -> bool {
        column.largest_relative() > 0.0 && column.adjusted_p_value.is_some_and(|p| p <= self.level())
    }

    /// True if the runs of an observable moved or spread beyond chance, although the test of distributions does not
    /// show it.
    pub fn is_moved(&self, column: &ColumnComparison) -> bool {
        !self.is_shifted(column) && column.adjusted_moved_p_value.is_some_and(|p| p <= self.level())
    }

    /// True if two shares differ beyond chance.
    pub fn is_changed(&self, absence: &Absence) -> bool {
        absence.adjusted_p_value <= self.level()
    }
}

const MOST_LEVEL: f64 = 0.1;

pub fn compare(first: ResultRows<'_>, second: ResultRows<'_>, threads: Threads) -> Result<Comparison> {
    let of = |ResultRows { plan, reader, .. }: ResultRows<'_>| {
        let ended = of_files(&StatusCounter::new(plan), reader, threads)?;
        statistics::compute(plan, reader, &ended, (None, &[]), threads)
    };
    let statistics = [of(first)?, of(second)?];
    let ended = [first.statuses()?, second.statuses()?];
    let mut pairs = pairs(first, second, [&ended[0], &ended[1]])?;
    let starts = [first_dispersed(first.plan), first_dispersed(second.plan)];
    let rows = [starts[0]..ended[0].len(), starts[1]..ended[1].len()];
    let fails = |which: usize| {
        let ended = &ended[which];
        move |row: usize| Some(ended[row] != Status::Done).filter(|_| ended[row] != Status::InvalidSample)
    };
    let mut failures = Absence::of([&fails(0), &fails(1)], rows.clone(), &pairs);
    pairs.retain(|[row, other]| ended[0][*row] == Status::Done && ended[1][*other] == Status::Done);
    let confidence = first.plan.analysis.confidence;
    let (all, others) = (Observed::all(first.plan), Observed::all(second.plan));
    let other = |name: &str| others.iter().find(|observed| observed.name() == name);
    let shared: Vec<(&Observed, &Observed)> =
        all.iter().filter_map(|observed| Some((observed, other(observed.name())?))).collect();
    let mut columns = Vec::with_capacity(shared.len());
    for batch in shared.chunks(AT_A_TIME) {
        let of_first = values(first, batch.iter().map(|(observed, _)| *observed))?;
        let of_second = values(second, batch.iter().map(|(_, observed)| *observed))?;
        for (((observed, _), a), b) in batch.iter().zip(&of_first).zip(&of_second) {
            let name = observed.name();
            if let Some((of_a, of_b)) = statistics[0].column(name).zip(statistics[1].column(name)) {
                let of_ok = [0, 1].map(|which| {
                    let (ended, values) = (&ended[which], [a, b][which]);
                    move |row: usize| (ended[row] == Status::Done).then(|| values[row].is_nan())
                });
                let absence = Absence::of([&of_ok[0], &of_ok[1]], rows.clone(), &pairs);
                columns.push(compared([of_a, of_b], [a, b], &pairs, starts, absence, confidence));
            }
        }
    }
    let required: Vec<&str> = [first.plan, second.plan]
        .into_iter()
        .flat_map(|plan| plan.analysis.requirements.iter().filter_map(Requirement::observable))
        .collect();
    columns.iter_mut().for_each(|column| column.is_required = required.contains(&column.quantity.name()));
    adjust(&mut columns, &mut failures);
    let without = |list: &[Observed], other: &[Observed]| -> Vec<String> {
        let names = list.iter().map(Observed::name);
        names.filter(|name| other.iter().all(|one| one.name() != *name)).map(str::to_owned).collect()
    };
    let alone = [without(&all, &others), without(&others, &all)];
    Ok(Comparison { statistics, pairs: pairs.len() as u64, failures, columns, alone })
}

fn values<'o>(result: ResultRows<'_>, observed: impl Iterator<Item = &'o Observed> + Clone) -> Result<Vec<Vec<f64>>> {
    let mut columns = vec![Vec::new(); observed.clone().count()];
    for part in result.reader.first_parts(MOST_ROWS) {
        let part = part?;
        let statuses = part.statuses()?;
        for (column, observed) in columns.iter_mut().zip(observed.clone()) {
            let values = observed.column(&part)?.into_owned().into_iter().zip(&statuses);
            column.extend(values.map(|(value, status)| if *status == Status::Done { value } else { f64::NAN }));
        }
    }
    columns.iter_mut().for_each(|column: &mut Vec<f64>| column.truncate(MOST_ROWS));
    Ok(columns)
}

pub fn compared(
    statistics: [&ColumnStatistics; 2],
    values: [&[f64]; 2],
    pairs: &[[usize; 2]],
    starts: [usize; 2],
    absence: Absence,
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
    for Statistic { words, value, .. } in STATISTICS.iter().filter(|one| one.is_compared) {
        shift((*words).to_owned(), statistics.map(value));
    }
    for quantile in &statistics[0].quantiles {
        if let Some(other) = statistics[1].quantiles.iter().find(|other| other.p == quantile.p) {
            shift(format!("p{}", percent(quantile.p)), [quantile.value, other.value]);
        }
    }
    let mut found = ColumnComparison {
        quantity: statistics[0].quantity.clone(),
        scale,
        shifts,
        absence,
        ..ColumnComparison::default()
    };
    if pairs.is_empty() {
        let ascending = |which: usize| {
            let dispersed = values[which].iter().skip(starts[which]).copied();
            let mut values: Vec<f64> = dispersed.filter(|value| !value.is_nan()).collect();
            values.sort_unstable_by(f64::total_cmp);
            values
        };
        found.distribution_p_value = kolmogorov_smirnov(&ascending(0), &ascending(1)).map(|(_, p)| p);
        found.mean = welch(&moments[0], &moments[1], confidence);
        found.p_value = of_both(found.mean, found.distribution_p_value);
        return found;
    }
    let both = pairs.iter().map(|[row, other]| [values[0][*row], values[1][*other]]);
    let both: Vec<[f64; 2]> = both.filter(|pair| !pair.iter().any(|value| value.is_nan())).collect();
    // equal infinities do not differ
    let difference = |[first, second]: &[f64; 2]| if first == second { 0.0 } else { second - first };
    let differences: Vec<f64> = both.iter().map(difference).collect();
    let distribution = marginals(&both);
    ColumnComparison {
        mean: paired(&Moments::of_block(&differences), confidence),
        distribution_p_value: distribution,
        moved_p_value: signed_ranks(&differences),
        spread_p_value: spread_of_pairs(&both),
        p_value: distribution,
        differing_pairs: differences.iter().filter(|difference| **difference != 0.0).count() as u64,
        ..found
    }
}

/// The p-value of two tests of one hypothesis. A test of means without spread cannot judge a shift; the other one then
/// decides.
pub fn of_both(mean: Option<Difference>, distribution: Option<f64>) -> Option<f64> {
    let mean = mean.filter(|found| found.shift.value == 0.0 || found.shift.lower < found.shift.upper);
    match (mean.map(|found| found.p_value), distribution) {
        (Some(a), Some(b)) => Some((2.0 * a.min(b)).min(1.0)),
        (a, b) => a.or(b),
    }
}

/// Adjusts the p-values of `columns` by question and sorts: required ones, then by significance, then by the largest
/// shift.
pub fn adjust(columns: &mut [ColumnComparison], failures: &mut Absence) {
    let absences = || columns.iter().map(|column| column.absence.p_value).chain([failures.p_value]);
    let absences = holm(&absences().collect::<Vec<f64>>());
    columns.iter_mut().zip(&absences).for_each(|(column, p)| column.absence.adjusted_p_value = *p);
    failures.adjusted_p_value = absences[columns.len()];
    let of_all = |of: &dyn Fn(&ColumnComparison) -> Option<f64>| {
        holm(&columns.iter().filter_map(of).collect::<Vec<f64>>()).into_iter()
    };
    let (mut adjusted, mut moved) = (of_all(&|column| column.p_value), of_all(&ColumnComparison::p_of_pairs));
    for column in columns.iter_mut() {
        column.adjusted_p_value = column.p_value.and_then(|_| adjusted.next());
        column.adjusted_moved_p_value = column.p_of_pairs().and_then(|_| moved.next());
    }
    // underflowed p-values tie: the shift decides
    columns.sort_by(|a, b| {
        let p = |column: &ColumnComparison| column.p_value.unwrap_or(1.0);
        let by_p = p(a).total_cmp(&p(b)).then_with(|| b.largest_relative().total_cmp(&a.largest_relative()));
        b.is_required.cmp(&a.is_required).then(by_p)
    });
}
