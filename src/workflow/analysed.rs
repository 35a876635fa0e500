//! What is made of the rows of a campaign once they are on the disk: statistics, sensitivities, verdicts. It depends on
//! plan and files only.

use std::num::NonZeroUsize;
use std::path::Path;

use crate::analysis::audit_tally::AuditTally;
use crate::analysis::ending::Ending;
use crate::analysis::fold::Gathered;
use crate::analysis::input_sensitivity::InputSensitivity;
use crate::analysis::missions::Missions;
use crate::analysis::statistics::Statistics;
use crate::analysis::stopping::{Stopping, stopping};
use crate::analysis::survey::Survey;
use crate::analysis::tally::Tally;
use crate::analysis::verdicts::Verdicts;
use crate::analysis::{sensitivity, statistics, verdicts};
use crate::campaign::Plan;
use crate::ensemble::Bands;
use crate::report::audit_summary::AuditSummary;
use crate::report::summary::SummaryEnd;
use crate::report::warnings::warnings;
use crate::report::{drivers_text, filter_text, requirements, stopping_text};
use crate::storage::atomic;
use crate::storage::rows_reader::RowsReader;
use crate::workflow::error::WorkflowError;

#[derive(Clone, Debug)]
pub struct Analysed {
    pub statistics: Statistics,
    pub verdicts: Verdicts,
    /// Of what drives the main observables.
    pub sensitivities: Vec<InputSensitivity>,
    /// Over time, where the campaign has bands.
    pub bands: Option<Bands>,
    /// Whether the campaign has enough samples, where it has `[stop]`.
    pub stopping: Option<Stopping>,
    /// What the page shows of the rows.
    pub survey: Survey,
    /// How missions ended, under a control loop.
    pub missions: Missions,
    /// How runs ended, and the audits.
    pub tally: Tally,
    /// What a reader has to know before any number.
    pub warnings: Vec<String>,
    /// What the numbers leave unsaid: filters that do not know their errors, and that no driver was tested.
    pub notes: Vec<String>,
}

impl Analysed {
    pub fn end(&self) -> SummaryEnd {
        let ending = Ending {
            rows: self.tally.statuses.runs(),
            failed: self.tally.statuses.runs() - self.tally.statuses.ok(),
            not_covered: self.tally.audits.as_ref().map_or(0, AuditTally::not_covered),
            verdicts: self.verdicts.clone(),
            stopping: self.stopping.clone(),
        };
        SummaryEnd { warnings: self.warnings.clone(), ..SummaryEnd::of(&ending) }
    }
}

/// What was `gathered` from the rows of `plan` says.
///
/// # Errors
/// Where a file cannot be read.
pub fn computed(
    plan: &Plan,
    reader: &RowsReader,
    gathered: Gathered,
    threads: Option<NonZeroUsize>,
) -> Result<Analysed, WorkflowError> {
    let ended = &gathered.tally.statuses;
    let statistics =
        statistics::compute(plan, reader, ended, Some(gathered.columns), threads).map_err(WorkflowError::files)?;
    let verdicts = verdicts::assess(plan, ended, &gathered.requirements, gathered.bands.as_ref());
    let verdicts = verdicts.with_quantiles(&statistics);
    let audit = gathered.tally.audits.as_ref().map(|audits| AuditSummary::new(audits, plan.audit_fraction));
    let failures = match statistics.loss().is_big() {
        true => sensitivity::of_failures(plan, &gathered.first_rows, threads),
        false => Vec::new(),
    };
    let sensitivities = sensitivity::compute(plan, &gathered.first_rows, statistics.loss(), threads);
    let refused = drivers_text::refused(plan, &sensitivities);
    Ok(Analysed {
        notes: filter_text::overconfident(&statistics).into_iter().chain(refused).collect(),
        sensitivities,
        warnings: warnings(plan, &statistics, audit.as_ref(), &failures, gathered.tally.beyond_air),
        stopping: stopping(plan, plan.samples, &gathered.stop_values, &verdicts),
        verdicts,
        statistics,
        bands: gathered.bands,
        survey: gathered.survey,
        missions: gathered.missions,
        tally: gathered.tally,
    })
}

/// Writes the verdicts as JUnit XML, where a file for it was named.
///
/// # Errors
/// Where the file cannot be written.
pub fn write_junit(plan: &Plan, analysed: &Analysed, file: Option<&Path>) -> Result<(), WorkflowError> {
    let Some(file) = file else { return Ok(()) };
    let stop = analysed.stopping.as_ref().map(|found| (found.is_reached(), stopping_text::text(plan, found)));
    let text = requirements::junit(plan, &analysed.verdicts, &analysed.tally, stop);
    atomic::write_bytes(file, text.as_bytes()).map_err(|error| in_file(file, &error))
}

fn in_file(path: &Path, error: &dyn std::fmt::Display) -> WorkflowError {
    WorkflowError::files(format!("{}: {error}", path.display()))
}
