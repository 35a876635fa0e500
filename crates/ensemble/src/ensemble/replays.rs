//! [`replayed`]: runs with states and series for the page.

use crate::campaign::Plan;
use crate::ensemble::SingleRun;
use crate::ensemble::single::SingleRuns;
use crate::math::Isa;
use crate::math::vector::norm;
use crate::observables::Group;
use crate::run::{Grid, StateField, points_before, points_to};
use crate::sampling::SampleId;

/// Fewest intervals, also for a coarser grid of the campaign.
const FEWEST: usize = 240;
const MOST: usize = 600;
/// Runs side by side: the widest vectors.
const BESIDE: usize = 8;
/// Turn between two pictures, rad.
const TURN: f64 = 0.6;

/// Groups with series in page and plots.
pub const GROUPS: [Group; 8] = [
    Group::EnergyConservation,
    Group::MomentumConservation,
    Group::Attitude,
    Group::Energies,
    Group::EnergiesCom,
    Group::Constraints,
    Group::Motion,
    Group::Orbit,
];

/// Flies `samples` on the page's grid, which includes the missions' `ends`; returns physical ones.
pub fn replayed(
    plan: &Plan,
    samples: &[SampleId],
    ends: impl Iterator<Item = f64>,
    isa: Isa,
) -> Vec<(SampleId, SingleRun)> {
    if samples.is_empty() {
        return Vec::new();
    }
    let grid = ends.fold(grid(plan, isa), |grid, end| with_time(&grid, end).unwrap_or(grid));
    let mut runs = SingleRuns::new(plan, grid, isa, &GROUPS, true);
    let flown = samples.chunks(BESIDE).flat_map(|some| some.iter().copied().zip(runs.run_all(some)));
    flown.filter_map(|(sample, run)| Some((sample, run.ok()?))).collect()
}

fn grid(plan: &Plan, isa: Isa) -> Grid {
    let given = plan.grid.points().saturating_sub(1).max(1);
    // phases of a mission are short: as many as possible
    if plan.law.is_some() {
        return Grid::uniform(plan.grid.duration(), given.min(MOST) * (MOST / given).max(1) + 1);
    }
    let looked_at = Grid::uniform(plan.grid.duration(), given.min(MOST) + 1);
    let nominal = || SingleRuns::new(plan, looked_at, isa, &[], true).run(SampleId(0));
    let fastest = nominal().map_or(0.0, |run| {
        let points = run.outcome.points.min(run.grid.points());
        let rate = |point: usize| norm(run.table.at(StateField::Rate, point));
        (0..points).map(rate).filter(|rate| rate.is_finite()).fold(0.0, f64::max)
    });
    let wanted = (fastest * plan.grid.duration() / TURN).clamp(FEWEST as f64, MOST as f64) as usize;
    let intervals = if given >= wanted { given.min(MOST) } else { given * (wanted / given).max(1) };
    Grid::uniform(plan.grid.duration(), intervals + 1)
}

/// `grid` with one more time; `None` if it has it or ends before.
fn with_time(grid: &Grid, time: f64) -> Option<Grid> {
    let place = points_before(grid.times(), time);
    if place == grid.points() || points_to(grid.times(), time) > place {
        return None;
    }
    let mut times = grid.times().to_vec();
    times.insert(place, time);
    Some(Grid::at(times))
}
