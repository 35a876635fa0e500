//! [`Analysed`]: what is made of the rows of a campaign once they are on the disk: statistics, sensitivities, verdicts.
//! It depends on plan and files only.

use std::num::NonZeroUsize;

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
use crate::storage::rows_reader::{RowsError, RowsReader};

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
    /// What drives whether a run is computed, where many are not.
    pub failures: Vec<InputSensitivity>,
}

impl Analysed {
    /// How the campaign ended.
    pub fn ending(&self) -> Ending {
        Ending {
            rows: self.tally.statuses.runs(),
            failed: self.tally.statuses.runs() - self.tally.statuses.ok(),
            not_covered: self.tally.audits.as_ref().map_or(0, AuditTally::not_covered),
            verdicts: self.verdicts.clone(),
            stopping: self.stopping.clone(),
        }
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
) -> Result<Analysed, RowsError> {
    let ended = &gathered.tally.statuses;
    let mut survey = gathered.survey;
    let shown: Vec<String> = survey.outcomes.iter().map(|one| one.quantity.name().to_owned()).collect();
    let counted = (Some(gathered.columns), &shown[..]);
    let mut statistics = statistics::compute(plan, reader, ended, counted, threads)?;
    survey.describe(plan, &mut statistics, &gathered.first_rows);
    let verdicts = verdicts::assess(plan, ended, &gathered.requirements, gathered.bands.as_ref());
    let verdicts = verdicts.with_quantiles(&statistics);
    let failures = match statistics.loss().is_big() {
        true => sensitivity::of_failures(plan, &gathered.first_rows, threads),
        false => Vec::new(),
    };
    Ok(Analysed {
        failures,
        sensitivities: sensitivity::compute(plan, &gathered.first_rows, statistics.loss(), threads),
        stopping: stopping(plan, plan.samples, &gathered.stop_values, &verdicts),
        verdicts,
        statistics,
        bands: gathered.bands,
        survey,
        missions: gathered.missions,
        tally: gathered.tally,
    })
}
