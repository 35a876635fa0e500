//! Which run stands in which lane, how far it is written, and how it leaves: the bookkeeping that all marches share.
//!
//! No arithmetic of a method. Nothing is allocated after [`Workspace::new`].

use super::Runs;
use crate::math::Real;
use crate::run::LocalErrors;
use crate::run::{Grid, Trajectory};
use crate::run::{Outcome, Status, StepStatistics};

/// What a worker owns and reuses from march to march: one trajectory per lane.
#[derive(Clone, Debug)]
pub struct Workspace {
    berths: Vec<LaneSlot>,
    /// The next run that has no lane yet.
    waiting: usize,
    /// Number of lanes with a run.
    occupied: usize,
}

/// A lane's run.
#[derive(Clone, Debug)]
struct LaneSlot {
    occupied: bool,
    run: usize,
    /// The next observation point.
    point: usize,
    trajectory: Trajectory,
}

/// A run that has just been put into a lane.
pub(super) struct LoadedRun<const N: usize> {
    /// Its state at time zero.
    pub state: [f64; N],
    /// The end of its first arc, s.
    pub end: f64,
}

impl Workspace {
    /// For `lanes` lanes (`R::LANES`) of runs of `components` components at `points` observation points.
    pub fn new(lanes: usize, components: usize, points: usize) -> Self {
        let berth = LaneSlot { occupied: false, run: 0, point: 0, trajectory: Trajectory::new(components, points) };
        Workspace { berths: vec![berth; lanes], waiting: 0, occupied: 0 }
    }

    /// Starts over with the first run.
    pub(super) fn open(&mut self) {
        self.waiting = 0;
        self.occupied = 0;
        for berth in &mut self.berths {
            berth.occupied = false;
        }
    }

    /// Whether any lane has a run.
    #[inline(always)]
    pub(super) fn is_occupied(&self) -> bool {
        self.occupied > 0
    }

    /// Whether lane `lane` has a run.
    #[inline(always)]
    pub(super) fn has_run(&self, lane: usize) -> bool {
        self.berths[lane].occupied
    }

    /// The time of the next observation point of lane `lane`, infinite after the last.
    #[inline(always)]
    pub(super) fn next_time(&self, lane: usize, grid: &Grid) -> f64 {
        grid.times().get(self.berths[lane].point).copied().unwrap_or(f64::INFINITY)
    }

    /// Writes the next observation point of lane `lane`.
    #[inline(always)]
    pub(super) fn write<const N: usize>(&mut self, lane: usize, state: &[f64; N]) {
        let berth = &mut self.berths[lane];
        berth.trajectory.set(berth.point, state);
        berth.point += 1;
    }

    /// Puts the next waiting run into lane `lane`, its initial state at point zero; `None` where none waits.
    #[inline(always)]
    pub(super) fn load<R, Q, F, const N: usize>(
        &mut self,
        lane: usize,
        runs: &mut Q,
        grid: &Grid,
        finish: &mut F,
    ) -> Option<LoadedRun<N>>
    where
        R: Real,
        Q: Runs<R, N>,
        F: FnMut(&Q, usize, usize, &Trajectory, &Outcome),
    {
        while self.waiting < runs.count() {
            let run = self.waiting;
            self.waiting += 1;
            let state = runs.load(lane, run);
            let berth = &mut self.berths[lane];
            (berth.occupied, berth.run, berth.point) = (true, run, 0);
            self.occupied += 1;
            while self.next_time(lane, grid) <= 0.0 {
                self.write(lane, &state);
            }
            if let Some(end) = runs.next_arc(lane, 0.0, &state) {
                return Some(LoadedRun { state, end });
            }
            self.close::<R, Q, F, N>(
                lane,
                runs,
                Status::Done,
                0.0,
                (StepStatistics::default(), LocalErrors::default()),
                finish,
            );
        }
        None
    }

    /// Hands the run in lane `lane` to `finish` and frees the lane; what was not reached is not a number. What the run cost
    /// and what it made of errors ([`Outcome::local_errors`]) the march says.
    #[inline(always)]
    pub(super) fn close<R, Q, F, const N: usize>(
        &mut self,
        lane: usize,
        runs: &Q,
        status: Status,
        time: f64,
        (effort, local_errors): (StepStatistics, LocalErrors),
        finish: &mut F,
    ) where
        R: Real,
        Q: Runs<R, N>,
        F: FnMut(&Q, usize, usize, &Trajectory, &Outcome),
    {
        let berth = &mut self.berths[lane];
        let (points, filled) = (berth.trajectory.points(), berth.point);
        for component in 0..N {
            let column = berth.trajectory.column_mut(component);
            column[filled..].fill(f64::NAN);
            let last = column[points - 1];
            column[points..].fill(last);
        }
        berth.occupied = false;
        self.occupied -= 1;
        finish(
            runs,
            lane,
            berth.run,
            &berth.trajectory,
            &Outcome { status, time, points: filled, effort, local_errors },
        );
    }
}
