//! [`RunLanes`]: assignment of runs to lanes: loading, start of arcs, waiting, end.

use fearless_simd::Simd;

use super::brief::turn_squared;
use super::lane_state::{SeriesLane, Waiting};
use super::lane_vectors::LaneVectors;
use super::period::Period;
use super::period_search::section;
use super::points::{Until, evaluate_kept};
use super::return_detector::ReturnDetector;
use super::truncation::{Truncation, TruncationSums};
use super::workspace::Workspace;
use crate::dynamics::effects::within_arcs::WithinArcs;
use crate::dynamics::gyrostat::equations::Constants;
use crate::dynamics::gyrostat::{ATTITUDE, Gyrostat, IMPULSE, OMEGA, WITH_ATTITUDE, WITH_THRUST};
use crate::math::lanes::WIDEST;
use crate::math::vector::lane_of;
use crate::math::{Mask, Real};
use crate::propagation::arc_source::ArcSource;
use crate::run::{Grid, LocalErrors, Outcome, Status, StepStatistics, Trajectory};

/// Receives a completed run: index, run with its arcs, components at the points, outcome.
pub type RunCallback<'a> = dyn FnMut(usize, &Gyrostat<f64>, &mut Trajectory, &Outcome) + 'a;

/// Runs in lanes: `N` components, the first `J` with series, under the effects `E`.
pub struct RunLanes<'a, S, R, E, const N: usize, const J: usize> {
    pub simd: S,
    pub runs: &'a mut [Gyrostat<f64>],
    pub arcs: ArcSource<'a>,
    pub grid: &'a Grid,
    /// True if an arc has begun since the last step.
    pub has_begun: bool,
    /// Next run to load.
    pub next: usize,
    pub vectors: LaneVectors<R, N>,
    pub effects: E,
    pub detector: ReturnDetector<R>,
    /// Truncation of the steps of each lane's run.
    pub truncation: Truncation<R>,
    pub states: [Option<SeriesLane>; WIDEST],
    /// Step after which all lanes are examined at the latest.
    pub alarm: usize,
    pub work: &'a mut Workspace<R, J>,
}

impl<'a, S: Simd, R: Real, E: WithinArcs<R>, const N: usize, const J: usize> RunLanes<'a, S, R, E, N, J> {
    #[inline(always)]
    pub fn new(
        simd: S,
        zero: R,
        runs: &'a mut [Gyrostat<f64>],
        arcs: ArcSource<'a>,
        grid: &'a Grid,
        work: &'a mut Workspace<R, J>,
    ) -> Self {
        work.ring.clock = 0;
        RunLanes {
            simd,
            runs,
            arcs,
            grid,
            has_begun: false,
            next: 0,
            vectors: LaneVectors::new(zero),
            effects: E::none(zero),
            detector: ReturnDetector::none(zero),
            truncation: Truncation::new(zero, &work.rule),
            states: [None; WIDEST],
            alarm: 0,
            work,
        }
    }

    #[inline(never)]
    pub fn load_lane(&mut self, lane: usize) {
        self.vectors.set_state(lane, &[0.0; N]);
        self.truncation.set(lane, TruncationSums::default());
        let Some(run) = self.runs.get(self.next) else {
            self.states[lane] = None;
            self.idle(lane);
            return;
        };
        let unit = run.time_unit();
        self.set_unit(lane, self.next, unit);
        self.effects.set_lane(lane, &self.runs[self.next]);
        // the arcs use the memory of the lane
        core::mem::swap(&mut self.runs[self.next].flown, &mut self.work.records[lane]);
        self.runs[self.next].flown.clear();
        let run = &self.runs[self.next];
        for i in 0..3 {
            self.vectors.state[OMEGA + i].set_lane(lane, run.omega_b[i] * unit);
        }
        if N >= WITH_ATTITUDE {
            for i in 0..4 {
                self.vectors.state[ATTITUDE + i].set_lane(lane, run.q_eb[i]);
            }
        }
        if let (Some(offset), true) = (run.start_of_offset(), N >= WITH_THRUST) {
            for (i, component) in offset.into_iter().enumerate() {
                let factor = if i < 3 { unit } else { 1.0 };
                self.vectors.state[IMPULSE + i].set_lane(lane, component * factor);
            }
        }
        self.states[lane] = Some(SeriesLane::new(self.next, unit, self.work.ring.clock));
        self.next += 1;
        self.begin_arc(lane);
    }

