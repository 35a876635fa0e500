//! [`stopping`]: whether a campaign with `[stop]` has enough samples at one of its looks.

use std::num::NonZeroUsize;
use std::path::PathBuf;

use crate::analysis::observed::Observed;
use crate::analysis::verdicts::{Verdicts, assess};
use crate::campaign::Plan;
use crate::campaign::stop::When;
use crate::run::Status;
use crate::statistics::looks::{Goal, Look, decision};
use crate::storage::bands_file::{self, BandsError};
use crate::storage::rows_reader::{PartReader, RowsError, RowsReader};

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
    pub found: Found,
}

/// What a look found.
#[derive(Clone, Debug, PartialEq)]
pub enum Found {
    /// Of a quantile.
    Precision(Look),
    /// Of requirements: how many are undecided.
    Undecided(usize),
}

/// A look that cannot be taken.
#[derive(Debug, thiserror::Error)]
pub enum LookError {
    /// Rows cannot be read.
    #[error(transparent)]
    Rows(#[from] RowsError),
    /// Bands cannot be read.
    #[error(transparent)]
    Bands(#[from] BandsError),
}

impl Stopping {
    /// Whether the campaign has what it stops for.
    pub fn is_reached(&self) -> bool {
        match &self.found {
            Found::Precision(look) => look.stops,
            Found::Undecided(count) => *count == 0,
        }
    }

    /// Whether the campaign ends with this look.
    pub fn ends(&self) -> bool {
        self.is_reached() || self.look == self.looks
    }
}

/// Looks at the rows of the campaign `plan`, which are those of the samples below one of its [`Plan::looks`], and the files of their bands; the
/// `verdicts` on its requirements are made where they are not given. `None` without `[stop]`. Memory is that of one number for each run at most.
///
/// # Errors
/// Where a file cannot be read.
pub fn stopping(
    plan: &Plan,
    (rows, bands): (&RowsReader, &[PathBuf]),
    samples: u64,
    threads: Option<NonZeroUsize>,
    verdicts: Option<&Verdicts>,
) -> Result<Option<Stopping>, LookError> {
    let Some(stop) = &plan.analysis.stop else { return Ok(None) };
    let looks = plan.looks();
    let found = match (&stop.when, verdicts) {
        (When::Precise { observable, goal }, _) => {
            Found::Precision(precision(plan, rows, (observable, *goal), samples, threads)?)
        }
        (When::Decided, Some(verdicts)) => Found::Undecided(verdicts.undecided()),
        (When::Decided, None) => {
            let bands = bands_file::read(rows.storage(), bands, threads)?;
            Found::Undecided(assess(plan, rows, bands.as_ref(), threads)?.undecided())
        }
    };
    let look = looks.iter().position(|target| *target >= samples).map_or(looks.len(), |index| index + 1);
    Ok(Some(Stopping { samples, look, looks: looks.len(), found }))
}

/// What the dispersed runs of the first `samples` samples say of the `goal` of `observable`.
fn precision(
    plan: &Plan,
    rows: &RowsReader,
    (observable, goal): (&str, Goal),
    samples: u64,
    threads: Option<NonZeroUsize>,
) -> Result<Look, RowsError> {
    let observed = Observed::named(plan, std::iter::once(observable));
    let mut all: Vec<f64> = Vec::new();
    let read = |part: &mut PartReader| -> Result<Vec<f64>, RowsError> {
        let (ids, statuses) = (part.samples()?, part.statuses()?);
        let is_counted = |(sample, status): (u64, Status)| sample > 0 && sample < samples && status == Status::Done;
        let rows = || ids.iter().map(|sample| sample.0).zip(statuses.iter().copied());
        let values = observed.iter().map(|one| one.values(part)).collect::<Result<Vec<_>, _>>()?;
        let values = values.into_iter().flat_map(|values| rows().zip(values));
        Ok(values.filter(|(row, _)| is_counted(*row)).map(|(_, value)| value).collect())
    };
    rows.visit(threads, read, |values| {
        all.extend(values);
        Ok::<(), RowsError>(())
    })?;
    Ok(decision(&all, goal, plan.looks().len()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: a campaign ends with the look that finds what it stops for, or with the last one.
    #[test]
    fn the_last_look_ends_the_campaign() {
        let precision = |stops: bool| {
            Found::Precision(Look { stops, estimate: Some(1.0), interval: [Some(0.9), Some(1.1)], confidence: 0.95 })
        };
        for found in [precision, |decided: bool| Found::Undecided(usize::from(!decided))] {
            let ends = |look: usize, stops: bool| Stopping { samples: 100, look, looks: 3, found: found(stops) }.ends();
            assert_eq!([1, 2, 3].map(|look| ends(look, false)), [false, false, true]);
            assert_eq!([1, 2, 3].map(|look| ends(look, true)), [true, true, true]);
        }
    }
}
