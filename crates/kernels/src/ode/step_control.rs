//! Step control: settings, constants of the controllers, shared arithmetic.

use super::system::Tolerance;
use crate::math::power::power;
use crate::math::real::Real;

/// Settings of a campaign.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Control {
    /// Tolerance of the adaptive methods.
    pub tolerance: Tolerance,
    /// Step of fixed-step methods, s; by default a thousandth of each arc. Ignored by adaptive methods.
    pub step: Option<f64>,
    /// Limit of attempted steps of a run, which ends earlier if its end [`is_out_of_reach`].
    pub max_steps: u64,
}

/// Steps of an arc, some 50 ms, after which [`is_out_of_reach`] is evaluated.
pub const PACE_STEPS: u64 = 20_000;

/// Margin of two, times two for steps that grow on average while a torque brings the body to rest. Otherwise steps
/// follow a periodic motion or a growing rate.
const UNEVEN: f64 = 4.0;

/// True if an arc of `length` cannot end within `most` steps, its first [`PACE_STEPS`] steps having reached `time`.
pub fn is_out_of_reach(most: u64, time: f64, length: f64) -> bool {
    time * (most as f64 / PACE_STEPS as f64) * UNEVEN < length
}

/// Constants of a step-size controller; errors are in units of the tolerance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Controller {
    /// 1/(order of the estimate + 1): the step is proportional to the error to minus this power.
    pub exponent: f64,
    /// Factor on the step whose error is expected to equal the tolerance.
    pub safety: f64,
    /// Maximum factor between steps.
    pub growth: f64,
    /// Minimum factor at a rejection and between steps.
    pub shrink: f64,
    /// Factor of repeated rejections of a step; `None`: as for the first.
    pub shrink_again: Option<f64>,
    /// True to keep the length after a step accepted on retry; otherwise it may shrink.
    pub hold_after_rejection: bool,
    /// A step that would reach the end of the arc if longer by this factor ends there.
    pub landing: f64,
    /// Longest step as a fraction of the arc.
    pub longest: f64,
}

/// Shortest step over the power of two below the time (`hmin = 16*eps(t)` of ode45).
const FLOOR: f64 = 16.0 * f64::EPSILON;

/// Replaces smaller times, s, so that the shortest step is a normal number at t = 0.
const EARLIEST: f64 = 1e-280;

#[inline(always)]
pub fn shortest_step<R: Real>(time: R) -> R {
    time.abs().larger(time.splat(EARLIEST)).exponent().power_of_two() * time.splat(FLOOR)
}

impl Controller {
    /// Factor on the step after an attempt with the error `ratio`; `retry` marks attempts after a rejection of the same
    /// step.
    #[inline(always)]
    pub fn factor<R: Real>(&self, ratio: R, accepted: R::Mask, retry: R::Mask) -> R {
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

/// Factor on a step from an edge, such as that of a penumbra, whose error `ratio` is too large: f grows with the power
/// 3/2 of time, the error with 5/2.
#[inline(always)]
pub fn factor_from_edge<R: Real>(ratio: R) -> R {
    ratio.splat(0.8) * power(ratio, -0.4)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: an arc is given up if it needs more than four times the remaining steps at its pace.
    #[test]
    fn arcs_out_of_reach_are_given_up() {
        let most = 100 * PACE_STEPS;
        assert!(is_out_of_reach(most, 0.99, 400.0) && !is_out_of_reach(most, 1.01, 400.0));
        assert!(is_out_of_reach(most, 0.0, f64::MIN_POSITIVE) && is_out_of_reach(u64::MAX, 1e-300, f64::MAX));
        assert!(!is_out_of_reach(u64::MAX, f64::MAX, f64::MAX));
    }
}
