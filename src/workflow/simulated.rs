//! [`simulated`]: one sample of a plan as a table over time; [`plotted`]: as figures.

use std::path::Path;

use crate::campaign::Plan;
use crate::ensemble::SingleRun;
use crate::ensemble::replays::GROUPS;
use crate::ensemble::single::SingleRuns;
use crate::findings::number::counted;
use crate::math::Isa;
use crate::report::figure_files::instead;
use crate::report::simulation_figure::{left_out, simulation_figure};
use crate::run::Grid;
use crate::sampling::SampleId;
use crate::scene::SceneError;
use crate::storage::timeseries::time_series;
use crate::table::Table;
use crate::workflow::error::{Result, WorkflowError};
use crate::workflow::source::refuse_missing_law;

#[derive(Clone, Debug)]
pub struct Simulated {
    pub run: SingleRun,
    /// States and observables at the requested points.
    pub series: Table<'static>,
    /// A note on times beyond the end of the campaign's runs.
    pub late: Option<String>,
}

/// Sample `sample` of `plan` at `times`, s, by default at the campaign's points.
///
/// # Errors
/// An unknown sample, an unphysical scene, or an invalid time.
pub fn simulated(plan: &Plan, sample: u64, times: Option<&[f64]>, isa: Isa) -> Result<Simulated> {
    refuse_missing_law(plan)?;
    if sample >= plan.samples {
        let (last, name) = (plan.samples - 1, &plan.name);
        return Err(WorkflowError::Input(format!("--sample {sample}: must be 0 to {last}, the samples of {name}")));
    }
    let times = times.map(ascending).transpose()?;
    let (last, end) = (times.as_ref().and_then(|times| times.last().copied()), plan.grid.duration());
    let late = last
        .filter(|last| *last > end)
        .map(|last| format!("--times: {last:?} s is after the end of the runs of {} ({end:?} s)", plan.name));
    let grid = times.as_deref().map_or_else(|| plan.grid.clone(), |times| grid(times, plan));
    let run = SingleRun::new(plan, SampleId(sample), grid, isa).map_err(|errors| not_physical(sample, &errors))?;
    let shown = |time: f64| times.as_deref().is_none_or(|times| times.contains(&time));
    let series = time_series(SampleId(sample), &run, shown);
    Ok(Simulated { run, series, late })
}

/// Fewest intervals of a plot without requested times: two per pixel.
const SMOOTH: usize = 1200;

/// Draws sample `sample` of `plan` to the file `path`, on `grid` or the divided grid of the campaign; returns a note,
/// if any.
///
/// # Errors
/// An unphysical scene, or a failed file operation.
pub fn plotted(plan: &Plan, sample: u64, grid: Option<Grid>, path: &Path, isa: Isa) -> Result<Vec<String>> {
    let intervals = plan.grid.points().saturating_sub(1).max(1);
    let refined = || Grid::uniform(plan.grid.duration(), intervals * SMOOTH.div_ceil(intervals) + 1);
    let run = SingleRuns::new(plan, grid.unwrap_or_else(refined), isa, &GROUPS, false)
        .run(SampleId(sample))
        .map_err(|errors| not_physical(sample, &errors))?;
    let which = if sample == 0 { "nominal".to_owned() } else { format!("sample {sample}") };
    let figure = simulation_figure(format!("{}, {which}", plan.name), plan, &run).in_units(&plan.analysis.display);
    let written = figure.save(path).map_err(|error| WorkflowError::at(path, error))?;
    let without = match &left_out(plan, &run)[..] {
        [] => String::new(),
        empty => format!("; left out, zero or absent throughout: {}", empty.join(", ")),
    };
    let points = counted(run.outcome.points.min(run.grid.points()), "point");
    let figures = counted(figure.figures.len(), "figure");
    let said = format!("{}: {figures} of {points}{without}", written.display());
    let other = (written != path && !path.ends_with(".html")).then(|| instead(&written));
    Ok([said].into_iter().chain(other).collect())
}

fn ascending(times: &[f64]) -> Result<Vec<f64>> {
    if let Some(wrong) = times.iter().find(|time| !(time.is_finite() && **time >= 0.0)) {
        return Err(WorkflowError::Input(format!("--times: {wrong:?} must be a finite number >= 0, in seconds")));
    }
    let mut times: Vec<f64> = times.iter().map(|time| time + 0.0).collect(); // -0 is 0
    times.sort_by(f64::total_cmp);
    times.dedup();
    Ok(times)
}

/// A grid of `times` from zero on, to which conservation errors are relative.
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

/// The error of an unphysical sample.
pub fn not_physical(sample: u64, errors: &[SceneError]) -> WorkflowError {
    let errors: Vec<String> = errors.iter().map(|error| format!("\n  {error}")).collect();
    WorkflowError::Input(format!("sample {sample} is not physical (its status is invalid_sample):{}", errors.concat()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_sorted_and_single() {
        assert_eq!(ascending(&[3.0, -0.0, 1.0, 3.0]), Ok(vec![0.0, 1.0, 3.0]));
        for wrong in [f64::NAN, f64::INFINITY, -1.0] {
            assert!(matches!(ascending(&[wrong]), Err(WorkflowError::Input(_))));
        }
    }
}
