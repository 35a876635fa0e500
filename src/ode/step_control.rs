//! How an adaptive method chooses its steps: numbers of the controllers, and the arithmetic that they share.
//!
//! Sources stand with each controller. Everything is arithmetic in lanes: no lane looks at another.

use super::Tolerance;
use crate::math::Real;
use crate::math::power::power;

/// What a campaign says about steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Control {
    /// Tolerance of the adaptive methods.
    pub tolerance: Tolerance,
    /// Step of the methods with a fixed step, s; without it they take a thousandth of each stretch. Adaptive methods ignore it.
    pub step: Option<f64>,
    /// A run that has not arrived after so many attempted steps (accepted and rejected) is given up.
    pub max_steps: u64,
}

/// The constants of a step-size controller; the error is in units of the tolerance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Controller {
    /// The step follows the error to minus this power: one over the order of the error estimate plus one.
    pub exponent: f64,
    /// Share of the step at which the error is expected to meet the tolerance.
    pub safety: f64,
    /// Largest growth from one step to the next.
    pub growth: f64,
    /// Smallest factor at a rejection, and from one step to the next.
    pub shrink: f64,
    /// Factor of the second and further rejections of a step; `None`: as the first.
    pub shrink_again: Option<f64>,
    /// Whether a step that passed after a rejection hands its size on unchanged; else it only must not grow.
    pub hold_after_rejection: bool,
    /// A step that reaches the end of the stretch when it is this much longer is stretched or cut to land on it.
    pub landing: f64,
    /// Longest step as a share of the stretch.
    pub longest: f64,
}

/// `Real` flags: one where something holds, zero where not. A sum of flags is a count, and a product both.
#[inline(always)]
pub(super) fn flag<R: Real>(mask: R::Mask, like: R) -> R {
    R::select(mask, like.splat(1.0), like.zero())
}

/// The mask of a flag.
#[inline(always)]
pub(super) fn raised<R: Real>(flag: R) -> R::Mask {
    flag.splat(0.5).lt(flag)
}

/// 16 eps: steps below this share of the time's power of two cannot be told from zero (ode45's `hmin = 16*eps(t)`).
const FLOOR: f64 = 16.0 * f64::EPSILON;

/// The time whose last digit counts while the run is still younger, s: keeps the floor a normal number at t = 0.
const YOUNGEST: f64 = 1e-280;

/// The shortest step at time `time`, s.
#[inline(always)]
pub(super) fn shortest_step<R: Real>(time: R) -> R {
    time.abs().larger(time.splat(YOUNGEST)).exponent().power_of_two() * time.splat(FLOOR)
}

impl Controller {
    /// The factor for the next step (`accepted` raised) or the next attempt (not raised) after an error of `ratio`.
    ///
    /// `retry` is raised where the attempt followed a rejection of the same step.
    #[inline(always)]
    pub(super) fn factor<R: Real>(&self, ratio: R, accepted: R, retry: R) -> R {
        let one = ratio.splat(1.0);
        let ideal = ratio.splat(self.safety) * power(ratio, -self.exponent);
        let bounded = ideal.larger(ratio.splat(self.shrink)).smaller(ratio.splat(self.growth));
        let after_rejection = if self.hold_after_rejection { one } else { bounded.smaller(one) };
        let again = match self.shrink_again {
            Some(factor) => ratio.splat(factor),
            None => bounded,
        };
        R::select(
            raised(accepted),
            R::select(raised(retry), after_rejection, bounded),
            R::select(raised(retry), again, bounded),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_floor_is_sixteen_units_in_the_last_place() {
        assert_eq!(shortest_step(1.0), 16.0 * f64::EPSILON);
        assert_eq!(shortest_step(1.9), 16.0 * f64::EPSILON);
        assert_eq!(shortest_step(1000.0), 16.0 * 512.0 * f64::EPSILON);
        assert!(shortest_step(0.0) > 0.0 && shortest_step(0.0) < 1e-290);
    }
}
