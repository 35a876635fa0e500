//! `spindrift sample`: the dispersed parameters of a campaign, without runs.

use std::path::Path;

use crate::campaign::Overrides;
use crate::cli::arguments::SampleOptions;
use crate::cli::command_outcome::{CommandOutcome, Failure};
use crate::cli::input::plan;
use crate::cli::{dispersions, screen};
use crate::dataset::drawn_table::DrawnTable;
use crate::dataset::table::{TableError, TableFormat};
use crate::ensemble::DrawnScenes;
use crate::report::canvas::{Canvas, PlotError, PlotFormat};
use crate::report::drawn_figure::DrawnFigure;
use crate::sampling::SampleId;

/// Runs the command.
///
/// # Errors
/// Where the campaign file is wrong or a file cannot be written.
pub fn run(options: &SampleOptions) -> Result<CommandOutcome, Failure> {
    // refuse a file that cannot be written before any work
    if let Some(path) = &options.out {
        TableFormat::of(path).map_err(|error| Failure::Input(error.to_string()))?;
    }
    if let Some(path) = &options.plot {
        PlotFormat::of(path).map_err(|error| Failure::Input(error.to_string()))?;
    }
    let plan = plan(&options.file, Overrides { samples: options.samples, seed: options.seed, ..Overrides::default() })?;
    let drawn = DrawnScenes::new(&plan, SampleId(0), plan.samples);
    let mut text = String::new();
    // sample 0 is the nominal scene, which is not dispersed
    let dispersed = DrawnScenes {
        first: SampleId(1),
        physical: drawn.physical.iter().skip(1).copied().collect(),
        columns: drawn.columns.iter().map(|column| column.iter().skip(1).copied().collect()).collect(),
    };
    dispersions::table_of(&mut text, &plan, &dispersed).map_err(Failure::files)?;
    screen::print(&text)?;
    plan.notes().iter().for_each(|note| screen::note(note));
    let invalid = drawn.physical.iter().filter(|physical| !**physical).count();
    if invalid > 0 {
        screen::note(&format!(
            "{invalid} of {} samples are not physical: their status would be invalid_sample",
            drawn.count()
        ));
    }
    if let Some(path) = &options.out {
        save(path, &DrawnTable { plan: &plan, drawn: &drawn })?;
    }
    if let Some(path) = &options.plot {
        let columns = plan.dispersions.columns();
        if columns.is_empty() {
            return Err(Failure::Input(format!("{} has no dispersions: there is nothing to plot", plan.name)));
        }
        let figure = DrawnFigure {
            title: format!(
                "{}, {} samples, {} design",
                plan.name,
                dispersed.count(),
                plan.design.name().replace('_', " ")
            ),
            names: columns.iter().map(|column| column.parameter.component_name(column.component)).collect(),
            nominal: columns.iter().map(|column| column.nominal).collect(),
            drawn: &dispersed,
        };
        figure.save(path).map_err(|error| match error {
            PlotError::Format(_) => Failure::Input(error.to_string()),
            _ => Failure::Files(format!("{}: {error}", path.display())),
        })?;
        screen::note(&format!("{}: {} numbers of {} samples", path.display(), columns.len(), dispersed.count()));
    }
    Ok(CommandOutcome::Done)
}

fn save(path: &Path, table: &DrawnTable<'_>) -> Result<(), Failure> {
    table.save(path).map_err(|error| match error {
        TableError::Format(_) => Failure::Input(error.to_string()),
        _ => Failure::Files(format!("{}: {error}", path.display())),
    })?;
    let (samples, columns) = (table.drawn.count(), table.headings().len());
    screen::note(&format!("{}: {samples} samples, {columns} columns", path.display()));
    Ok(())
}
