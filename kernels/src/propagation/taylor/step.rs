//! Order and step size from the tolerance (A. Jorba & M. Zou, Experimental Mathematics 14, 2005, sections 3.1 and 3.2).
//!
//! The order of Jorba & Zou, 1 - ln(tolerance)/2, costs least where a step costs as much as its Cauchy products. Here
//! it does not: points, integrals of thrust and the search for a period cost the same at any order. `MORE_ORDERS` make
//! the steps longer at the same truncation.
//!
//! **The attitude.** Where omega is below w/(1 - t/rho) coefficient by coefficient, with rho the radius of convergence,
//! q' = q (x) omega/2 gives q below (1 - t/rho)^(-s), s = w rho/2, whose coefficient n is binomial(s + n - 1, n)/rho^n.
//! The root of order n of that binomial is at most 1.04 (1 + s/(n!)^(1/n)) up to n = 27, and near that for s > 3. So
//! the first neglected term, of order n, meets the tolerance where tolerance^(1/n)/h = 1/rho + w/(2 (n!)^(1/n)): the
//! reciprocals of the step that the radius allows and of the one that turning at a constant rate allows add up. The
//! coefficients of omega are below the majorant's: a share of `RADIUS_SHARE` of the first is enough.
//!
//! Decided from the angular velocity alone, so that a campaign that asks for the attitude and one that does not take
//! the same steps and get the same bits.

use crate::dynamics::gyrostat::{ANGULAR_IMPULSE, IMPULSE};
use crate::math::Real;
use crate::math::power::{exp2_rough, log2_rough};
use crate::math::vector::dot;
use crate::propagation::gyrostat_runs::SMALLEST_OFFSET;

/// Order and constants of the step size for one tolerance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepRule {
    /// Order of the series.
    pub order: usize,
    /// log2 of the factor between the estimated radius of convergence and the step of omega's series.
    log_safety: f64,
    /// That step over the one of the attitude where the radius alone limits it, times [`RADIUS_SHARE`].
    share: f64,
    /// Largest |omega| h/2 at which the series of exp(omega t/2) up to the order meets the tolerance.
    turn: f64,
    /// log2 of twice that.
    log_slowest: f64,
    /// log2 of the time, s, at which the series of exp(alpha t^2/4) up to the order meets the tolerance for |alpha| = 1
    /// rad/s^2.
    log_growth: f64,
}

/// Tolerances below the rounding of the arithmetic are met with a margin: truncation has a sign and rounding has none,
/// so that the remaining truncation adds up in every step. At the tolerance itself energy drifted by 6e-19 and the
/// quaternion's norm by 8.3e-17 a step (`tests/accuracy/round_off.rs`): two orders more, and this share of the
/// tolerance for the series of the attitude.
const BELOW_ROUNDING: f64 = 1.0 / 4096.0;
/// The orders that go with it. Larger steps than these add more rounding, and the margin is larger than the attitude's
/// own term.
const MORE_BELOW_ROUNDING: usize = 2;
/// Orders beyond that of Jorba & Zou. The forced scene of `benches/peers/run.sh` takes 112 steps at 1e-4 instead of
/// 295, and 0.57 of the time; 128 at 1e-10 instead of 199, and 0.85. Orders 2, 6 and 8 beyond are within the noise of
/// 4, or slower.
const MORE_ORDERS: usize = 4;
/// How much of the majorant's reciprocal radius counts: with it the attitude's error is at most four tolerances in the
/// file of `spindrift new` (12 to 44 without the term), and one in `detumble` (17 to 40).
const RADIUS_SHARE: f64 = 0.6;

/// The product of two series has the tail of both: where the time of the rate and that of the angular acceleration are
/// equal, the step is this (log2) shorter than either, and less for every octave between them. Exact sums of the
/// neglected coefficients at the orders 13 and 22 ask for 0.71 at equal times and 0.3 an octave apart; two octaves
/// apart they are 3 to 12 times the tolerance of the attitude's series, which is far below that of the rates.
const EQUAL_TIMES: f64 = 0.75;
/// How much less, for an octave.
const AN_OCTAVE: f64 = 0.375;

impl StepRule {
    /// The rule for a relative tolerance in [1e-33, 1e-1], in an arithmetic with more digits than that.
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

    /// Order `optimal` + `more`, with the last term of omega's series as small as at the order `optimal`, and
    /// `radius_share` as [`RADIUS_SHARE`].
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

