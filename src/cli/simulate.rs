//! `spindrift simulate`: one sample over time.

use std::fmt::Write as _;
use std::path::Path;

use crate::campaign::{Overrides, Plan};
use crate::cli::arguments::SimulateOptions;
use crate::cli::command_outcome::{CommandOutcome, Failure};
use crate::cli::input::{isa, plan};
use crate::cli::screen;
use crate::dataset::table::{TableError, TableFormat};
use crate::dataset::timeseries::{TimeColumn, TimeSeries};
use crate::ensemble::audit::AuditValue;
use crate::ensemble::{Auditor, SingleRun};
use crate::math::Isa;
use crate::observables::Series;
use crate::observables::table::STATE_ERROR_ESTIMATE;
use crate::report::energy_figure::energy_figure;
use crate::report::number::short;
use crate::report::plot::{PlotError, PlotFormat};
use crate::run::{Grid, StateField, Status};
use crate::sampling::SampleId;

/// The columns on the screen: what fits, the rest is in the files.
const ON_SCREEN: [TimeColumn; 12] = [
    TimeColumn::Time,
    TimeColumn::State(StateField::Rate, 0),
    TimeColumn::State(StateField::Rate, 1),
    TimeColumn::State(StateField::Rate, 2),
    TimeColumn::State(StateField::WheelRates, 0),
    TimeColumn::State(StateField::WheelRates, 1),
    TimeColumn::Series(Series::EnergyFuselage),
    TimeColumn::Series(Series::EnergyWheel1),
    TimeColumn::Series(Series::EnergyWheel2),
    TimeColumn::Series(Series::EnergyError),
    TimeColumn::Series(Series::LinearMomentumError),
    TimeColumn::Series(Series::AngularMomentumError),
];

/// A plot has at least this many intervals, unless it is told its times: two to a pixel.
const SMOOTH: usize = 1200;

/// Runs the command.
///
/// # Errors
/// Where the sample cannot be run or its files cannot be written.
pub fn run(options: &SimulateOptions) -> Result<CommandOutcome, Failure> {
    // refuse a file that cannot be written before running for it
    if let Some(path) = &options.out {
        TableFormat::of(path).map_err(|error| Failure::Input(error.to_string()))?;
    }
    if let Some(path) = &options.plot {
        PlotFormat::of(path).map_err(|error| Failure::Input(error.to_string()))?;
    }
    let plan = plan(&options.file, Overrides::default())?;
    let isa = isa()?;
    if options.sample >= plan.samples {
        let (last, name) = (plan.samples - 1, &plan.name);
        return Err(Failure::Input(format!("--sample {}: must be 0 to {last}, the samples of {name}", options.sample)));
    }
    let times = options.times.as_deref().map(ascending).transpose()?;
    let grid = times.as_deref().map_or_else(|| plan.grid.clone(), |times| grid(times, &plan));
    let run = single_run(options, &plan, grid, isa)?;
    let shown = |time: f64| times.as_deref().is_none_or(|times| times.contains(&time));
    if options.audit {
        audit(options, &plan, &run, isa)?;
    }
    let series = TimeSeries::new(&plan, SampleId(options.sample), &run, shown);
    if let Some(path) = &options.out {
        save(path, &series)?;
    }
    if let Some(path) = &options.plot {
        if times.is_some() {
            plot(path, options, &plan, &series)?;
        } else {
            let fine = single_run(options, &plan, refined(&plan.grid), isa)?;
            plot(path, options, &plan, &TimeSeries::new(&plan, SampleId(options.sample), &fine, |_| true))?;
        }
    }
    if options.out.is_none() && options.plot.is_none() {
        screen::print(&table(&series))?;
        screen::note("(--out X.csv or --out X.parquet writes all columns)");
    }
    if run.outcome.status != Status::Done {
        let (status, time) = (run.outcome.status.name(), run.outcome.time);
        screen::note(&format!("the run ended with {status} at {time:?} s; what follows is not shown"));
    }
    Ok(CommandOutcome::of(run.outcome.status))
}

/// The times that were asked for, ascending, each once.
fn ascending(times: &[f64]) -> Result<Vec<f64>, Failure> {
    if let Some(wrong) = times.iter().find(|time| !(time.is_finite() && **time >= 0.0)) {
        return Err(Failure::Input(format!("--times: {wrong:?} must be a finite number >= 0, in seconds")));
    }
    let mut times: Vec<f64> = times.iter().map(|time| time + 0.0).collect(); // -0 is 0
    times.sort_by(f64::total_cmp);
    times.dedup();
    Ok(times)
}

/// A grid that holds `times` and begins at zero, as every grid does; conservation is measured from there.
fn grid(times: &[f64], plan: &Plan) -> Grid {
    let mut times = times.to_vec();
    if times.first() != Some(&0.0) {
        times.insert(0, 0.0);
    }
    if times.len() == 1 {
        times.push(plan.grid.duration());
    }
    Grid::at(times)
}

