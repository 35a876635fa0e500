//! [`ending`]: how a campaign ended, from its rows alone: what its exit code and its list of verdicts follow from. It reads a few columns.

use std::num::NonZeroUsize;
use std::path::PathBuf;

use crate::analysis::accumulator::{Accumulator, of_files};
use crate::analysis::part_columns::PartColumns;
use crate::analysis::stopping::{ObservedValues, Stopping, stopping};
use crate::analysis::verdicts::{RequirementCounter, Verdicts, assess};
use crate::campaign::{Plan, Requirement};
use crate::run::Status;
use crate::storage::bands_file;
use crate::storage::rows_reader::{RowsError, RowsReader};

/// How a campaign ended.
#[derive(Clone, Debug, PartialEq)]
pub struct Ending {
    /// Number of rows.
    pub rows: u64,
    /// Number of runs that are not `ok`.
    pub failed: u64,
    /// Of the requirements, without the values of quantiles.
    pub verdicts: Verdicts,
    /// The last look, where it has `[stop]`.
    pub stopping: Option<Stopping>,
}

/// Counts rows, and those of them that are not `ok`.
struct RunCounter;

impl Accumulator for RunCounter {
    type Whole = [u64; 2];
    type OfPart = [u64; 2];

    fn nothing(&self) -> [u64; 2] {
        [0; 2]
    }

    fn count(&self, part: &impl PartColumns) -> Result<[u64; 2], RowsError> {
        let statuses = part.statuses()?;
        let failed = statuses.iter().filter(|status| **status != Status::Done).count();
        Ok([statuses.len() as u64, failed as u64])
    }

    fn merge(&self, whole: &mut [u64; 2], part: [u64; 2]) {
        whole.iter_mut().zip(part).for_each(|(sum, count)| *sum += count);
    }
}

/// How the campaign `plan` ended, whose rows and the files of whose bands are given.
///
/// # Errors
/// Where a file cannot be read.
pub fn ending(
    plan: &Plan,
    (reader, bands): (&RowsReader, &[PathBuf]),
    threads: Option<NonZeroUsize>,
) -> Result<Ending, RowsError> {
    let fold = ((RunCounter, RequirementCounter::new(plan)), ObservedValues::of_stop(plan, plan.samples));
    let (([rows, failed], counted), values) = of_files(&fold, reader, threads)?;
    let is_over_time = |one: &Requirement| one.band().is_some() && one.window().is_none();
    let bands = if plan.analysis.requirements.iter().any(is_over_time) {
        bands_file::read(reader.storage(), bands, threads)?
    } else {
        None
    };
    let verdicts = assess(plan, &counted, bands.as_ref());
    let stopping = stopping(plan, plan.samples, &values, &verdicts);
    Ok(Ending { rows, failed, verdicts, stopping })
}
