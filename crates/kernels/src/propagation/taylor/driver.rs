//! [`integrate`]: runs in lanes, each with its own step, arc, period and end.
//!
//! A step is a few vector operations for all lanes; a single lane is examined only at an observation point, a return of
//! omega, the end of an arc or a failure.

use fearless_simd::Simd;

use super::dense::values;
use super::jet::{expand, turn_impulse};
use super::lanes::{RunCallback, RunLanes};
use super::period_folding::{PeriodFolding, folded_lanes, is_due};
use super::period_search::{period, return_time};
use super::points::{StepSeries, TakenStep, Until};
use super::thrust::Push;
use super::workspace::Workspace;
use crate::dynamics::effects::within_arcs::WithinArcs;
use crate::dynamics::gyrostat::{ANGLE, ANGULAR_IMPULSE, ATTITUDE, Gyrostat, OMEGA, WITH_THRUST};
use crate::math::sums::{fast_two_sum, two_sum};
use crate::math::vector::{four, lane_of, scaled, three};
use crate::math::{Mask, Real};
use crate::propagation::arc_source::ArcSource;
use crate::run::{Grid, Status};

/// Integrates `runs` over `grid` and calls `finish` for each in order of completion. `N` components are integrated, the
/// first `J` by series of their own.
#[inline(always)]
pub fn integrate<'a, S: Simd, R: Real, E: WithinArcs<R>, const N: usize, const J: usize, const FORCED: bool>(
    simd: S,
    zero: R,
    runs: &'a mut [Gyrostat<f64>],
    arcs: ArcSource<'a>,
    grid: &'a Grid,
    workspace: &'a mut Workspace<R, J>,
    finish: &mut RunCallback<'_>,
) {
    let mut lanes = RunLanes::<S, R, E, N, J>::new(simd, zero, runs, arcs, grid, workspace);
    for lane in 0..R::LANES {
        lanes.load_lane(lane);
    }
    while lanes.states[..R::LANES].iter().any(Option::is_some) {
        lanes.step::<FORCED>(finish);
    }
}