    /// What the terms beyond the last one that omega's series keeps amount to, as a share of that.
    pub(super) fn rest(&self) -> f64 {
        let ratio = libm::exp2(self.log_safety);
        ratio / (1.0 - ratio)
    }

    /// The step for the jet of a rate, lane by lane, in the lane's unit of time; always positive, at most 2^30.
    ///
    /// The size against which the tail of the series is held is that of the rate and of its change over a unit of time,
    /// which the caller chooses near the time scale of the motion.
    ///
    /// The attitude's series limits the step too, and alone where the rate is a polynomial of low order: at a constant
    /// rate omega that of exp(omega t/2), at a constant angular acceleration alpha that of exp(alpha t^2/4). Constant
    /// torques make the second: `alpha` is what they add to the acceleration, `None` of free runs. See `EQUAL_TIMES`
    /// for where both count.
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
        let (of_rate, of_turn) = (clamped_exp2(radius + number(self.log_safety)), clamped_exp2(slowest));
        of_rate.smaller(of_turn / number(self.share).mul_add(of_turn / of_rate, number(1.0)))
    }

    /// The step for any series alone, from the squares of its first, its last but one and its last coefficient.
    #[inline(always)]
    pub fn step_of_series<R: Real>(&self, [first, before, last]: [R; 3]) -> R {
        let number = |value: f64| first.splat(value);
        let (p, size) = (self.order as f64, log2_rough(first));
        let from_last = (size - log2_rough(last)) * number(0.5 / p);
        let from_before = (size - log2_rough(before)) * number(0.5 / (p - 1.0));
        clamped_exp2(from_last.smaller(from_before) + number(self.log_safety))
    }

    /// The step that the angular impulse allows, whose series the jet has: the torque of an effect turns up to twice as
    /// fast as the body, which shows in omega only where it is strong.
    #[inline(always)]
    pub fn step_of_impulse<R: Real, const N: usize>(&self, jet: &[[R; N]]) -> R {
        let size = |n: usize| {
            let impulse = [jet[n][ANGULAR_IMPULSE], jet[n][ANGULAR_IMPULSE + 1], jet[n][ANGULAR_IMPULSE + 2]];
            dot(impulse, impulse)
        };
        self.step_of_series([size(1), size(self.order - 1), size(self.order)])
    }

    /// The step that the motion relative to an orbit allows, of a spacecraft of the mass `mass`: the series of its
    /// momentum.
    #[inline(always)]
    pub fn step_of_offset<R: Real, const N: usize>(&self, jet: &[[R; N]], mass: R) -> R {
        let size = |n: usize| {
            let momentum = [jet[n][IMPULSE], jet[n][IMPULSE + 1], jet[n][IMPULSE + 2]];
            dot(momentum, momentum)
        };
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
        assert_eq!([1e-16, 1e-8, 1e-4].map(|tolerance| StepRule::new(tolerance).order), [20, 11, 6]);
        assert_eq!([1e-16, 1e-8, 1e-4].map(|tolerance| StepRule::in_f64(tolerance).order), [22, 15, 10]);
    }

    /// The majorant (1 - t/rho)^(-s) of the attitude, at the step of the rule with the whole of the radius's share.
    #[test]
    fn the_first_term_left_out_of_the_attitude_meets_the_tolerance() {
        for tolerance in [1e-4, 1e-8, 1e-13] {
            let rule = StepRule::in_f64(tolerance);
            let n = rule.order + 1;
            let step_over_radius = libm::exp2(rule.log_safety) / (rule.share / RADIUS_SHARE);
            for (s, least) in [(0.1, 0.003), (1.0, 0.08), (3.0, 0.3), (10.0, 0.7), (20.0, 0.8), (100.0, 0.9)] {
                // 1/h in units of the radius: of the radius alone, and of turning at a constant rate |omega| = 2 s
                let inverse = 1.0 / step_over_radius + 2.0 * s / rule.largest_turn();
                let binomial: f64 = (0..n).map(|k| (s + k as f64) / (k as f64 + 1.0)).product();
                let term = binomial * libm::pow(inverse, -(n as f64));
                // by formula: at most 2.6 at order 27
                assert!((least..3.0).contains(&(term / tolerance)), "{tolerance} {s}: {term:e}");
            }
        }
    }
}
