//! Order and step size from the tolerance (A. Jorba & M. Zou, Experimental Mathematics 14, 2005, sections 3.1 and 3.2).
//!
//! Decided from the angular velocity alone, so that a campaign that asks for the attitude and one that does not take the same
//! steps and get the same bits.

use crate::math::Real;
use crate::math::power::{exp2_rough, log2_rough};
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
    /// log2 of the time, s, at which the series of exp(alpha t^2/4) up to the order meets the tolerance for |alpha| = 1 rad/s^2.
    log_growth: f64,
}

/// Tolerances below the rounding of the arithmetic are met with a margin: truncation has a sign and rounding has none, so that
/// the remaining truncation adds up in every step. At the tolerance itself energy drifted by 6e-19 and the quaternion's norm by 8.3e-17 a
/// step (`tests/accuracy/round_off.rs`): two orders more, and this share of the tolerance for the series of the attitude.
const BELOW_ROUNDING: f64 = 1.0 / 4096.0;
/// The orders that go with it.
const MORE_ORDERS: usize = 2;

/// The product of two series has the tail of both: where the time of the rate and that of the angular acceleration are equal, the step
/// is this (log2) shorter than either, and less for every octave between them. Exact sums of the neglected coefficients at the orders 13
/// and 22 ask for 0.71 at equal times and 0.3 an octave apart; two octaves apart they are 3 to 12 times the tolerance of the
/// attitude's series, which is far below that of the rates.
const EQUAL_TIMES: f64 = 0.75;
/// How much less, for an octave.
const AN_OCTAVE: f64 = 0.375;

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
        // terms of even order alone: the first neglected one is (alpha t^2/4)^m / m!
        let first_neglected = (order + 2) / 2;
        let factorial: f64 = (1..=first_neglected).map(|n| n as f64).product();
        let growth = 2.0 * libm::pow(factorial * tolerance, 0.5 / first_neglected as f64);
        StepRule { order, log_safety, turn, log_slowest: 1.0 + libm::log2(turn), log_growth: libm::log2(growth) }
    }

    /// The step for the jet of a rate, lane by lane, in the lane's unit of time; always positive, at most 2^30.
    ///
    /// The size against which the tail of the series is held is that of the rate and of its change over a unit of time,
    /// which the caller chooses near the time scale of the motion.
    ///
    /// Where the rate is a polynomial of low order its own series ends, and only the attitude's limits the step: at a constant rate
    /// omega that of exp(omega t/2), at a constant angular acceleration alpha that of exp(alpha t^2/4). Constant torques make the
    /// second: `alpha` is what they add to the acceleration, `None` of free runs. See `EQUAL_TIMES` for where both count.
    #[inline(always)]
    pub fn step<R: Real, const N: usize>(&self, jet: &[[R; N]], alpha: Option<[R; 3]>) -> R {
        let scale = rate_squared(&jet[0]) + rate_squared(&jet[1]);
        let (last, before) = (rate_squared(&jet[self.order]), rate_squared(&jet[self.order - 1]));
        let number = |value: f64| scale.splat(value);
        let p = self.order as f64;
        let size = log2_rough(scale);
        // the tail is measured by squares: half the logarithm
        let from_last = (size - log2_rough(last)) * number(0.5 / p);
        let from_before = (size - log2_rough(before)) * number(0.5 / (p - 1.0));
        let radius = from_last.smaller(from_before);
        let mut slowest = size.mul_add(number(-0.5), number(self.log_slowest));
        if let Some(alpha) = alpha {
            let growth = log2_rough(dot(alpha, alpha)).mul_add(number(-0.25), number(self.log_growth));
            let shorter = (slowest - growth).abs().mul_add(number(-AN_OCTAVE), number(EQUAL_TIMES)).larger(number(0.0));
            slowest = slowest.smaller(growth) - shorter;
        }
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn order_follows_jorba_and_zou() {
        assert_eq!(StepRule::new(1e-16).order, 20);
        assert_eq!(StepRule::in_f64(1e-16).order, 22);
        assert_eq!(StepRule::in_f64(1e-12), StepRule::new(1e-12));
        assert_eq!(StepRule::new(1e-8).order, 11);
        assert_eq!(StepRule::new(1e-4).order, 6);
    }
}
