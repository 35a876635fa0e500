//! [`Analysed`]: statistics, sensitivities and verdicts, a function of plan and files.

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
use crate::ensemble::threads::Threads;
use crate::storage::rows_reader::{Result, RowsReader};

#[derive(Clone, Debug)]
pub struct Analysed {
    pub statistics: Statistics,
    pub verdicts: Verdicts,
    pub sensitivities: Vec<InputSensitivity>,
    /// Quantiles over time.
    pub bands: Option<Bands>,
    pub stopping: Option<Stopping>,
    pub survey: Survey,
    /// Ends of missions under a control loop.
    pub missions: Missions,
    pub tally: Tally,
    /// Drivers of whether a run is computed, if many are not.
    pub failures: Vec<InputSensitivity>,
}

impl Analysed {
    pub fn ending(&self) -> Ending {
        Ending::new(&self.tally, self.verdicts.clone(), self.stopping.clone())
    }
}

pub fn computed(plan: &Plan, reader: &RowsReader, gathered: Gathered, threads: Threads) -> Result<Analysed> {
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
