//! `spindrift precision`: run time against error for methods and tolerances.

use std::path::PathBuf;

use crate::cli::arguments::PrecisionOptions;
use crate::cli::command_outcome::{CommandOutcome, Failure};
use crate::cli::screen;
use crate::ensemble::precision::Limits;
use crate::report::figure_files::instead;
use crate::report::screen::{measurement, paragraphs};
use crate::workflow::outputs::refuse_inputs;
use crate::workflow::precision::{Told, Wanted, measured, outputs};
use crate::workflow::source::plan_and_files;

pub fn run(options: &PrecisionOptions) -> Result<CommandOutcome, Failure> {
    let (plan, files) = plan_and_files(&options.file, options.changed.overrides())?;
    let default = || PathBuf::from("results").join(format!("{}_precision", plan.name));
    let folder = options.out.clone().unwrap_or_else(default);
    for output in outputs(&folder) {
        refuse_inputs(&files.paths(), &[("--out", Some(&output))])?;
    }
    let wanted = Wanted {
        methods: options.methods.clone(),
        tolerances: options.tolerances.clone(),
        samples: options.samples.get(),
        is_observed: options.observed,
        limits: Limits { repeats: options.repeats.get(), limit: options.limit_s },
        is_allowed: options.yes,
    };
    let width = screen::width();
    let [table, figure] = measured(&plan, &wanted, &folder, &mut |told| {
        let text = match told {
            Told::Begun(head) => paragraphs(head, usize::MAX) + &measurement(None, width),
            Told::Measured(found) => measurement(Some(found), width),
            Told::Omitted(omitted) => paragraphs(omitted, usize::MAX),
        };
        Ok(screen::print(&text)?)
    })?;
    screen::note(&table.display().to_string());
    let is_drawn = figure.extension().is_some_and(|found| found == "svg");
    screen::note(&if is_drawn { figure.display().to_string() } else { instead(&figure) });
    Ok(CommandOutcome::Done)
}
