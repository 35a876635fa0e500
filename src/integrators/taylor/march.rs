//! The lanes: runs side by side, each with its own step, stretch, period and end.
//!
//! A step is the same few vector operations for all lanes; a lane by itself is looked at only when something happens to it:
//! an observation point passed, omega came back to where it started, a stretch ended, or something went wrong.
#![expect(clippy::needless_range_loop, reason = "components are numbered alike in several arrays")]

use fearless_simd::Simd;

use super::dense::{value_at, values};
use super::jet::expand;
use super::period::{Period, Section};
use super::thrust::angle_of;
use super::truncation::{LeftOut, Truncation};
use super::watch::Watch;
use super::workspace::Workspace;
use crate::dynamics::gyrostat::equations::Constants;
use crate::dynamics::gyrostat::{
    ANGLE, ANGULAR_IMPULSE, ATTITUDE, Gyrostat, IMPULSE, IMPULSE_INTEGRAL, MOTOR_WORK, OMEGA, THRUST_WORK, WITH_ANGLES,
    WITH_ATTITUDE, WITH_MOTORS, WITH_THRUST,
};
use crate::dynamics::outcome::{Effort, Outcome, Status};
use crate::dynamics::table::{Grid, Trajectory};
use crate::math::Real;
use crate::math::lanes::WIDEST;
use crate::math::vector::{dcm_from_quaternion, product};

/// Hands over a run: its index, its components at the points, how it ended.
pub(super) type Finish<'a> = dyn FnMut(usize, &mut Trajectory, &Outcome) + 'a;

/// One lane's place in its run.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
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
    pub left_out: LeftOut,
}

/// Number of components that have no series of their own.
pub(super) const RIDERS: usize = WITH_THRUST - WITH_ANGLES;

/// Marches `runs` over `grid`; `finish` is called once for each, with its index and its components at the points.
///
/// `N` components are integrated, of which the first `J` by series of their own. Every result is a function of the run alone:
/// lanes share no decision.
#[inline(always)]
pub fn march<S: Simd, R: Real, const N: usize, const J: usize, const FORCED: bool>(
    simd: S,
    zero: R,
    runs: &[Gyrostat<f64>],
    grid: &Grid,
    workspace: &mut Workspace<R, J>,
    finish: &mut Finish<'_>,
) {
    let mut lanes = March::<S, R, N, J, FORCED> {
        simd,
        runs,
        grid,
        next: 0,
        constants: Constants::zero(zero),
        state: [zero; N],
        state_low: [zero; N],
        time: zero,
        time_low: zero,
        length: zero,
        upcoming: zero,
        per_unit: zero,
        watch: Watch::none(zero),
        truncation: Truncation::new(zero, workspace.rule.order),
        places: [None; WIDEST],
        clock: 0,
        alarm: 0,
        work: workspace,
    };
    for lane in 0..R::LANES {
        lanes.refill(lane);
    }
    while lanes.places[..R::LANES].iter().any(Option::is_some) {
        lanes.step(finish);
    }
}

/// The march while it runs.
pub(super) struct March<'a, S, R, const N: usize, const J: usize, const FORCED: bool> {
    pub simd: S,
    pub runs: &'a [Gyrostat<f64>],
    pub grid: &'a Grid,
    /// The next run that waits for a lane.
    next: usize,
    constants: Constants<R>,
    pub state: [R; N],
    pub state_low: [R; N],
    /// Time since the start of the stretch, units, as an unevaluated sum.
    time: R,
    time_low: R,
    /// Length of the stretch, units; infinite where the lane is empty or waits.
    length: R,
    /// Time of the next observation point of the stretch, units; infinite where there is none or the lane is watched.
    upcoming: R,
    /// One over the unit of time, 1/s.
    per_unit: R,
    watch: Watch<R>,
    /// What the steps of each lane's run left out.
    truncation: Truncation<R>,
    pub places: [Option<Place>; WIDEST],
    /// Steps of the march; step k lies in slot k modulo the ring's length.
    pub clock: usize,
    /// The step at which some lane is to be looked at, whatever happens.
    alarm: usize,
    pub work: &'a mut Workspace<R, J>,
}

