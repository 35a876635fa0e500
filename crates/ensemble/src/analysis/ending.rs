//! [`ending`]: the exit code and verdicts of a campaign from a few columns of its rows.

use super::accumulator::of_files;
use crate::analysis::audit_tally::AuditTally;
use crate::analysis::stopping::{ObservedValues, Stopping, stopping};
use crate::analysis::tally::{Tally, TallyColumns};
use crate::analysis::verdicts::{RequirementCounter, Verdicts, assess};
use crate::campaign::Requirement;
use crate::ensemble::Ensemble;
use crate::ensemble::threads::Threads;
use crate::storage::bands_file;
use crate::storage::rows_reader::{Result, RowsReader};

#[derive(Clone, Debug, PartialEq)]
pub struct Ending {
    pub rows: u64,
    pub failed: u64,
    /// Uncovered audits of estimates with a broken promise.
    pub not_covered: u64,
    /// Without the values of quantiles.
    pub verdicts: Verdicts,
    pub stopping: Option<Stopping>,
}

impl Ending {
    pub fn new(tally: &Tally, verdicts: Verdicts, stopping: Option<Stopping>) -> Self {
        let rows = tally.statuses.runs();
        let not_covered = tally.audits.as_ref().map_or(0, AuditTally::not_covered);
        Ending { rows, failed: rows - tally.statuses.ok(), not_covered, verdicts, stopping }
    }
}

pub fn ending(ensemble: &Ensemble<'_>, reader: &RowsReader, threads: Threads) -> Result<Ending> {
    let plan = ensemble.plan();
    let fold =
        ((TallyColumns::new(ensemble), RequirementCounter::new(plan)), ObservedValues::of_stop(plan, plan.samples));
    let ((tally, counted), values) = of_files(&fold, reader, threads)?;
    let is_over_time = |one: &Requirement| one.band().is_some() && one.window().is_none();
    let bands = if plan.analysis.requirements.iter().any(is_over_time) {
        bands_file::read(reader.store(), reader.bands(), threads)?
    } else {
        None
    };
    let verdicts = assess(plan, &tally.statuses, &counted, bands.as_ref());
    let stopping = stopping(plan, plan.samples, &values, &verdicts);
    Ok(Ending::new(&tally, verdicts, stopping))
}
