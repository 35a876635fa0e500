//! `spindrift check`: previews a campaign.

use crate::cli::arguments::CheckOptions;
use crate::cli::command_outcome::{CommandOutcome, Failure};
use crate::cli::screen;
use crate::ensemble::Ensemble;
use crate::findings::checked::findings;
use crate::report::screen::{question, sections};
use crate::workflow::check::probed;
use crate::workflow::isa;
use crate::workflow::source::plan_and_files;

pub fn run(options: &CheckOptions) -> Result<CommandOutcome, Failure> {
    let (plan, _) = plan_and_files(&options.file, options.changed.overrides())?;
    let ensemble = Ensemble::new(&plan, isa()?);
    let found = probed(&ensemble)?;
    let said = sections(&findings(&found, options.verbose), screen::width());
    screen::print(&(question(plan.description.as_deref(), screen::width()) + &said))?;
    if options.plan {
        screen::print(&format!("\n== Plan (hash {})\n{}", plan.hash(), plan.text()))?;
    }
    let failed = found.runs.failed() as u64;
    Ok(if found.runs.is_hopeless() { CommandOutcome::SomeFailed(failed) } else { CommandOutcome::Done })
}
