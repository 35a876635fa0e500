//! `spindrift sample`: the dispersed parameters of a campaign, without runs.

use std::path::Path;

use crate::campaign::{Overrides, Plan, draw};
use crate::cli::arguments::SampleOptions;
use crate::cli::command_outcome::{CommandOutcome, Failure};
use crate::cli::outputs::refuse_inputs;
use crate::cli::screen;
use crate::ensemble::{DrawnScenes, Percentiles};
use crate::findings::dispersions;
use crate::findings::number::counted;
use crate::report::figure_files::{FigureSheet, check_format, instead};
use crate::report::inputs::DrawnInputs;
use crate::report::screen::paragraphs;
use crate::sampling::SampleId;
use crate::storage::drawn_table;
use crate::storage::table_file::TableFormat;
use crate::table::text::Text;
use crate::workflow::source::plan_and_files;
use crate::workflow::workload::{Workload, plotted_samples};

pub fn run(options: &SampleOptions) -> Result<CommandOutcome, Failure> {
    // refuse a file that cannot be written before any work
    if let Some(path) = &options.out {
        TableFormat::of(path).map_err(|error| Failure::Input(error.to_string()))?;
    }
    if let Some(path) = &options.plot {
        check_format(path).map_err(|error| Failure::Input(error.to_string()))?;
    }
    let overrides = Overrides { samples: options.samples, seed: options.seed, ..options.changed.overrides() };
    let (plan, files) = plan_and_files(&options.file, overrides)?;
    refuse_inputs(&files.paths(), &[("--out", options.out.as_deref()), ("--plot", options.plot.as_deref())])?;
    if let Some(sample) = options.sample {
        return one(&plan, sample);
    }
    let work = Workload::of_samples(&plan, options.out.is_some(), options.plot.is_some());
    work.check(options.out.as_deref().unwrap_or(Path::new("")), options.yes, false)?;
    let mut percentiles = Percentiles::new(&plan);
    match &options.out {
        Some(path) => save(path, &plan, &mut percentiles)?,
        None => DrawnScenes::visit(&plan, false, |drawn| {
            percentiles.add(drawn);
            Ok::<(), Failure>(())
        })?,
    }
    screen::print(&paragraphs(&dispersions::of_percentiles(&plan, &percentiles), screen::width()))?;
    plan.notes().iter().for_each(|note| screen::note(note));
    if percentiles.invalid() > 0 {
        screen::note(&format!(
            "{} of {} samples are not physical: their status would be invalid_sample",
            percentiles.invalid(),
            plan.samples
        ));
    }
    if let Some(path) = &options.plot {
        let columns = plan.dispersions.columns();
        if columns.is_empty() {
            return Err(Failure::Input(format!("{} has no dispersions: there is nothing to plot", plan.name)));
        }
        // sample 0 is the nominal scene, which is not dispersed
        let dispersed = DrawnScenes::new(&plan, SampleId(1), plotted_samples(&plan));
        let title = format!(
            "{}, {}{}, {} design",
            plan.name,
            if dispersed.count() as u64 + 1 < plan.samples { "first " } else { "" },
            counted(dispersed.count(), "sample"),
            plan.design.name().replace('_', " ")
        );
        let all = plan.samples.saturating_sub(1);
        let figures = DrawnInputs { columns: dispersed.columns.clone(), all }.figures(&plan);
        let written = FigureSheet { title, figures }
            .in_units(&plan.analysis.display)
            .save(path)
            .map_err(|error| Failure::Files(format!("{}: {error}", path.display())))?;
        let (numbers, samples) = (columns.len(), dispersed.count());
        let (numbers, samples) = (counted(numbers, "number"), counted(samples, "sample"));
        screen::note(&format!("{}: {numbers} of {samples}", written.display()));
        if written != *path {
            screen::note(&instead(&written));
        }
    }
    Ok(CommandOutcome::Done)
}

/// The numbers that one sample applies.
fn one(plan: &Plan, sample: u64) -> Result<CommandOutcome, Failure> {
    if sample >= plan.samples {
        let (last, name) = (plan.samples - 1, &plan.name);
        return Err(Failure::Input(format!("--sample {sample}: must be 0 to {last}, the samples of {name}")));
    }
    let applied = dispersions::applied(plan, SampleId(sample));
    screen::print(&Text::of(&applied).spaced(0, 2).lines(usize::MAX))?;
    if let Err(errors) = draw(plan, SampleId(sample)) {
        let reasons: String = errors.iter().map(|error| format!("\n  {error}")).collect();
        screen::note(&format!("sample {sample} is not physical (its status would be invalid_sample):{reasons}"));
    }
    Ok(CommandOutcome::Done)
}

fn save(path: &Path, plan: &Plan, percentiles: &mut Percentiles) -> Result<(), Failure> {
    drawn_table::save(plan, path, |drawn| percentiles.add(drawn))
        .map_err(|error| Failure::Files(format!("{}: {error}", path.display())))?;
    let (samples, columns) = (counted(plan.samples, "sample"), counted(drawn_table::columns(plan).len(), "column"));
    screen::note(&format!("{}: {samples}, {columns}", path.display()));
    Ok(())
}
