//! [`Fixed`]: one-step methods with fixed steps.
//!
//! An arc of length l has ceil(l / step) equal steps. A shorter step from the same start reaches a point inside a step,
//! with the accuracy and invariants of the method, unlike interpolation.

use super::error_model::{ErrorModel, Remainder};
use super::explicit::{Carried, Step};
use super::step_control::Control;
use super::stepper::{Attempt, LaneMethod, Proposal, Stepper, StepperLane};
use super::system::{System, Tolerance};
use crate::math::real::Real;

/// Steps per arc by default.
const DEFAULT_STEPS: f64 = 1000.0;

/// Relative excess of l / step over an integer that counts as rounding of decimal fractions.
const WHOLE: f64 = 4.0 * f64::EPSILON;

/// Result of a step.
pub struct Advance<R> {
    /// Zero if it is sound, else NaN.
    pub poison: R,
    /// Evaluations of the right-hand side.
    pub evaluations: R,
}

/// A one-step method for steps of given length. The end of a step is written to `end`: returning a large state would
/// copy it.
pub trait FixedStep: Copy {
    /// Error of its steps.
    const REMAINDER: Remainder;

    /// Data for the next step and for points inside.
    type Memory<R: Real, const N: usize>;

    /// Memory before the first step.
    fn memory<R: Real, const N: usize>(zero: R) -> Self::Memory<R, N>;

    /// Takes a step, the first of an arc in the lanes `first`.
    fn step<R: Real, Q: System<R, N>, const N: usize>(
        system: &Q,
        step: Step<R>,
        start: &Carried<R, N>,
        first: R::Mask,
        tolerance: Tolerance,
        memory: &mut Self::Memory<R, N>,
        end: &mut Carried<R, N>,
    ) -> Advance<R>;

    /// Takes `part`, the fraction `s` of the last step.
    fn inside<R: Real, Q: System<R, N>, const N: usize>(
        system: &Q,
        part: Step<R>,
        s: R,
        start: &Carried<R, N>,
        tolerance: Tolerance,
        memory: &Self::Memory<R, N>,
        end: &mut Carried<R, N>,
    ) -> Advance<R>;
}

/// A one-step method with equal steps.
#[derive(Clone, Copy, Debug)]
pub struct Fixed<M>(pub M);

impl<M: FixedStep> LaneMethod for Fixed<M> {
    const ERRORS: ErrorModel = ErrorModel::Remainder(M::REMAINDER);
    const HAS_FIXED_STEP: bool = true;

    type Stepper<R: Real, const N: usize> = FixedStepper<M, R, N>;

    #[inline(always)]
    fn stepper<R: Real, const N: usize>(self, zero: R, control: &Control) -> FixedStepper<M, R, N> {
        FixedStepper {
            tolerance: control.tolerance,
            step: control.step,
            memory: M::memory(zero),
            start: zero,
            length: zero,
            count: zero.splat(f64::INFINITY),
            taken: zero,
        }
    }
}

pub struct FixedStepper<M: FixedStep, R: Real, const N: usize> {
    tolerance: Tolerance,
    /// Requested step, s.
    step: Option<f64>,
    memory: M::Memory<R, N>,
    /// Start of the arc and length of its steps, s.
    start: R,
    length: R,
    /// Steps of the arc, and steps taken.
    count: R,
    taken: R,
}

impl<M: FixedStep, R: Real, const N: usize> Stepper<R, N> for FixedStepper<M, R, N> {
    #[inline(always)]
    fn start_arc(&mut self, lane: usize, start: f64, end: f64) {
        let length = end - start;
        let steps = self.step.map_or(DEFAULT_STEPS, |step| length / step);
        let count = (steps * (1.0 - WHOLE)).ceil().max(1.0);
        self.start.set_lane(lane, start);
        self.length.set_lane(lane, length / count);
        self.count.set_lane(lane, count);
        self.taken.set_lane(lane, 0.0);
    }

    #[inline(always)]
    fn idle(&mut self, lane: usize) {
        self.start.set_lane(lane, 0.0);
        self.length.set_lane(lane, 0.0);
        self.count.set_lane(lane, f64::INFINITY);
    }

    #[inline(always)]
    fn propose<Q: System<R, N>>(&mut self, _system: &Q, lanes: &mut StepperLane<R, N>) -> Proposal<R> {
        let taken = self.taken + self.taken.splat(1.0);
        let lands = !taken.lt(self.count);
        let end = R::select(lands, lanes.arc_end, taken.mul_add(self.length, self.start));
        Proposal { step: Step { time: lanes.time, end, length: self.length }, lands }
    }

    #[inline(always)]
    fn attempt<Q: System<R, N>>(
        &mut self,
        system: &Q,
        step: Step<R>,
        lanes: &mut StepperLane<R, N>,
        end: &mut Carried<R, N>,
    ) -> Attempt<R> {
        let one = step.time.splat(1.0);
        let first = self.taken.lt(one);
        let advance = M::step(system, step, &lanes.now, first, self.tolerance, &mut self.memory, end);
        lanes.evaluations += advance.evaluations;
        let sound = advance.poison.lt(one);
        Attempt { accepted: sound, sound, error: one.zero(), rough: one.zero(), from_edge: one.never() }
    }

    #[inline(always)]
    fn inside<Q: System<R, N>>(
        &mut self,
        system: &Q,
        step: Step<R>,
        part: Step<R>,
        inside: R::Mask,
        lanes: &mut StepperLane<R, N>,
    ) -> [R; N] {
        let fraction = part.length / step.length;
        let mut end = lanes.now;
        let point = M::inside(system, part, fraction, &lanes.now, self.tolerance, &self.memory, &mut end);
        lanes.evaluations += R::select(inside, point.evaluations, fraction.zero());
        end.state
    }

    #[inline(always)]
    fn advance(&mut self, _proposal: &Proposal<R>, attempt: &Attempt<R>) -> R::Mask {
        self.taken += self.taken.splat(1.0);
        !attempt.sound
    }
}
