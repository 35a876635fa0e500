//! Order and step size from the tolerance (A. Jorba & M. Zou, Experimental Mathematics 14, 2005, sections 3.1 and 3.2).
//!
//! Their order, 1 - ln(tolerance)/2, is cheapest if a step costs as much as its Cauchy products. Here observation
//! points, integrals of thrust and the search for a period cost the same at any order: `MORE_ORDERS` lengthen the steps
//! at the same truncation.
//!
//! **The attitude.** If omega is bounded by w/(1 - t/rho) coefficient by coefficient, with the radius of convergence
//! rho, then q' = q (x) omega/2 bounds q by (1 - t/rho)^(-s), s = w rho/2, with the coefficients binomial(s + n - 1,
//! n)/rho^n. The n-th root of that binomial is at most 1.04 (1 + s/(n!)^(1/n)) up to n = 27, and near that for s > 3.
//! The first neglected term, of order n, meets the tolerance if tolerance^(1/n)/h = 1/rho + w/(2 (n!)^(1/n)): the
//! reciprocals of the steps allowed by the radius and by rotation at a constant rate add. A share `RADIUS_SHARE` of the
//! first suffices.
//!
//! The angular velocity alone decides, so that campaigns with and without attitude take the same steps.

use crate::dynamics::gyrostat::{ANGULAR_IMPULSE, IMPULSE, OMEGA};
use crate::math::power::{exp2_rough, log2_rough};
use crate::math::prelude::*;
use crate::propagation::gyrostat_runs::SMALLEST_OFFSET;

/// Order and constants of the step size for one tolerance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepRule {
    /// Order of the series.
    pub order: usize,
    /// log2 of the ratio of estimated radius of convergence to the step of omega's series.
    log_safety: f64,
    /// That step over the attitude's step limited by the radius alone, times [`RADIUS_SHARE`].
    share: f64,
    /// Largest |omega| h/2 at which the series of exp(omega t/2) meets the tolerance.
    turn: f64,
    /// log2 of twice `turn`.
    log_slowest: f64,
    /// log2 of the time, s, at which the series of exp(alpha t^2/4) meets the tolerance for |alpha| = 1 rad/s^2.
    log_growth: f64,
}

/// Margin for tolerances below rounding: truncation has a sign and accumulates. At the tolerance itself energy drifted
/// by 6e-19 and the quaternion's norm by 8.3e-17 per step (`tests/accuracy/round_off.rs`).
const BELOW_ROUNDING: f64 = 1.0 / 4096.0;
/// Additional orders below rounding: longer steps add rounding.
const MORE_BELOW_ROUNDING: usize = 2;
/// Orders beyond Jorba & Zou's. The forced scene of `benches/peers/run.sh` takes 112 steps at 1e-4 instead of 295, in
/// 0.57 of the time; 128 at 1e-10 instead of 199, in 0.85. Orders 2, 6 and 8 beyond are not faster.
const MORE_ORDERS: usize = 4;
/// Share of the majorant's reciprocal radius: the attitude's error is at most four tolerances in the file of `spindrift
/// new` (12 to 44 without the term), and one in `detumble` (17 to 40).
const RADIUS_SHARE: f64 = 0.6;

/// The tail of a product is that of both series: at equal times of rate and angular acceleration the step is this
/// (log2) shorter than either, and less per octave between them. Exact sums of neglected coefficients at the orders 13
/// and 22 need 0.71 at equal times and 0.3 an octave apart.
const EQUAL_TIMES: f64 = 0.75;
/// Decrease of [`EQUAL_TIMES`] per octave.
const AN_OCTAVE: f64 = 0.375;

impl StepRule {
    /// The rule for a relative tolerance in [1e-33, 1e-1], in an arithmetic with more digits.
    pub fn new(tolerance: f64) -> Self {
        Self::with_order(optimal_order(tolerance), 0, 0.0, tolerance)
    }

    /// The rule for a relative tolerance in [1e-16, 1e-1] in `f64`.
    pub fn in_f64(tolerance: f64) -> Self {
        let order = optimal_order(tolerance);
        if tolerance < f64::EPSILON {
            Self::with_order(order + MORE_BELOW_ROUNDING, 0, 0.0, BELOW_ROUNDING * tolerance)
        } else {
            Self::with_order(order, MORE_ORDERS, RADIUS_SHARE, tolerance)
        }
    }

    /// Order `optimal` + `more`, with the last term of omega's series as small as at the order `optimal`.
    fn with_order(optimal: usize, more: usize, radius_share: f64, tolerance: f64) -> Self {
        let order = optimal + more;
        let factorial: f64 = (1..=order + 1).map(|n| n as f64).product();
        let turn = libm::pow(factorial * tolerance, 1.0 / (order as f64 + 1.0));
        let log_last = -(2.0 + 0.7 / (optimal as f64 - 1.0)) * optimal as f64;
        let log_safety = log_last / order as f64 / core::f64::consts::LN_2;
        let share = radius_share * libm::exp2(log_safety) / libm::pow(tolerance, 1.0 / (order as f64 + 1.0));
        // terms of even order alone: the first neglected one is (alpha t^2/4)^m / m!
        let first_neglected = (order + 2) / 2;
        let factorial: f64 = (1..=first_neglected).map(|n| n as f64).product();
        let growth = 2.0 * libm::pow(factorial * tolerance, 0.5 / first_neglected as f64);
        let (log_slowest, log_growth) = (1.0 + libm::log2(turn), libm::log2(growth));
        StepRule { order, log_safety, share, turn, log_slowest, log_growth }
    }