/// The campaign's grid with its intervals divided, so that curves are smooth; the campaign's own points are among them.
fn refined(grid: &Grid) -> Grid {
    let intervals = grid.points().saturating_sub(1).max(1);
    Grid::uniform(grid.duration(), intervals * SMOOTH.div_ceil(intervals) + 1)
}

/// How far the run is off the truth, and what was estimated.
fn audit(options: &SimulateOptions, plan: &Plan, run: &SingleRun, isa: Isa) -> Result<(), Failure> {
    let sample = options.sample;
    let Some(found) = Auditor::new(plan, isa, &run.grid).audit(&run.scene) else {
        screen::note(&format!("audit of sample {sample}: the run, or its truth, does not arrive"));
        return Ok(());
    };
    let mut text = format!("audit of sample {sample}, against a solution at {:e}\n", found.reference_tolerance);
    // the tolerance of the reference solution is in the first line
    let values = AuditValue::ALL.into_iter().filter(|value| *value != AuditValue::Tolerance);
    let lines = values
        .map(|value| (value.quantity().name(), found.value(value)))
        .chain([(STATE_ERROR_ESTIMATE.quantity().name(), found.estimate)]);
    let columns = run.request.columns();
    let observed = columns.iter().zip(&found.observables).filter(|(_, error)| !error.is_nan());
    let errors = observed.map(|(column, error)| (column.quantity.name(), *error));
    for (name, value) in lines {
        let _ = writeln!(text, "{name:<40}{:>12}", short(value)); // writing to a String does not fail
    }
    let _ = writeln!(text, "\nnumerical error of");
    for (name, error) in errors {
        let _ = writeln!(text, "{name:<40}{:>12}", short(error));
    }
    screen::print(&text)?;
    Ok(())
}

fn single_run(options: &SimulateOptions, plan: &Plan, grid: Grid, isa: Isa) -> Result<SingleRun, Failure> {
    let sample = SampleId(options.sample);
    SingleRun::new(plan, sample, grid, isa).map_err(|errors| {
        let errors: Vec<String> = errors.iter().map(|error| format!("\n  {error}")).collect();
        Failure::Input(format!("sample {sample} is not physical (its row says invalid_sample):{}", errors.concat()))
    })
}

fn save(path: &Path, series: &TimeSeries) -> Result<(), Failure> {
    series.save(path).map_err(|error| match error {
        TableError::Format(_) => Failure::Input(error.to_string()),
        _ => Failure::Files(format!("{}: {error}", path.display())),
    })?;
    let (points, columns) = (series.points(), series.headings().len());
    screen::note(&format!("{}: {points} points, {columns} columns", path.display()));
    Ok(())
}

fn plot(path: &Path, options: &SimulateOptions, plan: &Plan, series: &TimeSeries) -> Result<(), Failure> {
    let title = match options.sample {
        0 => format!("{}, nominal", plan.name),
        sample => format!("{}, sample {sample}", plan.name),
    };
    energy_figure(&title, series).save(path).map_err(|error| match error {
        PlotError::Format(_) => Failure::Input(error.to_string()),
        _ => Failure::Files(format!("{}: {error}", path.display())),
    })?;
    screen::note(&format!("{}: energies at {} points", path.display(), series.points()));
    Ok(())
}

/// The main columns, aligned; numbers in the fewest digits that read back to the same bits.
fn table(series: &TimeSeries) -> String {
    let columns: Vec<(&str, Vec<String>)> = ON_SCREEN
        .into_iter()
        .filter_map(|key| series.column(key))
        .map(|(quantity, values)| (quantity.name(), values.iter().map(|value| format!("{value:?}")).collect()))
        .collect();
    let widths: Vec<usize> = columns
        .iter()
        .map(|(name, values)| values.iter().map(String::len).chain([name.len()]).max().unwrap_or(0))
        .collect();
    let mut text = String::new();
    let mut line = |cells: &mut dyn Iterator<Item = &str>| {
        let cells: Vec<String> = cells.zip(&widths).map(|(cell, width)| format!("{cell:>width$}")).collect();
        let _ = writeln!(text, "{}", cells.join("  ")); // writing to a String does not fail
    };
    line(&mut columns.iter().map(|(name, _)| *name));
    for point in 0..series.points() {
        line(&mut columns.iter().map(|(_, values)| values[point].as_str()));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: a plot shows the campaign's own points too (their times to the last digit or two).
    #[test]
    fn a_refined_grid_holds_the_campaigns_points() {
        let (coarse, fine) = (Grid::uniform(10.0, 101), refined(&Grid::uniform(10.0, 101)));
        assert!(fine.points() > SMOOTH && fine.duration() == 10.0);
        let near = |time: &f64| fine.times().iter().any(|other| (other - time).abs() <= 1e-15 * 10.0);
        assert!(coarse.times().iter().all(near));
    }

    #[test]
    fn times_are_sorted_and_single() {
        assert_eq!(ascending(&[3.0, -0.0, 1.0, 3.0]), Ok(vec![0.0, 1.0, 3.0]));
        for wrong in [f64::NAN, f64::INFINITY, -1.0] {
            assert!(matches!(ascending(&[wrong]), Err(Failure::Input(_))));
        }
    }
}
