//! [`ending`]: how a campaign ended, from its rows alone: what its exit code and its list of verdicts follow from. It
//! reads a few columns.

use std::num::NonZeroUsize;
use std::path::PathBuf;

use crate::analysis::accumulator::of_files;
use crate::analysis::audit_tally::AuditTally;
use crate::analysis::stopping::{ObservedValues, Stopping, stopping};
use crate::analysis::tally::TallyColumns;
use crate::analysis::verdicts::{RequirementCounter, Verdicts, assess};
use crate::campaign::Requirement;
use crate::ensemble::Ensemble;
use crate::storage::bands_file;
use crate::storage::rows_reader::{RowsError, RowsReader};

#[derive(Clone, Debug, PartialEq)]
pub struct Ending {
    pub rows: u64,
    /// Number of runs that are not `ok`.
    pub failed: u64,
    /// Audited runs whose errors are larger than their estimates, where these are more than promised; else 0.
    pub not_covered: u64,
    /// Of the requirements, without the values of quantiles.
    pub verdicts: Verdicts,
    /// The last look, where it has `[stop]`.
    pub stopping: Option<Stopping>,
}

/// How the campaign `ensemble` ended, whose rows and the files of whose bands are given.
///
/// # Errors
/// Where a file cannot be read.
pub fn ending(
    ensemble: &Ensemble<'_>,
    (reader, bands): (&RowsReader, &[PathBuf]),
    threads: Option<NonZeroUsize>,
) -> Result<Ending, RowsError> {
    let plan = ensemble.plan();
    let fold =
        ((TallyColumns::new(ensemble), RequirementCounter::new(plan)), ObservedValues::of_stop(plan, plan.samples));
    let ((tally, counted), values) = of_files(&fold, reader, threads)?;
    let is_over_time = |one: &Requirement| one.band().is_some() && one.window().is_none();
    let bands = if plan.analysis.requirements.iter().any(is_over_time) {
        bands_file::read(reader.storage(), bands, threads)?
    } else {
        None
    };
    let verdicts = assess(plan, &tally.statuses, &counted, bands.as_ref());
    let stopping = stopping(plan, plan.samples, &values, &verdicts);
    Ok(Ending {
        rows: tally.statuses.runs(),
        failed: tally.statuses.runs() - tally.statuses.ok(),
        not_covered: tally.audits.as_ref().map_or(0, AuditTally::not_covered),
        verdicts,
        stopping,
    })
}
