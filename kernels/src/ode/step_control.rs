//! Step control: what a campaign asks for, the constants of the controllers, and the arithmetic that they share.
//!
//! The source of the constants is given with each method.

use super::system::Tolerance;
use crate::math::power::power;
use crate::math::real::Real;

/// What a campaign asks for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Control {
    /// Tolerance of the adaptive methods.
    pub tolerance: Tolerance,
    /// Step of the methods with a fixed step, s; without it they take a thousandth of each arc. Adaptive methods ignore
    /// it.
    pub step: Option<f64>,
    /// A run ends after this number of attempted steps, accepted and rejected; earlier where it is out of reach
    /// ([`is_out_of_reach`]).
    pub max_steps: u64,
}

/// Steps in an arc after which its pace is judged: some 50 ms. A run that is limited to no more steps is not judged.
pub const PACE_STEPS: u64 = 20_000;

/// Factor between the steps that an arc needs and those that its pace lets expect, with a margin of two. Actuation is
/// constant in an arc: steps follow a periodic motion, or a rate that grows. They become longer on the average where a
/// torque brings a body to rest at the end of the arc, by two.
const UNEVEN: f64 = 4.0;

/// Whether an arc of `length` cannot be finished in `most` steps, where its first [`PACE_STEPS`] steps lead to `time`
/// after its start.
pub fn is_out_of_reach(most: u64, time: f64, length: f64) -> bool {
    time * (most as f64 / PACE_STEPS as f64) * UNEVEN < length
}

/// The constants of a step-size controller; the error is in units of the tolerance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Controller {
    /// The step is proportional to the error to minus this power: one over the order of the error estimate plus one.
    pub exponent: f64,
    /// Fraction of the step at which the error is expected to equal the tolerance.
    pub safety: f64,
    /// Maximum factor from one step to the next.
    pub growth: f64,
    /// Minimum factor at a rejection, and from one step to the next.
    pub shrink: f64,
    /// Factor of the second and further rejections of a step; `None`: the same as for the first.
    pub shrink_again: Option<f64>,
    /// Whether the step after one that was accepted after a rejection has the same length; otherwise it is not longer.
    pub hold_after_rejection: bool,
    /// A step that would reach the end of the arc if it were longer by this factor is changed to end there.
    pub landing: f64,
    /// Longest step as a fraction of the arc.
    pub longest: f64,
}

/// 16 eps: the shortest step as a fraction of the power of two below the time (`hmin = 16*eps(t)` of ode45).
const FLOOR: f64 = 16.0 * f64::EPSILON;

/// The time, s, that replaces smaller ones: the shortest step stays a normal number at t = 0.
const EARLIEST: f64 = 1e-280;

/// The shortest step at time `time`, s.
#[inline(always)]
pub(super) fn shortest_step<R: Real>(time: R) -> R {
    time.abs().larger(time.splat(EARLIEST)).exponent().power_of_two() * time.splat(FLOOR)
}

impl Controller {
    /// The factor for the next step (where `accepted`) or the next attempt (where not) after an error of `ratio`.
    ///
    /// `retry`: the attempt followed a rejection of the same step.
    #[inline(always)]
    pub(super) fn factor<R: Real>(&self, ratio: R, accepted: R::Mask, retry: R::Mask) -> R {
        let one = ratio.splat(1.0);
        let ideal = ratio.splat(self.safety) * power(ratio, -self.exponent);
        let bounded = ideal.larger(ratio.splat(self.shrink)).smaller(ratio.splat(self.growth));
        let after_rejection = if self.hold_after_rejection { one } else { bounded.smaller(one) };
        let again = match self.shrink_again {
            Some(factor) => ratio.splat(factor),
            None => bounded,
        };
        R::select(retry, R::select(accepted, after_rejection, again), bounded)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: an arc is given up where it needs more than four times the steps that are left at its pace, whatever its
    /// numbers.
    #[test]
    fn an_arc_is_given_up_where_it_is_out_of_reach() {
        let most = 100 * PACE_STEPS;
        assert!(is_out_of_reach(most, 0.99, 400.0) && !is_out_of_reach(most, 1.01, 400.0));
        assert!(is_out_of_reach(most, 0.0, f64::MIN_POSITIVE) && is_out_of_reach(u64::MAX, 1e-300, f64::MAX));
        assert!(!is_out_of_reach(u64::MAX, f64::MAX, f64::MAX));
    }

    #[test]
    fn the_floor_is_sixteen_units_in_the_last_place() {
        assert_eq!(shortest_step(1.0), 16.0 * f64::EPSILON);
        assert_eq!(shortest_step(1.9), 16.0 * f64::EPSILON);
        assert_eq!(shortest_step(1000.0), 16.0 * 512.0 * f64::EPSILON);
        assert!(shortest_step(0.0) > 0.0 && shortest_step(0.0) < 1e-294);
    }
}
