//! `spindrift sample`: draws the dispersed parameters without runs.

use crate::campaign::{Plan, draw};
use crate::cli::arguments::SampleOptions;
use crate::cli::command_outcome::{CommandOutcome, Failure};
use crate::cli::screen;
use crate::findings::dispersions;
use crate::report::screen::paragraphs;
use crate::sampling::SampleId;
use crate::table::text::Text;
use crate::workflow::outputs::{check_formats, refuse_inputs};
use crate::workflow::sampling::drawn;
use crate::workflow::source::plan_and_files;

pub fn run(options: &SampleOptions) -> Result<CommandOutcome, Failure> {
    let (table, plot) = (options.out.as_deref(), options.plot.as_deref());
    check_formats(table, plot)?;
    let (plan, files) = plan_and_files(&options.file, options.drawn.overrides(&options.changed))?;
    refuse_inputs(&files.paths(), &[("--out", table), ("--plot", plot)])?;
    if let Some(sample) = options.sample {
        return one(&plan, sample);
    }
    let (percentiles, notes) = drawn(&plan, [table, plot], options.drawn.yes)?;
    screen::print(&paragraphs(&dispersions::of_percentiles(&plan, &percentiles), screen::width()))?;
    notes.iter().for_each(|note| screen::note(note));
    Ok(CommandOutcome::Done)
}

fn one(plan: &Plan, sample: u64) -> Result<CommandOutcome, Failure> {
    if sample >= plan.samples {
        let (last, name) = (plan.samples - 1, &plan.name);
        return Err(Failure::Input(format!("--sample {sample}: must be 0 to {last}, the samples of {name}")));
    }
    let applied = dispersions::applied(plan, SampleId(sample), true);
    screen::print(&Text::of(&applied).spaced(0, 2).lines(usize::MAX))?;
    if let Err(errors) = draw(plan, SampleId(sample)) {
        let reasons: String = errors.iter().map(|error| format!("\n  {error}")).collect();
        screen::note(&format!("sample {sample} is not physical (its status would be invalid_sample):{reasons}"));
    }
    Ok(CommandOutcome::Done)
}
