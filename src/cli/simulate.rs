//! `spindrift simulate`: one sample over time.

use std::path::Path;

use crate::campaign::Plan;
use crate::cli::arguments::SimulateOptions;
use crate::cli::command_outcome::{CommandOutcome, Failure};
use crate::cli::screen;
use crate::ensemble::SingleRun;
use crate::ensemble::audit::AuditValue;
use crate::findings::dispersions;
use crate::findings::loss::{self, readable};
use crate::findings::number::{counted, short};
use crate::math::Isa;
use crate::report::time_table::time_table;
use crate::run::Status;
use crate::sampling::SampleId;
use crate::storage::table_file;
use crate::table::Table;
use crate::table::text::{Align, Text};
use crate::workflow::isa;
use crate::workflow::outputs::{check_formats, refuse_inputs};
use crate::workflow::simulated::{Simulated, plotted, simulated};
use crate::workflow::source::plan_and_files;

pub fn run(options: &SimulateOptions) -> Result<CommandOutcome, Failure> {
    check_formats(options.out.as_deref(), options.plot.as_deref())?;
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
        let grid = options.times.is_some().then(|| run.grid.clone());
        plotted(&plan, options.sample, grid, path, isa)?.iter().for_each(|note| screen::note(note));
    }
    if options.out.is_none() && options.plot.is_none() {
        if options.sample > 0 {
            let shown = dispersions::applied(&plan, SampleId(options.sample), false);
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
    // the tolerance is in the first line
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
    table_file::save(plan, series, path).map_err(|error| Failure::at(path, error))?;
    let (points, columns) = (counted(series.rows(), "point"), counted(series.columns.len(), "column"));
    screen::note(&format!("{}: {points}, {columns}", path.display()));
    Ok(())
}
