//! [`LaneState`]: where a lane is in its run, and how it goes from run to run, from stretch to stretch.

use fearless_simd::Simd;

use super::driver::{CompletionCallback, Driver};
use super::period::{Period, PoincareSection};
use super::truncation::TruncationSums;
use crate::dynamics::gyrostat::{ATTITUDE, IMPULSE, IMPULSE_INTEGRAL, OMEGA, WITH_ANGLES, WITH_ATTITUDE, WITH_THRUST};
use crate::math::Real;
use crate::run::{Outcome, Status, StepStatistics};

/// One lane's place in its run.
#[derive(Clone, Copy, Debug)]
pub(super) struct LaneState {
    pub run: usize,
    pub stretch: usize,
    /// Unit of time, s: a power of two near the time scale of the motion, so that every conversion is exact.
    pub unit: f64,
    /// Length of the stretch, units.
    pub length: f64,
    /// First observation point that is not evaluated yet.
    pub point: usize,
    /// The step of the march at which the stretch began: of a stretch that is watched, the series since then are kept.
    pub begun: usize,
    /// Steps of the run before the stretch.
    pub steps_before: u64,
    /// Number of periods by which a stretch is unfolded at most, one where none is.
    pub periods: f64,
    /// Whether a return is looked for.
    pub watching: bool,
    /// Set where the lane waits for its points to be evaluated in company.
    pub waits: Option<Wait>,
    /// The components without series at the start of the stretch.
    pub riders: [f64; RIDERS],
}

/// What a lane waits with.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wait {
    /// The period; `None` where the horizon ended before one was seen.
    pub period: Option<Period>,
    /// The step of the march after which the lane began to wait.
    pub since: usize,
    /// What the run's steps had left out by then.
    pub left_out: TruncationSums,
}

/// Number of components that have no series of their own.
pub(super) const RIDERS: usize = WITH_THRUST - WITH_ANGLES;

impl LaneState {
    /// The step up to which the lane waits for most of the others.
    pub(super) fn patience(&self, wait: &Wait) -> usize {
        wait.since + 2 + (wait.since - self.begun) / 4
    }

    /// The components without series `time` units into a stretch in which nothing acts.
    pub(super) fn riders_after<const N: usize, const J: usize>(&self, time: f64) -> [f64; RIDERS] {
        let mut riders = self.riders;
        if N >= WITH_THRUST {
            for i in 0..3 {
                let path = IMPULSE_INTEGRAL + i - J;
                riders[path] = time.mul_add(self.riders[IMPULSE + i - J], self.riders[path]);
            }
        }
        riders
    }
}

