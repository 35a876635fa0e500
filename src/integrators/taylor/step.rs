//! Order and step size from the tolerance (A. Jorba & M. Zou, Experimental Mathematics 14, 2005, sections 3.1 and 3.2).
//!
//! Decided from the angular velocity alone, and from whether thrust acts, so that a campaign that asks for the attitude and one
//! that does not take the same steps and get the same bits.

use crate::math::Real;
use crate::math::vector::dot;

/// Order and constants of the step size for one tolerance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepRule {
    /// Order of the series.
    pub order: usize,
    /// log2 of the factor between the estimated radius of convergence and the step: -(2 + 0.7/(p-1)) / ln 2.
    log_safety: f64,
    /// Largest |omega| h/2 at which the series of exp(omega t/2) up to the order meets the tolerance.
    turn: f64,
}

impl StepRule {
    /// The rule for a relative tolerance in [1e-33, 1e-1].
    pub fn new(tolerance: f64) -> Self {
        let order = (1.0 - 0.5 * libm::log(tolerance)).ceil().max(3.0) as usize;
        let factorial: f64 = (1..=order + 1).map(|n| n as f64).product();
        let turn = libm::pow(factorial * tolerance, 1.0 / (order as f64 + 1.0));
        let log_safety = -(2.0 + 0.7 / (order as f64 - 1.0)) / core::f64::consts::LN_2;
        StepRule { order, log_safety, turn }
    }

    /// The step for the jet of a rate, lane by lane, in the lane's unit of time; always positive, at most 2^30.
    ///
    /// The size against which the tail of the series is held is that of the rate and of its change over a unit of time,
    /// which the caller chooses near the time scale of the motion.
    ///
    /// `pushed` is one where thrust acts, else zero. A thrust turns with omega where the quaternion turns with omega/2, so that
    /// the series of its integrals (impulse, angular impulse, path) needs half the step; at 1e-16 they would else be off by
    /// 2^21 tolerances, 2e-10.
    #[inline(always)]
    pub fn step<R: Real, const N: usize>(&self, jet: &[[R; N]], pushed: R) -> R {
        let zero = jet[0][0].zero();
        let scale = rate_squared(&jet[0]) + rate_squared(&jet[1]);
        let (last, before) = (rate_squared(&jet[self.order]), rate_squared(&jet[self.order - 1]));
        let mut step = zero;
        let (p, log_safety) = (self.order as f64, self.log_safety);
        for lane in 0..R::LANES {
            let size = log2_rough(scale.lane(lane));
            // the tail is measured by squares: half the logarithm
            let from_last = 0.5 * (size - log2_rough(last.lane(lane))) / p;
            let from_before = 0.5 * (size - log2_rough(before.lane(lane))) / (p - 1.0);
            let radius = if from_last < from_before { from_last } else { from_before };
            let slowest = 1.0 + log2_rough(self.turn) - 0.5 * size - pushed.lane(lane);
            let log_step = radius + log_safety;
            let log_step = if slowest < log_step { slowest } else { log_step };
            step.set_lane(lane, exp2_rough(if log_step < 30.0 { log_step } else { 30.0 }));
        }
        step
    }
}

/// |omega|^2 of one order of a jet.
#[inline(always)]
fn rate_squared<R: Real, const N: usize>(coefficients: &[R; N]) -> R {
    let rate = [coefficients[0], coefficients[1], coefficients[2]];
    dot(rate, rate)
}

/// log2 x to 1e-4 for positive normal x; about -1023 for zero; branch-free, so that eight lanes vectorise.
#[inline(always)]
pub fn log2_rough(x: f64) -> f64 {
    let bits = x.to_bits();
    let exponent = ((bits >> 52) & 0x7ff) as i32 - 1023;
    let mantissa = f64::from_bits((bits & 0x000f_ffff_ffff_ffff) | 0x3ff0_0000_0000_0000);
    let y = mantissa - 1.0;
    // log2(1 + y)/y interpolated at the Chebyshev nodes of [0, 1], degree 5: error 7.4e-6
    let series = -0.033_822_046 * y + 0.144_471_096;
    let series = series * y - 0.301_638_01;
    let series = series * y + 0.468_658_879;
    let series = series * y - 0.720_358_773;
    let series = series * y + 1.442_681_47;
    f64::from(exponent) + y * series
}

/// 2^x to 1e-4 for |x| < 1000; branch-free.
#[inline(always)]
pub fn exp2_rough(x: f64) -> f64 {
    // adding and taking away 1.5 * 2^52 rounds to the nearest integer, which stands in the low bits in between
    const SHIFT: f64 = 6_755_399_441_055_744.0;
    let shifted = x + SHIFT;
    let whole = shifted - SHIFT;
    let rest = (x - whole) * core::f64::consts::LN_2;
    let series = 1.0 + rest * (1.0 + rest * (0.5 + rest * (1.0 / 6.0 + rest * (1.0 / 24.0 + rest / 120.0))));
    let exponent = shifted.to_bits().wrapping_sub(SHIFT.to_bits());
    series * f64::from_bits(exponent.wrapping_add(1023) << 52)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Stated error of the rough functions.
    const ROUGH: f64 = 1e-4;

    #[test]
    fn rough_logarithm_and_power_are_as_good_as_stated() {
        for k in -3000..3000 {
            let x = libm::exp2(f64::from(k) * 0.0317);
            assert!((log2_rough(x) - libm::log2(x)).abs() < ROUGH, "{x}");
            let e = f64::from(k) * 0.0091;
            assert!((exp2_rough(e) / libm::exp2(e) - 1.0).abs() < ROUGH, "{e}");
        }
        assert!(log2_rough(0.0) < -1000.0);
    }

    #[test]
    fn order_follows_jorba_and_zou() {
        assert_eq!(StepRule::new(1e-16).order, 20);
        assert_eq!(StepRule::new(1e-8).order, 11);
        assert_eq!(StepRule::new(1e-4).order, 6);
    }
}