    /// Sum of the terms beyond the last one of omega's series over that one.
    pub(super) fn rest(&self) -> f64 {
        let ratio = libm::exp2(self.log_safety);
        ratio / (1.0 - ratio)
    }

    /// Step for the jet of a rate, by lane, in the lane's unit of time; positive, at most 2^30.
    ///
    /// The tail is compared with the rate and its change over a unit of time. The attitude's series limits the step
    /// too: exp(omega t/2) at constant rate, exp(alpha t^2/4) at constant angular acceleration (`EQUAL_TIMES` if both
    /// count). `alpha` is the acceleration by constant torques, `None` in free runs.
    #[inline(always)]
    pub fn step<R: Real, const N: usize>(&self, jet: &[[R; N]], alpha: Option<[R; 3]>) -> R {
        let scale = squared(&jet[0], OMEGA) + squared(&jet[1], OMEGA);
        let (last, before) = (squared(&jet[self.order], OMEGA), squared(&jet[self.order - 1], OMEGA));
        let number = |value: f64| scale.splat(value);
        let p = self.order as f64;
        let size = log2_rough(scale);
        // half the logarithm, since the tail is measured by squares
        let from_last = (size - log2_rough(last)) * number(0.5 / p);
        let from_before = (size - log2_rough(before)) * number(0.5 / (p - 1.0));
        let radius = from_last.smaller(from_before);
        let mut slowest = size.mul_add(number(-0.5), number(self.log_slowest));
        if let Some(alpha) = alpha {
            let growth = log2_rough(dot(alpha, alpha)).mul_add(number(-0.25), number(self.log_growth));
            let shorter = (slowest - growth).abs().mul_add(number(-AN_OCTAVE), number(EQUAL_TIMES)).larger(number(0.0));
            slowest = slowest.smaller(growth) - shorter;
        }
        let (of_rate, of_turn) = (clamped_exp2(radius + number(self.log_safety)), clamped_exp2(slowest));
        of_rate.smaller(of_turn / number(self.share).mul_add(of_turn / of_rate, number(1.0)))
    }

    /// Step for any series alone, by the squares of its first, last but one and last coefficient.
    #[inline(always)]
    pub fn step_of_series<R: Real>(&self, [first, before, last]: [R; 3]) -> R {
        let number = |value: f64| first.splat(value);
        let (p, size) = (self.order as f64, log2_rough(first));
        let from_last = (size - log2_rough(last)) * number(0.5 / p);
        let from_before = (size - log2_rough(before)) * number(0.5 / (p - 1.0));
        clamped_exp2(from_last.smaller(from_before) + number(self.log_safety))
    }

    /// Step for the series of the angular impulse: an effect's torque turns up to twice as fast as the body.
    #[inline(always)]
    pub fn step_of_impulse<R: Real, const N: usize>(&self, jet: &[[R; N]]) -> R {
        let size = |n: usize| squared(&jet[n], ANGULAR_IMPULSE);
        self.step_of_series([size(1), size(self.order - 1), size(self.order)])
    }

    /// Step for the motion relative to an orbit, by the series of its momentum.
    #[inline(always)]
    pub fn step_of_offset<R: Real, const N: usize>(&self, jet: &[[R; N]], mass: R) -> R {
        let size = |n: usize| squared(&jet[n], IMPULSE);
        let least = mass * mass.splat(SMALLEST_OFFSET);
        let first = least.mul_add(least, size(0) + size(1));
        self.step_of_series([first, size(self.order - 1), size(self.order)])
    }

    /// Largest |omega| h of a step.
    pub fn largest_turn(&self) -> f64 {
        2.0 * self.turn
    }
}

/// The order of Jorba & Zou (2005), section 3.1.
fn optimal_order(tolerance: f64) -> usize {
    (1.0 - 0.5 * libm::log(tolerance)).ceil().max(3.0) as usize
}

/// 2^`log`, between 2^-900 and 2^30.
#[inline(always)]
fn clamped_exp2<R: Real>(log: R) -> R {
    exp2_rough(log.smaller(log.splat(30.0)).larger(log.splat(-900.0)))
}

/// Square of the vector at component `first`.
#[inline(always)]
fn squared<R: Real, const N: usize>(coefficients: &[R; N], first: usize) -> R {
    let vector = three(coefficients, first);
    dot(vector, vector)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The majorant (1 - t/rho)^(-s) of the attitude, at the step of the rule with the full share of the radius.
    #[test]
    fn the_first_term_left_out_of_the_attitude_meets_the_tolerance() {
        for tolerance in [1e-4, 1e-8, 1e-13] {
            let rule = StepRule::in_f64(tolerance);
            let n = rule.order + 1;
            let step_over_radius = libm::exp2(rule.log_safety) / (rule.share / RADIUS_SHARE);
            for (s, least) in [(0.1, 0.003), (1.0, 0.08), (3.0, 0.3), (10.0, 0.7), (20.0, 0.8), (100.0, 0.9)] {
                // 1/h in units of the radius: by the radius alone, and by rotation at a constant rate |omega| = 2 s
                let inverse = 1.0 / step_over_radius + 2.0 * s / rule.largest_turn();
                let binomial: f64 = (0..n).map(|k| (s + k as f64) / (k as f64 + 1.0)).product();
                let term = binomial * libm::pow(inverse, -(n as f64));
                assert!((least..3.0).contains(&(term / tolerance)), "{tolerance} {s}: {term:e}");
            }
        }
    }
}
