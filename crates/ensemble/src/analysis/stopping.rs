//! [`stopping`]: the looks of a campaign with `[stop]`.

use super::accumulator::{Accumulator, of_files};
use super::observed::Observed;
use super::part_columns::PartColumns;
use crate::analysis::statuses::StatusCounter;
use crate::analysis::verdicts::{RequirementCounter, Verdicts, assess};
use crate::campaign::Plan;
use crate::campaign::stop::{Stop, When};
use crate::ensemble::threads::Threads;
use crate::run::Status;
use crate::statistics::looks::{Goal, Look, decision};
use crate::storage::bands_file;
use crate::storage::rows_reader::{Result, RowsReader};

#[derive(Clone, Debug, PartialEq)]
pub struct Stopping {
    /// Including the nominal one.
    pub samples: u64,
    /// From 1.
    pub look: usize,
    pub looks: usize,
    pub found: LookFound,
}

#[derive(Clone, Debug, PartialEq)]
pub enum LookFound {
    Precision(Look),
    Undecided(usize),
}

impl Stopping {
    pub fn is_reached(&self) -> bool {
        match &self.found {
            LookFound::Precision(look) => look.stops,
            LookFound::Undecided(count) => *count == 0,
        }
    }

    pub fn ends(&self) -> bool {
        self.is_reached() || self.look == self.looks
    }
}

/// One observable in the dispersed `ok` runs, in sample order, and the number of lost runs.
#[derive(Clone, Debug, Default)]
pub struct StopValues {
    pub values: Vec<f64>,
    pub lost: usize,
}

#[derive(Clone, Debug)]
pub struct ObservedValues {
    observed: Vec<Observed>,
    samples: u64,
}

impl ObservedValues {
    /// The observable of `[stop]`, if any, in the first `samples` samples.
    pub fn of_stop(plan: &Plan, samples: u64) -> Self {
        let name = plan.analysis.stop.as_ref().and_then(|stop| match &stop.when {
            When::Precise { observable, .. } => Some(observable.as_str()),
            When::Decided => None,
        });
        ObservedValues { observed: Observed::named(plan, name.into_iter()), samples }
    }
}

impl Accumulator for ObservedValues {
    type Whole = StopValues;
    type OfPart = StopValues;

    fn nothing(&self) -> StopValues {
        StopValues::default()
    }

    fn count(&self, part: &impl PartColumns) -> Result<StopValues> {
        let mut found = StopValues::default();
        for observed in &self.observed {
            let (samples, statuses, values) = (part.samples()?, part.statuses()?, observed.column(part)?);
            let is_within = |row: &usize| samples[*row].0 > 0 && samples[*row].0 < self.samples;
            for row in (0..samples.len()).filter(is_within) {
                match statuses[row] {
                    Status::Done => found.values.push(values[row]),
                    Status::InvalidSample => {}
                    _ => found.lost += 1,
                }
            }
        }
        Ok(found)
    }

    fn merge(&self, whole: &mut StopValues, part: StopValues) {
        whole.values.extend(part.values);
        whole.lost += part.lost;
    }
}

/// Looks at the rows and bands of the samples below one of [`Plan::looks`]. `None` without `[stop]`.
pub fn look(plan: &Plan, rows: &RowsReader, samples: u64, threads: Threads) -> Result<Option<Stopping>> {
    match &plan.analysis.stop {
        None => Ok(None),
        Some(Stop { when: When::Precise { .. }, .. }) => {
            let values = of_files(&ObservedValues::of_stop(plan, samples), rows, threads)?;
            Ok(stopping(plan, samples, &values, &Verdicts::default()))
        }
        Some(Stop { when: When::Decided, .. }) => {
            let bands = bands_file::read(rows.store(), rows.bands(), threads)?;
            let (ended, counted) = of_files(&(StatusCounter::new(plan), RequirementCounter::new(plan)), rows, threads)?;
            Ok(stopping(plan, samples, &StopValues::default(), &assess(plan, &ended, &counted, bands.as_ref())))
        }
    }
}

/// A look at `samples` samples, from `values` or `verdicts`. `None` without `[stop]`.
pub fn stopping(plan: &Plan, samples: u64, values: &StopValues, verdicts: &Verdicts) -> Option<Stopping> {
    let (stop, looks) = (plan.analysis.stop.as_ref()?, plan.looks());
    let found = match &stop.when {
        When::Precise { goal, .. } => LookFound::Precision(precision(values, *goal, looks.len())),
        When::Decided => LookFound::Undecided(verdicts.undecided()),
    };
    let look = looks.iter().position(|target| *target >= samples).map_or(looks.len(), |index| index + 1);
    Some(Stopping { samples, look, looks: looks.len(), found })
}

/// The interval holds wherever the lost runs are.
fn precision(StopValues { values, lost }: &StopValues, goal: Goal, looks: usize) -> Look {
    let found = decision(values, goal, looks);
    if *lost == 0 {
        return found;
    }
    let with_lost = |at: f64| decision(&[&values[..], &vec![at; *lost]].concat(), goal, looks).interval;
    let ends = [with_lost(f64::NEG_INFINITY)[0], with_lost(f64::INFINITY)[1]];
    let interval = ends.map(|end| end.filter(|end| end.is_finite()));
    let width = interval[1].zip(interval[0]).map(|(high, low)| high - low);
    Look { interval, stops: width.is_some_and(|width| 0.5 * width <= goal.half_width), ..found }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: lost runs widen the interval to both sides and never stop a campaign; if they may contain the quantile, it
    /// has no bound.
    #[test]
    fn lost_runs_do_not_stop_a_campaign() {
        let values: Vec<f64> = (0..1000).map(|k| f64::from((k * 617) % 1000)).collect();
        let goal = Goal { quantile: 0.95, half_width: 18.0, confidence: 0.95 };
        let of = |lost: usize| precision(&StopValues { values: values.clone(), lost }, goal, 1);
        assert_eq!(of(0), decision(&values, goal, 1));
        assert!(of(0).stops);
        let widths =
            [0, 2, 10].map(|lost| of(lost).interval[1].zip(of(lost).interval[0]).map(|(high, low)| high - low));
        assert!(widths.is_sorted() && widths[2].is_some() && !of(10).stops, "{widths:?}");
        assert_eq!((of(60).interval[1], of(60).stops), (None, false));
    }
}
