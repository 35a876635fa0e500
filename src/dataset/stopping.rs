//! [`stopping`]: whether a campaign with `[stop]` is precise enough at one of its looks.

use std::num::NonZeroUsize;

use crate::campaign::Plan;
use crate::dataset::observed::Observed;
use crate::dataset::rows_reader::{PartReader, RowsError, RowsReader};
use crate::run::Status;
use crate::statistics::looks::{Look, decision, looks};

/// The numbers of samples, sample 0 included, at which the campaign of `plan` is looked at; the last one ends it. Without `[stop]` it is one.
pub fn targets(plan: &Plan) -> Vec<u64> {
    match &plan.analysis.stop {
        Some(stop) => looks(plan.first_samples(), stop.max_samples),
        None => vec![plan.rows()],
    }
}

/// What a look at `samples` samples found.
#[derive(Clone, Debug, PartialEq)]
pub struct Stopping {
    /// Number of samples, the nominal one among them.
    pub samples: u64,
    /// Which look it is, from 1.
    pub look: usize,
    /// How many looks there may be.
    pub looks: usize,
    /// What it found.
    pub found: Look,
}

impl Stopping {
    /// Whether the campaign ends with this look.
    pub fn ends(&self) -> bool {
        self.found.stops || self.look == self.looks
    }
}

/// Looks at the rows of the campaign `plan`, which are those of the samples below one of its [`targets`]; `None` without `[stop]`. Memory is
/// that of one number for each run.
///
/// # Errors
/// Where a file cannot be read.
pub fn stopping(
    plan: &Plan,
    rows: &RowsReader,
    samples: u64,
    threads: Option<NonZeroUsize>,
) -> Result<Option<Stopping>, RowsError> {
    let Some(stop) = &plan.analysis.stop else { return Ok(None) };
    let targets = targets(plan);
    let Some(observed) = Observed::named(plan, std::iter::once(stop.observable.as_str())).pop() else {
        return Ok(None);
    };
    let mut all: Vec<f64> = Vec::new();
    let read = |part: &mut PartReader| -> Result<Vec<f64>, RowsError> {
        let (ids, statuses, values) = (part.samples()?, part.statuses()?, observed.values(part)?);
        let is_counted = |(sample, status): (u64, Status)| sample > 0 && sample < samples && status == Status::Done;
        let rows = ids.iter().map(|sample| sample.0).zip(statuses).zip(values);
        Ok(rows.filter(|(row, _)| is_counted(*row)).map(|(_, value)| value).collect())
    };
    rows.visit(threads, read, |values| {
        all.extend(values);
        Ok::<(), RowsError>(())
    })?;
    let look = targets.iter().position(|target| *target >= samples).map_or(targets.len(), |index| index + 1);
    Ok(Some(Stopping { samples, look, looks: targets.len(), found: decision(&all, stop.goal, targets.len()) }))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: a campaign ends with the look that finds it precise enough, or with the last one.
    #[test]
    fn the_last_look_ends_the_campaign() {
        let ends = |look: usize, stops: bool| {
            let found = Look { stops, estimate: Some(1.0), interval: [Some(0.9), Some(1.1)], confidence: 0.95 };
            Stopping { samples: 100, look, looks: 3, found }.ends()
        };
        assert_eq!([1, 2, 3].map(|look| ends(look, false)), [false, false, true]);
        assert_eq!([1, 2, 3].map(|look| ends(look, true)), [true, true, true]);
    }
}