    fn set_unit(&mut self, lane: usize, run: usize, unit: f64) {
        self.vectors.constants.set_run(lane, &self.runs[run], unit);
        self.vectors.per_unit.set_lane(lane, 1.0 / unit);
    }

    fn idle(&mut self, lane: usize) {
        self.vectors.idle(lane);
        self.detector.set(lane, None);
    }

    #[inline(never)]
    pub fn begin_arc(&mut self, lane: usize) {
        self.simd.vectorize(
            #[inline(always)]
            || self.begin_arc_vectorized(lane),
        );
    }

    #[inline(always)]
    fn begin_arc_vectorized(&mut self, lane: usize) {
        let Some(mut state) = self.states[lane] else { return };
        let vectors = &self.vectors;
        let run = &mut self.runs[state.run];
        self.arcs.begin_arc(state.run, run, state.end, || vectors.components(lane));
        let unit = run.time_unit();
        let arc = run.arcs.len() - 1;
        let bounds = run.arcs[arc].arc;
        if unit != state.unit {
            // a law may accelerate the body beyond its initial time scale
            self.vectors.rescale(lane, state.unit, unit);
            self.truncation.rescale(lane, unit / state.unit);
            self.set_unit(lane, state.run, unit);
            state.unit = unit;
        }
        self.vectors.constants.set_arc(lane, &self.runs[state.run], arc, unit);
        self.effects.set_arc(lane, &self.runs[state.run]);
        state.start = bounds.start;
        state.end = bounds.end();
        state.is_last = state.end >= self.arcs.duration();
        state.length = (state.end - state.start) / unit;
        state.begun = self.work.ring.clock;
        state.waiting = None;
        state.is_searching =
            self.work.settings.periodic && !bounds.applied.acts() && (N == J || self.may_return(lane, state.length));
        self.vectors.may_be_brief.set_lane(lane, if state.is_searching { 0.0 } else { 1.0 });
        self.has_begun = true;
        for i in J..N {
            state.quadratures[i - J] = self.vectors.state[i].lane(lane);
        }
        self.states[lane] = Some(state);
        self.vectors.time.set_lane(lane, 0.0);
        self.vectors.time_low.set_lane(lane, 0.0);
        self.vectors.length.set_lane(lane, state.length);
        let section = if state.is_searching {
            let constants = &self.vectors.constants;
            let [ratio, inverse, momentum] =
                [&constants.ratio, &constants.inverse, &constants.momentum].map(|vector| lane_of(vector, lane));
            section(ratio, inverse, momentum, self.vectors.omega(lane))
        } else {
            None
        };
        self.detector.set(lane, section.as_ref());
        self.set_next_point(lane);
        // a body at rest finds its period with the first step
        self.alarm = self.work.ring.clock + 1;
    }

    /// True if omega may return in a free arc: the body turns by more than a radian.
    #[inline(always)]
    fn may_return(&self, lane: usize, length: f64) -> bool {
        let LaneVectors { constants, .. } = &self.vectors;
        let (inverse, momentum) = (lane_of(&constants.inverse, lane), lane_of(&constants.momentum, lane));
        let alone = Constants { inverse, momentum, ..Constants::zero(0.0) };
        turn_squared(&alone, self.vectors.omega(lane), length) >= 1.0
    }

    #[inline(always)]
    pub fn set_next_point(&mut self, lane: usize) {
        let Some(state) = &self.states[lane] else { return };
        self.vectors.next_point.set_lane(lane, state.next_point(self.grid));
    }