impl<S: Simd, R: Real, E: WithinArcs<R>, const N: usize, const J: usize> RunLanes<'_, S, R, E, N, J> {
    #[inline(always)]
    fn step<const FORCED: bool>(&mut self, finish: &mut RunCallback<'_>) {
        let has_begun = FORCED && core::mem::take(&mut self.has_begun);
        let RunLanes { vectors, work, truncation, effects, .. } = self;
        let zero = vectors.time.zero();
        let infinite = zero.splat(f64::INFINITY);
        let mut constants = vectors.constants;
        if FORCED {
            for i in 0..3 {
                constants.momentum[i] = constants.momentum_rate[i].mul_add(vectors.time, constants.momentum[i]);
            }
            constants.motor_power = constants.motor_power_rate.mul_add(vectors.time, constants.motor_power);
        }
        let begin = vectors.state;
        let segment = work.ring.current();
        for i in 0..J {
            segment.jet[0][i] = vectors.state[i];
        }
        segment.start = vectors.time;
        segment.start_low = vectors.time_low;
        let full = work.rule.order;
        // the bound of the torque holds for constant torques only
        let brief = if has_begun && !E::ACT {
            work.brief.orders(&constants, three(&begin, OMEGA), vectors.length, vectors.time, vectors.may_be_brief)
        } else {
            None
        };
        let order = brief.as_ref().map_or(full, |brief| brief.most);
        let unit = zero.splat(1.0) / vectors.per_unit;
        let (now, low) = two_sum(constants.start, vectors.time);
        let effects = effects.series([now * unit, (low + vectors.time_low) * unit], unit, &mut work.effects);
        expand::<R, J, FORCED>(&constants, &work.reciprocals, order, &mut work.scratch, effects, &mut segment.jet);
        let left = (vectors.length - vectors.time) - vectors.time_low;
        let mut length = zero;
        if order == full {
            let mut start = constants;
            if E::ACT {
                start.torque = work.effects.torque()[0];
            }
            let alpha = if FORCED { Some(start.torque_acceleration()) } else { None };
            let mut proposed = work.rule.step(&segment.jet, alpha);
            if E::ACT {
                proposed = proposed.smaller(work.rule.step_of_impulse(&segment.jet));
                if work.effects.motion.may_leave() {
                    proposed = proposed.smaller(work.rule.step_of_offset(&segment.jet, constants.mass));
                }
            }
            length = R::select(left.lt(proposed), left, proposed);
        }
        if let Some(brief) = &brief {
            brief.truncate(&mut segment.jet);
            if brief.is_mixed(full) {
                truncation.add(&segment.jet, R::select(brief.lanes, zero, length));
            }
            length = R::select(brief.lanes, left, length);
            truncation.add_brief(&segment.jet, length, brief);
        } else if E::ACT {
            truncation.add_directed(&segment.jet, length, &constants);
        } else {
            truncation.add(&segment.jet, length);
        }
        // the increment first, then the state with its carry
        let [mut slope] = values(&segment.jet[1..=order], [length]);
        for i in 0..J {
            if E::ACT && i == ANGULAR_IMPULSE {
                turn_impulse(four(&vectors.state, ATTITUDE), &mut slope);
            }
            let increment = slope[i].mul_add(length, vectors.state_low[i]);
            (vectors.state[i], vectors.state_low[i]) = fast_two_sum(vectors.state[i], increment);
        }
        let mut push = Push::none(zero);
        if FORCED {
            if N >= WITH_THRUST && N > J {
                push = work.quadrature.over_step(&constants, &segment.jet[..=order], length);
            }
            let turned = scaled(length, three(&slope, ANGLE));
            let growth = push.growth(&constants, &begin, turned, length);
            for i in J..N {
                (vectors.state[i], vectors.state_low[i]) = two_sum(vectors.state[i], growth[i] + vectors.state_low[i]);
            }
        }
        let (time, error) = fast_two_sum(vectors.time, length + vectors.time_low);
        (vectors.time, vectors.time_low) = (time, error);
        work.ring.clock += 1;

        let omega = three(&vectors.state, OMEGA);
        let size = omega[0].abs() + omega[1].abs() + omega[2].abs();
        let finite = size.lt(infinite);
        let left = (vectors.length - vectors.time) - vectors.time_low;
        let continues = zero.lt(left);
        let covered = R::select(finite, R::select(continues, time, infinite), -infinite);
        let taken = TakenStep { constants, begin, order, length, push };
        while self.vectors.next_point.lt(covered).any() {
            self.observe::<FORCED>(&taken, covered);
        }

        let back = self.detector.passes(omega);
        let stuck = length.lt(time * zero.splat(f64::EPSILON * f64::EPSILON));
        let calm = finite & continues & !(stuck | back);
        if (!calm).any() || self.work.ring.clock >= self.alarm {
            self.examine(calm, back, length, finish);
        }
    }

    /// Evaluates the next observation point of every lane that has one before `covered`.
    #[inline(always)]
    fn observe<const FORCED: bool>(&mut self, step: &TakenStep<R, N>, covered: R) {
        let RunLanes { vectors, work, .. } = self;
        let due = vectors.next_point.lt(covered);
        let Workspace { ring, quadrature, .. } = &mut **work;
        let mut series = StepSeries { segment: ring.last(), step, quadrature, per_unit: vectors.per_unit };
        let rows = series.components::<FORCED>(vectors.next_point, due);
        self.write_points(&rows, due);
    }

    /// Examines the lanes that are not `calm`; at an alarm all of them.
    #[inline(never)]
    fn examine(&mut self, calm: R::Mask, back: R::Mask, length: R, finish: &mut RunCallback<'_>) {
        self.simd.vectorize(
            #[inline(always)]
            || self.examine_lanes(calm, back, length, finish),
        );
    }

    #[inline(always)]
    fn examine_lanes(&mut self, calm: R::Mask, back: R::Mask, length: R, finish: &mut RunCallback<'_>) {
        let all = self.work.ring.clock >= self.alarm;
        for lane in 0..R::LANES {
            if all || !calm.test(lane) {
                self.examine_lane(lane, back.test(lane), length.lane(lane), finish);
            }
        }
        if is_due(&self.states, self.work.ring.clock, self.work.ring.len()) {
            self.fold(finish);
        }
        let clock = self.work.ring.clock;
        let mut occupied = self.states.iter().flatten();
        if clock > 0 && occupied.all(|state| state.begun == clock && state.steps_before == 0) {
            // all lanes have just been loaded: restart the ring to keep its memory small
            self.work.ring.clock = 0;
            self.states.iter_mut().flatten().for_each(|state| state.begun = 0);
        }
        self.set_alarm();
    }

    fn set_alarm(&mut self) {
        let RunLanes { work, states, .. } = &*self;
        let (clock, kept) = (work.ring.clock, work.ring.len());
        let mut alarm = usize::MAX;
        for state in states.iter().flatten() {
            let given_up = state.judged(clock, work.settings.max_steps);
            let at = match state.waiting {
                Some(waiting) => state.patience(&waiting).min(state.begun + kept),
                // a body at rest has its period after the first step
                None if state.is_searching && state.begun == clock => clock + 1,
                None if state.is_searching => state.begun + kept,
                None => usize::MAX,
            };
            alarm = alarm.min(at).min(usize::try_from(given_up).unwrap_or(usize::MAX));
        }
        self.alarm = alarm.max(clock + 1);
    }

    /// Handles a lane after a step: folding by a period, end of an arc or a run.
    #[inline(always)]
    fn examine_lane(&mut self, lane: usize, back: bool, length: f64, finish: &mut RunCallback<'_>) {
        let Some(state) = self.states[lane] else { return };
        if state.waiting.is_some() {
            return;
        }
        let omega = self.vectors.omega(lane);
        if !(omega[0].is_finite() && omega[1].is_finite() && omega[2].is_finite()) {
            self.fail(lane, Status::NonFinite, finish);
            return;
        }
        let time = self.vectors.time.lane(lane);
        let left = (state.length - time) - self.vectors.time_low.lane(lane);
        let (ring, settings) = (&self.work.ring, &self.work.settings);
        if state.is_searching
            && left > 0.0
            && let Some(within) = return_time(&self.detector.section(lane), self.work, &state, lane, back, length)
            && let Some(period) = {
                let momentum_b = lane_of(&self.vectors.constants.momentum, lane);
                period(&self.runs[state.run], ring, &state, lane, within, momentum_b)
            }
        {
            self.wait(lane, Some(period));
        } else if left <= 0.0 {
            if state.is_searching && state.is_last {
                self.wait(lane, None);
                return;
            }
            if state.is_searching {
                // the next arc starts from the state at the end of this one
                self.evaluate_kept(lane, Until::EndOfArc);
            }
            self.end_arc(lane, finish);
        } else if state.gives_up(ring.clock, time, settings.max_steps) {
            self.fail(lane, Status::StepLimit, finish);
        } else if length <= f64::EPSILON * time * f64::EPSILON {
            self.fail(lane, Status::StepFloor, finish);
        } else if state.is_searching && ring.clock - state.begun >= ring.len() {
            self.keep_more_series(lane);
        }
    }

    /// Evaluates all points of the waiting lanes' arcs and continues those lanes.
    #[inline(never)]
    fn fold(&mut self, finish: &mut RunCallback<'_>) {
        let simd = self.simd;
        let RunLanes { states, grid, work, vectors, .. } = self;
        let folded = folded_lanes(states, grid);
        let Workspace { ring, folds, trajectories, .. } = &mut **work;
        let mut folding = PeriodFolding::<S, R, J> { simd, grid, ring, folds, trajectories };
        folding.evaluate(&folded);
        for share in folded.iter().flatten() {
            if N > J {
                simd.vectorize(
                    #[inline(always)]
                    || folding.fill_quadratures::<N>(share),
                );
            }
            if let Some(state) = &mut states[share.lane] {
                state.point += share.points;
            }
            if !share.state.is_last
                && let Some(period) = &share.period
            {
                let end = simd.vectorize(
                    #[inline(always)]
                    || folding.state_at_end::<N>(share, period),
                );
                vectors.set_state(share.lane, &end);
            }
        }
        for share in folded.iter().flatten() {
            self.end_arc(share.lane, finish);
        }
    }
}
