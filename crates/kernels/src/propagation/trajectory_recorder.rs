//! [`TrajectoryRecorder`]: trajectories and outcomes of runs in lanes.

use super::local_error::local_errors;
use crate::ode::{EndedRun, ErrorModel, Recorder, Termination};
use crate::run::{Grid, LocalErrors, Outcome, Status, StepStatistics, Trajectory};

/// Trajectory and next observation point of the run in a lane.
#[derive(Clone, Debug)]
pub struct LaneTrajectory {
    trajectory: Trajectory,
    point: usize,
}

impl LaneTrajectory {
    /// Memory for `lanes` lanes of runs of `components` components at `points` observation points.
    pub fn for_lanes(lanes: usize, components: usize, points: usize) -> Vec<Self> {
        vec![LaneTrajectory { trajectory: Trajectory::new(components, points), point: 0 }; lanes]
    }
}

/// Records runs at the times of a grid and calls `finish(runs, lane, run, trajectory, outcome)` at the end of each,
/// with NaN at points not reached.
pub struct TrajectoryRecorder<'a, F> {
    grid: &'a Grid,
    lanes: &'a mut [LaneTrajectory],
    errors: ErrorModel,
    tolerance: f64,
    finish: F,
}

impl<'a, F> TrajectoryRecorder<'a, F> {
    /// For a method with the error model `errors` at the relative tolerance `tolerance`.
    pub fn new(grid: &'a Grid, lanes: &'a mut [LaneTrajectory], errors: ErrorModel, tolerance: f64, finish: F) -> Self {
        TrajectoryRecorder { grid, lanes, errors, tolerance, finish }
    }
}

impl<Q, F, const N: usize> Recorder<Q, N> for TrajectoryRecorder<'_, F>
where
    F: FnMut(&Q, usize, usize, &Trajectory, &Outcome),
{
    #[inline(always)]
    fn begin(&mut self, lane: usize, _run: usize) {
        self.lanes[lane].point = 0;
    }

    #[inline(always)]
    fn next_time(&self, lane: usize) -> f64 {
        self.grid.times().get(self.lanes[lane].point).copied().unwrap_or(f64::INFINITY)
    }

    #[inline(always)]
    fn record(&mut self, lane: usize, state: &[f64; N]) {
        let lane = &mut self.lanes[lane];
        lane.trajectory.set(lane.point, state);
        lane.point += 1;
    }

    #[inline(always)]
    fn finish(&mut self, runs: &Q, lane: usize, run: usize, completion: &EndedRun) {
        let LaneTrajectory { trajectory, point } = &mut self.lanes[lane];
        trajectory.fill_after(*point, f64::NAN);
        trajectory.pad();
        let outcome = Outcome {
            status: status(completion.termination),
            time: completion.time,
            points: *point,
            effort: StepStatistics {
                steps: completion.accepted,
                rejected: completion.rejected,
                evaluations: completion.evaluations,
            },
            local_errors: local_errors(&self.errors, self.tolerance, completion),
            debris_errors: LocalErrors::NONE,
        };
        (self.finish)(runs, lane, run, trajectory, &outcome);
    }
}

fn status(termination: Termination) -> Status {
    match termination {
        Termination::Completed => Status::Done,
        Termination::StepLimit => Status::StepLimit,
        Termination::StepFloor => Status::StepFloor,
        Termination::NonFinite => Status::NonFinite,
    }
}
