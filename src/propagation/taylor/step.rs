//! Order and step size from the tolerance (A. Jorba & M. Zou, Experimental Mathematics 14, 2005, sections 3.1 and 3.2).
//!
//! Decided from the angular velocity alone, so that a campaign that asks for the attitude and one that does not take the same
//! steps and get the same bits.

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
    /// log2 of twice that.
    log_slowest: f64,
}

/// Tolerances below the rounding of the arithmetic are met with room to spare: truncation has a sign and rounding has none, so that
/// what is left of it adds up in every step. At the tolerance itself energy drifted by 6e-19 and the quaternion's norm by 8.3e-17 a
/// step (`tests/accuracy/round_off.rs`): two orders more, and this share of the tolerance for the series of the attitude.
const BELOW_ROUNDING: f64 = 1.0 / 4096.0;
/// The orders that go with it.
const MORE_ORDERS: usize = 2;

impl StepRule {
    /// The rule for a relative tolerance in [1e-33, 1e-1], in an arithmetic with more digits than that.
    pub fn new(tolerance: f64) -> Self {
        Self::with_order((1.0 - 0.5 * libm::log(tolerance)).ceil().max(3.0) as usize, tolerance)
    }

    /// The rule for a relative tolerance in [1e-16, 1e-1] in `f64`.
    pub fn in_f64(tolerance: f64) -> Self {
        let rule = Self::new(tolerance);
        if tolerance < f64::EPSILON {
            Self::with_order(rule.order + MORE_ORDERS, BELOW_ROUNDING * tolerance)
        } else {
            rule
        }
    }

    fn with_order(order: usize, tolerance: f64) -> Self {
        let factorial: f64 = (1..=order + 1).map(|n| n as f64).product();
        let turn = libm::pow(factorial * tolerance, 1.0 / (order as f64 + 1.0));
        let log_safety = -(2.0 + 0.7 / (order as f64 - 1.0)) / core::f64::consts::LN_2;
        StepRule { order, log_safety, turn, log_slowest: 1.0 + libm::log2(turn) }
    }

    /// The step for the jet of a rate, lane by lane, in the lane's unit of time; always positive, at most 2^30.
    ///
    /// The size against which the tail of the series is held is that of the rate and of its change over a unit of time,
    /// which the caller chooses near the time scale of the motion.
    #[inline(always)]
    pub fn step<R: Real, const N: usize>(&self, jet: &[[R; N]]) -> R {
        let scale = rate_squared(&jet[0]) + rate_squared(&jet[1]);
        let (last, before) = (rate_squared(&jet[self.order]), rate_squared(&jet[self.order - 1]));
        let number = |value: f64| scale.splat(value);
        let p = self.order as f64;
        let size = log2_rough(scale);
        // the tail is measured by squares: half the logarithm
        let from_last = (size - log2_rough(last)) * number(0.5 / p);
        let from_before = (size - log2_rough(before)) * number(0.5 / (p - 1.0));
        let radius = from_last.smaller(from_before);
        let slowest = size.mul_add(number(-0.5), number(self.log_slowest));
        let log_step = (radius + number(self.log_safety)).smaller(slowest).smaller(number(30.0));
        exp2_rough(log_step.larger(number(-1000.0)))
    }

    /// Largest |omega| h of a step.
    pub fn largest_turn(&self) -> f64 {
        2.0 * self.turn
    }
}

/// |omega|^2 of one order of a jet.
#[inline(always)]
fn rate_squared<R: Real, const N: usize>(coefficients: &[R; N]) -> R {
    let rate = [coefficients[0], coefficients[1], coefficients[2]];
    dot(rate, rate)
}

/// log2 x to 1e-4 for positive normal x below 2^1022; about -1020 for zero.
#[inline(always)]
pub fn log2_rough<R: Real>(x: R) -> R {
    let exponent = x.exponent();
    let y = x * (-exponent).power_of_two() - x.splat(1.0);
    // log2(1 + y)/y interpolated at the Chebyshev nodes of [0, 1], degree 5: error 7.4e-6
    let mut series = y.splat(-0.033_822_046);
    for coefficient in [0.144_471_096, -0.301_638_01, 0.468_658_879, -0.720_358_773, 1.442_681_47] {
        series = series.mul_add(y, y.splat(coefficient));
    }
    y.mul_add(series, exponent)
}

/// 2^x to 1e-4 for |x| < 1000.
#[inline(always)]
pub fn exp2_rough<R: Real>(x: R) -> R {
    // adding and taking away 1.5 * 2^52 rounds to the nearest integer
    let shift = x.splat(6_755_399_441_055_744.0);
    let whole = (x + shift) - shift;
    let rest = (x - whole) * x.splat(core::f64::consts::LN_2);
    let mut series = x.splat(1.0 / 120.0);
    for coefficient in [1.0 / 24.0, 1.0 / 6.0, 0.5, 1.0, 1.0] {
        series = series.mul_add(rest, x.splat(coefficient));
    }
    series * whole.power_of_two()
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
        assert!(log2_rough(0.0_f64) < -1000.0);
    }

    #[test]
    fn order_follows_jorba_and_zou() {
        assert_eq!(StepRule::new(1e-16).order, 20);
        assert_eq!(StepRule::in_f64(1e-16).order, 22);
        assert_eq!(StepRule::in_f64(1e-12), StepRule::new(1e-12));
        assert_eq!(StepRule::new(1e-8).order, 11);
        assert_eq!(StepRule::new(1e-4).order, 6);
    }
}