impl<S: Simd, R: Real, const N: usize, const J: usize, const FORCED: bool> March<'_, S, R, N, J, FORCED> {
    /// Puts the next run into `lane`, or empties it.
    #[inline(never)]
    pub(super) fn refill(&mut self, lane: usize) {
        for i in 0..N {
            self.state[i].set_lane(lane, 0.0);
            self.state_low[i].set_lane(lane, 0.0);
        }
        self.truncation.set(lane, LeftOut::default());
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
        self.places[lane] = Some(Place {
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
    fn section(&self, lane: usize) -> Option<Section> {
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
        Section::new(omega, rate)
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

    /// One step of every lane.
    #[inline(always)]
    fn step(&mut self, finish: &mut Finish<'_>) {
        let slot = self.clock % self.work.ring.len();
        let zero = self.time.zero();
        let (one, infinite) = (zero.splat(1.0), zero.splat(f64::INFINITY));
        let mut constants = self.constants;
        if FORCED {
            for i in 0..3 {
                constants.momentum[i] = constants.momentum_rate[i].mul_add(self.time, constants.momentum[i]);
            }
            constants.motor_power = constants.motor_power_rate.mul_add(self.time, constants.motor_power);
        }
        let begin = self.state;
        let segment = &mut self.work.ring[slot];
        for i in 0..J {
            segment.jet[0][i] = self.state[i];
        }
        segment.start = self.time;
        segment.start_low = self.time_low;
        let order = self.work.rule.order;
        expand::<R, J, FORCED>(&constants, &self.work.reciprocals, order, &mut self.work.scratch, &mut segment.jet);
        let wanted = self.work.rule.step(&segment.jet);
        let left = (self.length - self.time) - self.time_low;
        let length = R::select(left.lt(wanted), left, wanted);
        self.truncation.add(&segment.jet, length);
        // the increment first, then the state with its carry
        let [slope] = values(&segment.jet[1..=order], [length]);
        for i in 0..J {
            let increment = slope[i].mul_add(length, self.state_low[i]);
            (self.state[i], self.state_low[i]) = fast_two_sum(self.state[i], increment);
        }
        if FORCED {
            let turned = [slope[ANGLE] * length, slope[ANGLE + 1] * length, slope[ANGLE + 2] * length];
            let grown = self.work.quadrature.growth(&constants, &segment.jet, &begin, turned, length);
            for i in J..N {
                (self.state[i], self.state_low[i]) = two_sum(self.state[i], grown[i] + self.state_low[i]);
            }
        }
        let (time, error) = fast_two_sum(self.time, length + self.time_low);
        (self.time, self.time_low) = (time, error);
        self.clock += 1;

        let omega = [self.state[0], self.state[1], self.state[2]];
        let size = omega[0].abs() + omega[1].abs() + omega[2].abs();
        let finite = size.lt(infinite);
        let left = (self.length - self.time) - self.time_low;
        let goes_on = zero.lt(left);
        let covered = R::select(finite, R::select(goes_on, time, infinite), -infinite);
        while R::any(self.upcoming.lt(covered)) {
            self.observe(slot, &constants, &begin, covered);
        }

        let back = self.watch.passes(omega);
        let stuck = length.lt(time * zero.splat(f64::EPSILON * f64::EPSILON));
        let calm = R::select(finite, R::select(goes_on, R::select(stuck, zero, one), zero), zero) - back;
        if R::any(calm.lt(one)) || self.clock >= self.alarm {
            self.attend(calm, back, length, finish);
        }
    }

    /// Evaluates the next observation point of every lane that has one before `covered`.
    #[inline(always)]
    fn observe(&mut self, slot: usize, constants: &Constants<R>, begin: &[R; N], covered: R) {
        let zero = covered.zero();
        let segment = &self.work.ring[slot];
        let due = self.upcoming.lt(covered);
        let x = R::select(due, (self.upcoming - segment.start) - segment.start_low, zero);
        let [at] = values(&segment.jet, [x]);
        let mut all = [zero; N];
        all[..J].copy_from_slice(&at);
        if FORCED {
            let mut turned = angle_of(&at);
            for i in 0..3 {
                turned[i] = turned[i] - segment.jet[0][ANGLE + i];
            }
            let grown = self.work.quadrature.growth(constants, &segment.jet, begin, turned, x);
            for i in J..N {
                all[i] = begin[i] + grown[i];
            }
        }
        let factors = factors::<R, N>(self.per_unit);
        let mut rows = [[0.0; WIDEST]; N];
        for i in 0..N {
            (all[i] * factors[i]).write(&mut rows[i]);
        }
        let flags = R::select(due, zero.splat(1.0), zero);
        for lane in 0..R::LANES {
            if flags.lane(lane) == 0.0 {
                continue;
            }
            let Some(place) = &mut self.places[lane] else { continue };
            let point = place.point;
            place.point += 1;
            for i in 0..N {
                self.work.trajectories[lane].column_mut(i)[point] = rows[i][lane];
            }
            self.look_ahead(lane);
        }
    }

    /// Looks at the lanes to which something happened: those where `calm` is not one, and all where it is time.
    #[inline(never)]
    fn attend(&mut self, calm: R, back: R, length: R, finish: &mut Finish<'_>) {
        self.simd.vectorize(
            #[inline(always)]
            || self.attend_now(calm, back, length, finish),
        );
    }

    #[inline(always)]
    fn attend_now(&mut self, calm: R, back: R, length: R, finish: &mut Finish<'_>) {
        let all = self.clock >= self.alarm;
        for lane in 0..R::LANES {
            if all || calm.lane(lane) < 1.0 {
                self.attend_lane(lane, back.lane(lane) > 0.0, length.lane(lane), finish);
            }
        }
        if self.should_fold() {
            self.fold(finish);
        }
        let occupied = || self.places.iter().flatten();
        if self.clock > 0 && occupied().all(|place| place.begun == self.clock && place.steps_before == 0) {
            // all lanes start afresh: so does the ring, and the memory that it touches stays small
            self.clock = 0;
            self.places.iter_mut().flatten().for_each(|place| place.begun = 0);
        }
        self.set_alarm();
    }

    /// The step at which a lane is to be looked at at the latest.
    fn set_alarm(&mut self) {
        let ring = self.work.ring.len();
        let most = self.work.settings.max_steps;
        let mut alarm = usize::MAX;
        for place in self.places.iter().flatten() {
            let given_up = place.begun as u64 + most.saturating_sub(place.steps_before);
            let at = match place.waits {
                Some(wait) => place.patience(&wait).min(place.begun + ring),
                // one that does not move at all has its period after the first step
                None if place.watching && place.begun == self.clock => self.clock + 1,
                None if place.watching => place.begun + ring,
                None => usize::MAX,
            };
            alarm = alarm.min(at).min(usize::try_from(given_up).unwrap_or(usize::MAX));
        }
        self.alarm = alarm.max(self.clock + 1);
    }

    /// What a lane does after a step: fold by a period, end a stretch or a run.
    #[inline(always)]
    fn attend_lane(&mut self, lane: usize, back: bool, length: f64, finish: &mut Finish<'_>) {
        let Some(place) = self.places[lane] else { return };
        if place.waits.is_some() {
            return;
        }
        let omega = [self.state[0].lane(lane), self.state[1].lane(lane), self.state[2].lane(lane)];
        if !(omega[0].is_finite() && omega[1].is_finite() && omega[2].is_finite()) {
            self.fail(lane, Status::NonFinite, finish);
            return;
        }
        let time = self.time.lane(lane);
        let left = (place.length - time) - self.time_low.lane(lane);
        if place.watching
            && left > 0.0
            && let Some(within) = self.comes_back(lane, back, length)
            && let Some(period) = self.period(lane, within)
        {
            self.wait(lane, Some(period));
        } else if left <= 0.0 {
            if place.watching && place.stretch + 1 == self.runs[place.run].stretches.len() {
                self.wait(lane, None);
                return;
            }
            if place.watching {
                // the state at the end is wanted now
                self.evaluate_kept(lane, true);
            }
            self.end_stretch(lane, finish);
        } else if self.steps(&place) >= self.work.settings.max_steps {
            self.fail(lane, Status::StepLimit, finish);
        } else if length <= f64::EPSILON * time * f64::EPSILON {
            self.fail(lane, Status::StepFloor, finish);
        } else if place.watching && self.clock - place.begun >= self.work.ring.len() {
            self.make_room(lane);
        }
    }

    /// Lets `lane` wait for its points to be evaluated.
    fn wait(&mut self, lane: usize, period: Option<Period>) {
        if let Some(place) = &mut self.places[lane] {
            if let Some(period) = &period {
                place.periods = place.periods.max(place.length / period.length[0]);
            }
            place.waits = Some(Wait { period, since: self.clock, left_out: self.truncation.left_out(lane) });
        }
        self.rest(lane);
    }

    /// Steps of the run so far.
    pub(super) fn steps(&self, place: &Place) -> u64 {
        let until = place.waits.map_or(self.clock, |wait| wait.since);
        place.steps_before + (until - place.begun) as u64
    }

    /// The time within the last step at which omega in `lane` is where the stretch began.
    #[inline(always)]
    fn comes_back(&self, lane: usize, back: bool, length: f64) -> Option<f64> {
        let place = self.places[lane]?;
        let jet = &self.work.ring[(self.clock - 1) % self.work.ring.len()].jet;
        let section = self.watch.section(lane);
        if section.direction == [0.0; 3] {
            // omega does not move: any time is a period
            return (self.clock - place.begun == 1).then_some(length);
        }
        if !back {
            return None;
        }
        section.crossing(jet, lane, self.work.rule.order, length, self.work.settings.tolerance)
    }

    /// The period of the stretch in `lane`, of which the last step comes back after `within` units.
    #[inline(always)]
    fn period(&self, lane: usize, within: f64) -> Option<Period> {
        let place = self.places[lane]?;
        let ring = &self.work.ring;
        let segment = &ring[(self.clock - 1) % ring.len()];
        let start = segment.start.lane(lane);
        let sum = start + within;
        let length = [sum, (within - (sum - start)) + segment.start_low.lane(lane)];
        if N < WITH_ATTITUDE {
            return Some(Period { length, half_turns: 0.0, axis_e: [0.0; 3] });
        }
        let run = &self.runs[place.run];
        let first = &ring[place.begun % ring.len()].jet[0];
        let (mut start, mut end) = ([0.0; 4], [0.0; 4]);
        for i in 0..4 {
            start[i] = first[ATTITUDE + i].lane(lane);
            end[i] = value_at(&segment.jet, ATTITUDE + i, lane, within);
        }
        let mut momentum_b = [0.0; 3];
        let mut scale = 0.0_f64;
        for i in 0..3 {
            let own = run.moments[i] * first[OMEGA + i].lane(lane);
            momentum_b[i] = own + self.constants.momentum[i].lane(lane);
            scale = scale.max(own.abs());
        }
        Period::new(length, start, end, product(dcm_from_quaternion(start), momentum_b), scale)
    }

    /// Goes on with the next stretch, or hands the run over and takes the next.
    pub(super) fn end_stretch(&mut self, lane: usize, finish: &mut Finish<'_>) {
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
            effort: Effort { steps, rejected: 0, evaluations: steps },
            local_errors: self.truncation.left_out(lane).errors(steps, place.periods),
        };
        let trajectory = &mut self.work.trajectories[lane];
        trajectory.pad();
        finish(place.run, trajectory, &outcome);
        self.refill(lane);
    }

    /// Hands a run over that cannot go on.
    #[cold]
    fn fail(&mut self, lane: usize, status: Status, finish: &mut Finish<'_>) {
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
            effort: Effort { steps, rejected: 0, evaluations: steps },
            local_errors: self.truncation.left_out(lane).errors(steps, place.periods),
        };
        let trajectory = &mut self.work.trajectories[lane];
        trajectory.fill_after(points, f64::NAN);
        finish(place.run, trajectory, &outcome);
        self.refill(lane);
    }

    /// More memory for a long period, or no longer looking for it.
    #[cold]
    fn make_room(&mut self, lane: usize) {
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

    /// Evaluates the points of a watched stretch one by one from the series that were kept: those before the present time,
    /// or all of the stretch where it is the `whole`.
    #[cold]
    #[inline(never)]
    fn evaluate_kept(&mut self, lane: usize, whole: bool) {
        let Some(mut place) = self.places[lane] else { return };
        let ring = &self.work.ring;
        let run = &self.runs[place.run];
        let bounds = &run.stretches[place.stretch];
        let last = place.stretch + 1 == run.stretches.len();
        let reached = self.time.lane(lane);
        let mut step = place.begun;
        while let Some(time) = self.grid.times().get(place.point) {
            let local = (time - bounds.start) / place.unit;
            if if whole { !last && *time > bounds.end } else { local >= reached } {
                break;
            }
            while step + 1 < self.clock && ring[(step + 1) % ring.len()].start.lane(lane) <= local {
                step += 1;
            }
            let segment = &ring[step % ring.len()];
            let x = (local - segment.start.lane(lane)) - segment.start_low.lane(lane);
            let factors = factors::<f64, N>(1.0 / place.unit);
            let trajectory = &mut self.work.trajectories[lane];
            for i in 0..J {
                trajectory.column_mut(i)[place.point] = value_at(&segment.jet, i, lane, x) * factors[i];
            }
            let riders = place.riders_after::<N, J>(local);
            for i in J..N {
                trajectory.column_mut(i)[place.point] = riders[i - J] * factors[i];
            }
            place.point += 1;
        }
        self.places[lane] = Some(place);
    }
}

impl Place {
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

/// What turns a component in the lane's unit of time into SI, given one over the unit.
#[inline(always)]
pub(super) fn factors<R: Real, const N: usize>(per_unit: R) -> [R; N] {
    let mut factors = [per_unit.splat(1.0); N];
    factors[OMEGA..OMEGA + 3].fill(per_unit);
    if N >= WITH_MOTORS {
        factors[MOTOR_WORK] = per_unit * per_unit;
    }
    if N >= WITH_THRUST {
        factors[IMPULSE..IMPULSE + 3].fill(per_unit);
        factors[ANGULAR_IMPULSE..ANGULAR_IMPULSE + 3].fill(per_unit);
        factors[THRUST_WORK] = per_unit * per_unit;
    }
    factors
}

/// The sum and its rounding error, for |a| >= |b| or a = 0 (T. J. Dekker, Numerische Mathematik 18, 1971).
#[inline(always)]
fn fast_two_sum<R: Real>(a: R, b: R) -> (R, R) {
    let sum = a + b;
    (sum, b - (sum - a))
}

/// The sum and its rounding error, whichever is larger (D. E. Knuth, *The Art of Computer Programming*, vol. 2, 4.2.2).
#[inline(always)]
fn two_sum<R: Real>(a: R, b: R) -> (R, R) {
    let sum = a + b;
    let other = sum - a;
    (sum, (a - (sum - other)) + (b - other))
}
