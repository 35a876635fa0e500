//! [`simulated`]: one sample of a plan again, as a table over time.

use crate::campaign::Plan;
use crate::control::laws::callback;
use crate::ensemble::SingleRun;
use crate::math::Isa;
use crate::run::Grid;
use crate::sampling::SampleId;
use crate::scene::SceneError;
use crate::storage::timeseries::time_series;
use crate::table::Table;
use crate::workflow::error::WorkflowError;

/// A run, and its table over time.
#[derive(Clone, Debug)]
pub struct Simulated {
    pub run: SingleRun,
    /// Its states and what is observed of them, at the points that were asked for.
    pub series: Table<'static>,
    /// What to know of the times, where the last is after the end of the campaign's runs.
    pub late: Option<String>,
}

/// Sample `sample` of `plan` at `times`, s; at the points of the campaign without.
///
/// # Errors
/// Where there is no such sample, its scene is not physical, or a time is no time.
pub fn simulated(plan: &Plan, sample: u64, times: Option<&[f64]>, isa: Isa) -> Result<Simulated, WorkflowError> {
    callback::refuse_missing(plan.loop_spec()).map_err(WorkflowError::Input)?;
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

/// The requested times, ascending, without duplicates.
fn ascending(times: &[f64]) -> Result<Vec<f64>, WorkflowError> {
    if let Some(wrong) = times.iter().find(|time| !(time.is_finite() && **time >= 0.0)) {
        return Err(WorkflowError::Input(format!("--times: {wrong:?} must be a finite number >= 0, in seconds")));
    }
    let mut times: Vec<f64> = times.iter().map(|time| time + 0.0).collect(); // -0 is 0
    times.sort_by(f64::total_cmp);
    times.dedup();
    Ok(times)
}

/// A grid of `times` that begins at zero, as every grid does: conservation errors are relative to that point.
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

/// The error that sample `sample` is not physical.
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
