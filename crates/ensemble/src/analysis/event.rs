//! [`Event`]: a property of some runs to be explained: a missed requirement, a rare value, the tail.

use crate::analysis::outcomes::is_worst_when_low;
use crate::campaign::{Plan, Requirement, Statement};
use crate::statistics::contingency::Occurrence;
use crate::statistics::correlation::ascending_order;

/// Maximum number of values treated as groups.
pub const FEW: usize = 5;
const ROWS_OF_EACH: usize = 4;
/// Fewer events cannot show an influence of an input with many values ([`crate::statistics::rank_tests`]): the tail is
/// explained instead.
const FEWEST: usize = 4;
/// Minimum rows with a tail, and in it.
const ROWS_OF_TAIL: [usize; 2] = [100, 5];
/// The worst twentieth, unless a requirement sets the share.
const TAIL: f64 = 0.05;

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Occurs {
    /// Runs that miss a requirement, by its index in the plan; `is_only`: all others on the outcome are missed by the
    /// same runs.
    Missed { requirement: usize, is_only: bool },
    /// An outcome of few values differs from the most frequent one.
    OtherThan(f64),
    /// An outcome of two values has the less frequent one.
    Value(f64),
    /// The outcome is in this share of the worst.
    Worst(f64),
}

impl Occurs {
    pub const fn name(self) -> &'static str {
        match self {
            Occurs::Missed { .. } => "missed",
            Occurs::OtherThan(_) => "other_value",
            Occurs::Value(_) => "value",
            Occurs::Worst(_) => "worst",
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Event {
    pub occurs: Occurs,
    pub of: Occurrence,
    /// True if the outcome has few values, so that the event is its spread.
    pub has_few_values: bool,
}

/// Ascending values with their counts, without NaN.
pub fn distinct(values: &[f64], order: &[usize]) -> Vec<(f64, usize)> {
    let mut found: Vec<(f64, usize)> = Vec::new();
    for value in order.iter().map(|row| values[*row]).filter(|value| !value.is_nan()) {
        match found.last_mut() {
            Some((last, count)) if *last == value => *count += 1,
            _ => found.push((value, 1)),
        }
    }
    found
}

pub fn are_few(distinct: usize, rows: usize) -> bool {
    (2..=FEW).contains(&distinct) && rows >= ROWS_OF_EACH * distinct
}

fn has_few(known: &[(f64, usize)], rows: usize) -> bool {
    are_few(known.len(), rows) || known.len() == 1
}

impl Event {
    /// Missed requirements on the outcome `name`, counted as in verdicts (runs that are not `is_ok` miss all), and the
    /// rows of each.
    pub fn missed(plan: &Plan, name: &str, values: &[f64], is_ok: &[bool]) -> Vec<(Event, Vec<bool>)> {
        let has_few_values = has_few(&distinct(values, &ascending_order(values)), values.len());
        let of_runs =
            |(_, one): &(usize, &Requirement)| one.observable() == Some(name) && one.statement != Statement::Mean;
        let mut missed: Vec<(usize, Vec<bool>)> = Vec::new();
        for (requirement, one) in plan.analysis.requirements.iter().enumerate().filter(of_runs) {
            let marked: Vec<bool> = values.iter().zip(is_ok).map(|(y, is_ok)| !(*is_ok && one.is_met(*y))).collect();
            if !missed.iter().any(|(_, other)| *other == marked) {
                missed.push((requirement, marked));
            }
        }
        let is_only = missed.len() == 1;
        let least = if has_few_values { 1 } else { FEWEST as u64 };
        let events = missed.into_iter().map(|(requirement, marked)| {
            Self::occurring(Occurs::Missed { requirement, is_only }, marked, has_few_values)
        });
        let is_asked = |found: &(Event, Vec<bool>)| {
            let Occurrence { events, runs } = found.0.of;
            events >= least && runs - events >= least
        };
        events.filter(is_asked).collect()
    }

    fn occurring(occurs: Occurs, marked: Vec<bool>, has_few_values: bool) -> (Event, Vec<bool>) {
        let events = marked.iter().filter(|is_marked| **is_marked).count() as u64;
        (Event { occurs, of: Occurrence { events, runs: marked.len() as u64 }, has_few_values }, marked)
    }

    /// As [`Event::missed`], for an outcome whose limits nearly all runs meet.
    pub fn of_values(plan: &Plan, name: &str, values: &[f64]) -> Vec<(Event, Vec<bool>)> {
        let known = distinct(values, &ascending_order(values));
        let has_few_values = has_few(&known, values.len());
        let requirements = || plan.analysis.requirements_on(name);
        let event = |occurs: Occurs, marked: Vec<bool>| Self::occurring(occurs, marked, has_few_values);
        if has_few_values {
            let frequent = known.iter().max_by_key(|(_, count)| *count).map_or(f64::NAN, |(value, _)| *value);
            let Some((other, _)) = known.iter().copied().find(|(value, _)| *value != frequent) else {
                return Vec::new();
            };
            let occurs = if known.len() == 2 { Occurs::Value(other) } else { Occurs::OtherThan(frequent) };
            return vec![event(occurs, values.iter().map(|value| *value != frequent && !value.is_nan()).collect())];
        }
        let share = requirements().find_map(|one| Some(1.0 - one.share()?));
        let share = share.filter(|share| *share <= 0.25).unwrap_or(TAIL);
        let is_low = is_worst_when_low(plan, name);
        let badness = |value: &f64| if is_low { -value } else { value.abs() };
        let mut sizes: Vec<f64> = values.iter().map(badness).filter(|size| !size.is_nan()).collect();
        if sizes.len() < ROWS_OF_TAIL[0] {
            return Vec::new();
        }
        sizes.sort_by(|a, b| b.total_cmp(a));
        let count = (libm::round(share * sizes.len() as f64) as usize).max(ROWS_OF_TAIL[1]);
        let found =
            event(Occurs::Worst(share), values.iter().map(|value| badness(value) >= sizes[count - 1]).collect());
        // many ties leave no tail
        if found.0.of.events <= 2 * count as u64 { vec![found] } else { Vec::new() }
    }
}