impl<S: Simd, R: Real, const N: usize, const J: usize, const FORCED: bool> Driver<'_, S, R, N, J, FORCED> {
    /// Puts the next run into `lane`, or empties it.
    #[inline(never)]
    pub(super) fn refill(&mut self, lane: usize) {
        for i in 0..N {
            self.state[i].set_lane(lane, 0.0);
            self.state_low[i].set_lane(lane, 0.0);
        }
        self.truncation.set(lane, TruncationSums::default());
        if self.next >= self.runs.len() {
            self.places[lane] = None;
            self.rest(lane);
            return;
        }
        let run = &self.runs[self.next];
        let unit = run.time_unit();
        self.constants.set_run(lane, run, unit);
        self.per_unit.set_lane(lane, 1.0 / unit);
        for i in 0..3 {
            self.state[OMEGA + i].set_lane(lane, run.omega_b[i] * unit);
        }
        if N >= WITH_ATTITUDE {
            for i in 0..4 {
                self.state[ATTITUDE + i].set_lane(lane, run.q_eb[i]);
            }
        }
        self.places[lane] = Some(LaneState {
            run: self.next,
            stretch: 0,
            unit,
            length: 0.0,
            point: 0,
            begun: self.clock,
            steps_before: 0,
            periods: 1.0,
            watching: false,
            waits: None,
            riders: [0.0; RIDERS],
        });
        self.next += 1;
        self.enter(lane, 0);
    }

    /// Lets `lane` run on without being heard of: empty, or waiting.
    pub(super) fn rest(&mut self, lane: usize) {
        self.length.set_lane(lane, f64::INFINITY);
        self.upcoming.set_lane(lane, f64::INFINITY);
        self.watch.set(lane, None);
    }

    /// Prepares `lane` for a stretch.
    #[inline(never)]
    pub(super) fn enter(&mut self, lane: usize, stretch: usize) {
        let Some(place) = &mut self.places[lane] else { return };
        let run = &self.runs[place.run];
        self.constants.set_stretch(lane, run, stretch, place.unit);
        let bounds = &run.stretches[stretch];
        place.stretch = stretch;
        place.length = (bounds.end - bounds.start) / place.unit;
        place.begun = self.clock;
        place.waits = None;
        place.watching = self.work.settings.periodic && !bounds.actuated;
        for i in J..N {
            place.riders[i - J] = self.state[i].lane(lane);
        }
        self.time.set_lane(lane, 0.0);
        self.time_low.set_lane(lane, 0.0);
        self.length.set_lane(lane, place.length);
        let section = if place.watching { self.section(lane) } else { None };
        self.watch.set(lane, section.as_ref());
        self.look_ahead(lane);
        // one that does not move at all has found its period with the first step
        self.alarm = self.clock + 1;
    }

    /// The section across the motion of omega in `lane` now.
    pub(super) fn section(&self, lane: usize) -> Option<PoincareSection> {
        let three = |v: &[R; 3]| [v[0].lane(lane), v[1].lane(lane), v[2].lane(lane)];
        let omega = [self.state[0].lane(lane), self.state[1].lane(lane), self.state[2].lane(lane)];
        let [x, y, z] = three(&self.constants.momentum);
        let linear = [y * omega[2] - z * omega[1], z * omega[0] - x * omega[2], x * omega[1] - y * omega[0]];
        let (ratio, inverse) = (three(&self.constants.ratio), three(&self.constants.inverse));
        let mut rate = [0.0; 3];
        for i in 0..3 {
            // not fused: this is not compiled for an instruction set
            rate[i] = ratio[i] * omega[(i + 1) % 3] * omega[(i + 2) % 3] + inverse[i] * linear[i];
        }
        PoincareSection::new(omega, rate)
    }

    /// Sets the time of the next observation point of the stretch in `lane`.
    pub(super) fn look_ahead(&mut self, lane: usize) {
        let Some(place) = &self.places[lane] else { return };
        let bounds = &self.runs[place.run].stretches[place.stretch];
        let last = place.stretch + 1 == self.runs[place.run].stretches.len();
        let upcoming = match self.grid.times().get(place.point) {
            Some(time) if !place.watching && (last || *time <= bounds.end) => (time - bounds.start) / place.unit,
            _ => f64::INFINITY,
        };
        self.upcoming.set_lane(lane, upcoming);
    }

    /// Lets `lane` wait for its points to be evaluated.
    pub(super) fn wait(&mut self, lane: usize, period: Option<Period>) {
        if let Some(place) = &mut self.places[lane] {
            if let Some(period) = &period {
                place.periods = place.periods.max(place.length / period.length[0]);
            }
            place.waits = Some(Wait { period, since: self.clock, left_out: self.truncation.left_out(lane) });
        }
        self.rest(lane);
    }

    /// Steps of the run so far.
    pub(super) fn steps(&self, place: &LaneState) -> u64 {
        let until = place.waits.map_or(self.clock, |wait| wait.since);
        place.steps_before + (until - place.begun) as u64
    }

    /// Goes on with the next stretch, or hands the run over and takes the next.
    pub(super) fn end_stretch(&mut self, lane: usize, finish: &mut CompletionCallback<'_>) {
        let Some(place) = self.places[lane] else { return };
        let steps = self.steps(&place);
        if let Some(wait) = &place.waits {
            // the lane has run on since
            self.truncation.set(lane, wait.left_out);
        }
        if place.stretch + 1 < self.runs[place.run].stretches.len() {
            if let Some(place) = &mut self.places[lane] {
                place.steps_before = steps;
            }
            self.enter(lane, place.stretch + 1);
            return;
        }
        let outcome = Outcome {
            status: Status::Done,
            time: self.grid.duration(),
            points: self.grid.points(),
            effort: StepStatistics { steps, rejected: 0, evaluations: steps },
            local_errors: self.truncation.left_out(lane).errors(steps, place.periods),
        };
        let trajectory = &mut self.work.trajectories[lane];
        trajectory.pad();
        finish(place.run, trajectory, &outcome);
        self.refill(lane);
    }

    /// Hands a run over that cannot go on.
    #[cold]
    pub(super) fn fail(&mut self, lane: usize, status: Status, finish: &mut CompletionCallback<'_>) {
        let Some(place) = self.places[lane] else { return };
        let steps = self.steps(&place);
        let segment = &self.work.ring[(self.clock - 1) % self.work.ring.len()];
        let reached = if status == Status::NonFinite { segment.start.lane(lane) } else { self.time.lane(lane) };
        self.time.set_lane(lane, reached);
        if place.watching {
            self.evaluate_kept(lane, false);
        }
        let points = self.places[lane].map_or(place.point, |place| place.point);
        let bounds = &self.runs[place.run].stretches[place.stretch];
        let outcome = Outcome {
            status,
            time: reached.mul_add(place.unit, bounds.start),
            points,
            effort: StepStatistics { steps, rejected: 0, evaluations: steps },
            local_errors: self.truncation.left_out(lane).errors(steps, place.periods),
        };
        let trajectory = &mut self.work.trajectories[lane];
        trajectory.fill_after(points, f64::NAN);
        finish(place.run, trajectory, &outcome);
        self.refill(lane);
    }

    /// More memory for a long period, or no longer looking for it.
    #[cold]
    pub(super) fn make_room(&mut self, lane: usize) {
        if self.work.grow_ring(self.time.zero(), self.clock) {
            return;
        }
        self.evaluate_kept(lane, false);
        if let Some(place) = &mut self.places[lane] {
            place.watching = false;
        }
        self.watch.set(lane, None);
        self.look_ahead(lane);
    }
}
