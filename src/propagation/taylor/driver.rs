//! The lanes: runs side by side, each with its own step, stretch, period and end.
//!
//! A step is the same few vector operations for all lanes; a lane by itself is looked at only when something happens to it:
//! an observation point passed, omega came back to where it started, a stretch ended, or something went wrong.
#![expect(clippy::needless_range_loop, reason = "components are numbered alike in several arrays")]

use fearless_simd::Simd;

use super::dense::{value_at, values};
use super::jet::expand;
use super::lane_state::LaneState;
use super::period::Period;
use super::return_detector::ReturnDetector;
use super::truncation::Truncation;
use super::workspace::Workspace;
use crate::dynamics::gyrostat::equations::Constants;
use crate::dynamics::gyrostat::{ANGLE, ATTITUDE, Gyrostat, OMEGA, WITH_ATTITUDE};
use crate::math::lanes::WIDEST;
use crate::math::sums::{fast_two_sum, two_sum};
use crate::math::vector::{dcm_from_quaternion, product};
use crate::math::{Mask, Real};
use crate::run::{Grid, Trajectory};
use crate::run::{Outcome, Status};

/// Hands over a run: its index, its components at the points, how it ended.
pub(super) type CompletionCallback<'a> = dyn FnMut(usize, &mut Trajectory, &Outcome) + 'a;

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
    finish: &mut CompletionCallback<'_>,
) {
    let mut lanes = Driver::<S, R, N, J, FORCED> {
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
        watch: ReturnDetector::none(zero),
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
pub(super) struct Driver<'a, S, R, const N: usize, const J: usize, const FORCED: bool> {
    pub simd: S,
    pub runs: &'a [Gyrostat<f64>],
    pub grid: &'a Grid,
    /// The next run that waits for a lane.
    pub next: usize,
    pub constants: Constants<R>,
    pub state: [R; N],
    pub state_low: [R; N],
    /// Time since the start of the stretch, units, as an unevaluated sum.
    pub time: R,
    pub time_low: R,
    /// Length of the stretch, units; infinite where the lane is empty or waits.
    pub length: R,
    /// Time of the next observation point of the stretch, units; infinite where there is none or the lane is watched.
    pub upcoming: R,
    /// One over the unit of time, 1/s.
    pub per_unit: R,
    pub watch: ReturnDetector<R>,
    /// What the steps of each lane's run left out.
    pub truncation: Truncation<R>,
    pub places: [Option<LaneState>; WIDEST],
    /// Steps of the march; step k lies in slot k modulo the ring's length.
    pub clock: usize,
    /// The step at which some lane is to be looked at, whatever happens.
    pub alarm: usize,
    pub work: &'a mut Workspace<R, J>,
}

impl<S: Simd, R: Real, const N: usize, const J: usize, const FORCED: bool> Driver<'_, S, R, N, J, FORCED> {
    /// One step of every lane.
    #[inline(always)]
    fn step(&mut self, finish: &mut CompletionCallback<'_>) {
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
        while self.upcoming.lt(covered).any() {
            self.observe(slot, &constants, &begin, covered);
        }

        let back = self.watch.passes(omega);
        let stuck = length.lt(time * zero.splat(f64::EPSILON * f64::EPSILON));
        let calm = R::select(finite, R::select(goes_on, R::select(stuck, zero, one), zero), zero) - back;
        if calm.lt(one).any() || self.clock >= self.alarm {
            self.attend(calm, back, length, finish);
        }
    }

    /// Looks at the lanes to which something happened: those where `calm` is not one, and all where it is time.
    #[inline(never)]
    fn attend(&mut self, calm: R, back: R, length: R, finish: &mut CompletionCallback<'_>) {
        self.simd.vectorize(
            #[inline(always)]
            || self.attend_now(calm, back, length, finish),
        );
    }

    #[inline(always)]
    fn attend_now(&mut self, calm: R, back: R, length: R, finish: &mut CompletionCallback<'_>) {
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
    fn attend_lane(&mut self, lane: usize, back: bool, length: f64, finish: &mut CompletionCallback<'_>) {
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
}
