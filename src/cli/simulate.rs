//! `spindrift simulate`: one sample over time.

use std::path::Path;

use crate::campaign::Plan;
use crate::cli::arguments::SimulateOptions;
use crate::cli::command_outcome::{CommandOutcome, Failure};
use crate::cli::outputs::refuse_inputs;
use crate::cli::screen;
use crate::ensemble::SingleRun;
use crate::ensemble::audit::AuditValue;
use crate::findings::dispersions;
use crate::findings::loss::{self, readable};
use crate::findings::number::{counted, short};
use crate::math::Isa;
use crate::report::figure_files::{check_format, instead};
use crate::report::page::runs::GROUPS;
use crate::report::simulation_figure::{left_out, simulation_figure};
use crate::report::time_table::time_table;
use crate::run::{Grid, Status};
use crate::sampling::SampleId;
use crate::storage::table_file::{self, TableFormat};
use crate::table::Table;
use crate::table::text::{Align, Text};
use crate::workflow::isa;
use crate::workflow::simulated::{Simulated, not_physical, simulated};
use crate::workflow::source::plan_and_files;

/// A plot without --times has at least this many intervals: two per pixel.
const SMOOTH: usize = 1200;

pub fn run(options: &SimulateOptions) -> Result<CommandOutcome, Failure> {
    // refuse a file that cannot be written before any work
    if let Some(path) = &options.out {
        TableFormat::of(path).map_err(|error| Failure::Input(error.to_string()))?;
    }
    if let Some(path) = &options.plot {
        check_format(path).map_err(|error| Failure::Input(error.to_string()))?;
    }
    let (plan, files) = plan_and_files(&options.file, options.changed.overrides())?;
    refuse_inputs(&files.paths(), &[("--out", options.out.as_deref()), ("--plot", options.plot.as_deref())])?;
    let isa = isa()?;
    let Simulated { run, series, late } = simulated(&plan, options.sample, options.times.as_deref(), isa)?;
    late.iter().for_each(|note| screen::note(note));
    if options.audit {
        audit(options, &plan, &run, isa)?;
    }
    if let Some(path) = &options.out {
        save(path, &plan, &series)?;
    }
    if let Some(path) = &options.plot {
        let grid = if options.times.is_some() { run.grid.clone() } else { refined(&plan.grid) };
        let fine = SingleRun::with_series(&plan, SampleId(options.sample), grid, isa, &GROUPS);
        plot(path, options, &plan, &fine.map_err(|errors| not_physical(options.sample, &errors))?)?;
    }
    if options.out.is_none() && options.plot.is_none() {
        if options.sample > 0 {
            let shown = dispersions::shown(&plan, SampleId(options.sample));
            screen::print(&Text::of(&shown).spaced(0, 2).lines(screen::width()))?;
        }
        let (table, left_out) = time_table(&plan, &run.request.wheels, &series, screen::width());
        screen::print(&Text::of(&table).spaced(0, 1).lines(screen::width()))?;
        let points = series.rows();
        let shown = match points - table.rows() {
            0 => format!("all {}", counted(points, "point")),
            _ => format!("{} of {}", table.rows(), counted(points, "point")),
        };
        screen::note(&format!(
            "({shown}; --out X.csv or X.parquet writes all points, columns and digits; --plot X.svg draws them)"
        ));
        if !left_out.is_empty() {
            screen::note(&format!("(too wide for {} columns: {})", screen::width(), left_out));
        }
    }
    let names = run.request.columns().into_iter().map(|column| column.quantity.name().to_owned());
    let row: Vec<(String, f64)> = names.zip(run.row.iter().copied()).collect();
    if let Some(end) = loss::of_run(&row) {
        screen::note(&end);
    }
    if run.outcome.status != Status::Done {
        let (status, reason) = (run.outcome.status.name(), readable(&run.reason));
        let later = if run.outcome.status == Status::Inaccurate { "" } else { "; later points are not shown" };
        screen::note(&format!("the run ended with {status}: {reason}{later}"));
    }
    Ok(CommandOutcome::of(run.outcome.status))
}

/// The campaign's grid with divided intervals, for smooth curves; it contains the campaign's points.
fn refined(grid: &Grid) -> Grid {
    let intervals = grid.points().saturating_sub(1).max(1);
    Grid::uniform(grid.duration(), intervals * SMOOTH.div_ceil(intervals) + 1)
}

/// Compares the run with its reference solution, and shows errors and estimate.
fn audit(options: &SimulateOptions, plan: &Plan, run: &SingleRun, isa: Isa) -> Result<(), Failure> {
    let sample = options.sample;
    let found = match run.audit(plan, isa) {
        Ok(found) => found,
        Err(why) => {
            screen::note(&format!("sample {sample} has no audit: {why}"));
            return Ok(());
        }
    };
    let mut text = format!(
        "audit of sample {sample}, against a reference solution with tolerance {:e}\n",
        found.value(AuditValue::Tolerance)
    );
    // the tolerance of the reference solution is in the first line
    let values = AuditValue::of_scenes(run.request.debris).filter(|value| *value != AuditValue::Tolerance);
    let lines = values.map(|value| (value.quantity().name(), found.value(value)));
    let columns = run.request.columns();
    let observed = columns.iter().zip(&found.observables).filter(|(_, error)| !error.is_nan());
    let errors = observed.map(|(column, error)| (column.quantity.name(), *error));
    let numbers = |lines: &mut dyn Iterator<Item = (&str, f64)>| {
        let mut table = Table::with([("", Align::Left), ("", Align::Right)]);
        lines.for_each(|(name, value)| table.row([name.to_owned(), short(value)]));
        table.text(screen::width())
    };
    text += &numbers(&mut lines.into_iter());
    text += "\nnumerical error of\n";
    text += &numbers(&mut errors.into_iter());
    screen::print(&text)?;
    Ok(())
}

fn save(path: &Path, plan: &Plan, series: &Table<'_>) -> Result<(), Failure> {
    table_file::save(plan, series, path).map_err(|error| Failure::Files(format!("{}: {error}", path.display())))?;
    let (points, columns) = (counted(series.rows(), "point"), counted(series.columns.len(), "column"));
    screen::note(&format!("{}: {points}, {columns}", path.display()));
    Ok(())
}

fn plot(path: &Path, options: &SimulateOptions, plan: &Plan, run: &SingleRun) -> Result<(), Failure> {
    let title = match options.sample {
        0 => format!("{}, nominal", plan.name),
        sample => format!("{}, sample {sample}", plan.name),
    };
    let figure = simulation_figure(title, plan, run).in_units(&plan.analysis.display);
    let written = figure.save(path).map_err(|error| Failure::Files(format!("{}: {error}", path.display())))?;
    let points = run.outcome.points.min(run.grid.points());
    let empty = left_out(plan, run);
    let without = if empty.is_empty() {
        String::new()
    } else {
        format!("; left out, zero or absent throughout: {}", empty.join(", "))
    };
    let (figures, points) = (counted(figure.figures.len(), "figure"), counted(points, "point"));
    screen::note(&format!("{}: {figures} of {points}{without}", written.display()));
    if written != path && !path.ends_with(".html") {
        screen::note(&instead(&written));
    }
    Ok(())
}