    #[inline(always)]
    pub fn write_points(&mut self, rows: &[[f64; WIDEST]; N], due: R::Mask) {
        for lane in 0..R::LANES {
            if !due.test(lane) {
                continue;
            }
            let Some(state) = &mut self.states[lane] else { continue };
            let point = state.point;
            state.point += 1;
            let Workspace { points, trajectories, .. } = &mut *self.work;
            points.push(lane, point, rows, &mut trajectories[lane]);
            self.set_next_point(lane);
        }
    }

    fn flush_points(&mut self, lane: usize) {
        let Workspace { points, trajectories, .. } = &mut *self.work;
        points.flush::<N>(lane, &mut trajectories[lane]);
    }

    /// Makes `lane` wait until its points are evaluated with those of other lanes.
    pub fn wait(&mut self, lane: usize, period: Option<Period>) {
        if let Some(state) = &mut self.states[lane] {
            if let Some(period) = &period {
                state.periods = state.periods.max(state.length / period.length[0]);
            }
            let truncation = self.truncation.sums(lane);
            state.waiting = Some(Waiting { period, since: self.work.ring.clock, truncation });
        }
        self.idle(lane);
    }

    #[inline(never)]
    pub fn evaluate_kept(&mut self, lane: usize, until: Until) {
        let Some(state) = &mut self.states[lane] else { return };
        let Workspace { ring, trajectories, .. } = &mut *self.work;
        evaluate_kept::<R, N, J>(state, lane, ring, self.grid, &mut trajectories[lane], until);
    }

    /// Begins the next arc of `lane`, or passes its run to `finish` and loads the next.
    pub fn end_arc(&mut self, lane: usize, finish: &mut RunCallback<'_>) {
        self.flush_points(lane);
        let Some(state) = &mut self.states[lane] else { return };
        let steps = state.steps(self.work.ring.clock);
        if let Some(waiting) = &state.waiting {
            // the lane has stepped on since
            self.truncation.set(lane, waiting.truncation);
        }
        if !state.is_last {
            state.steps_before = steps;
            self.begin_arc(lane);
            return;
        }
        let state = *state;
        self.work.trajectories[lane].pad();
        self.pass_on(lane, &state, Status::Done, self.grid.duration(), self.grid.points(), finish);
    }

    #[cold]
    pub fn fail(&mut self, lane: usize, status: Status, finish: &mut RunCallback<'_>) {
        self.flush_points(lane);
        let Some(state) = self.states[lane] else { return };
        let start = self.work.ring.last().start.lane(lane);
        let reached = if status == Status::NonFinite { start } else { self.vectors.time.lane(lane) };
        if state.is_searching {
            self.evaluate_kept(lane, Until::Time(reached));
        }
        let points = self.states[lane].map_or(state.point, |state| state.point);
        self.work.trajectories[lane].fill_after(points, f64::NAN);
        self.pass_on(lane, &state, status, reached.mul_add(state.unit, state.start), points, finish);
    }

    fn pass_on(
        &mut self,
        lane: usize,
        state: &SeriesLane,
        status: Status,
        time: f64,
        points: usize,
        finish: &mut RunCallback<'_>,
    ) {
        let steps = state.steps(self.work.ring.clock);
        let outcome = Outcome {
            status,
            time,
            points,
            effort: StepStatistics { steps, rejected: 0, evaluations: steps },
            local_errors: self.truncation.sums(lane).errors(steps, state.periods, state.unit),
            debris_errors: LocalErrors::NONE,
        };
        finish(state.run, &self.runs[state.run], &mut self.work.trajectories[lane], &outcome);
        core::mem::swap(&mut self.runs[state.run].flown, &mut self.work.records[lane]);
        self.load_lane(lane);
    }

    /// Keeps the series of more steps for a long period, or ends the search.
    #[cold]
    pub fn keep_more_series(&mut self, lane: usize) {
        if self.work.ring.grow(self.vectors.time.zero()) {
            return;
        }
        self.evaluate_kept(lane, Until::Time(self.vectors.time.lane(lane)));
        if let Some(state) = &mut self.states[lane] {
            state.is_searching = false;
        }
        self.detector.set(lane, None);
        self.set_next_point(lane);
    }
}
