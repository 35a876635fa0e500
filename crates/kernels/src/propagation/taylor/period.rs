//! The period of omega, and time folded by it.
//!
//! A return is a crossing, in the same sense and close to omega(0), of the plane through omega(0) normal to its
//! velocity. Over a period P the attitude turns by a fixed rotation about L, constant in F_e (L. Poinsot, *Theorie
//! nouvelle de la rotation des corps*, 1851; gyrostats: V. Volterra, 1899): q(t + n P) = r^n (x) q(t), r = q(P) (x)
//! q(0)*. Integrals of periodic quantities grow equally in every period.

use fearless_simd::Simd;

use super::jet::MAX_ORDER;
use crate::math::prelude::*;
use crate::math::sine::sin_cos_turns;
use crate::math::{Lanes, Real};

/// Largest distance of a return from the start as a share of the curve's extent: far below the distance of two
/// branches.
const RETURN_OF_EXTENT: f64 = 1e-6;
/// Largest distance as a share of the rate: round-off on a curve small compared with |omega|.
const RETURN_OF_RATE: f64 = 1e-13;
/// Largest distance in units of the tolerance: truncation at loose tolerances.
const RETURN_OF_TOLERANCE: f64 = 100.0;
/// Limit of Newton steps on one polynomial; three or four are usual.
const NEWTON_STEPS: usize = 12;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Period {
    /// Length, units, an unevaluated sum.
    pub length: [f64; 2],
    /// Half the rotation angle of a period, turns.
    pub half_turns: f64,
    /// Rotation axis, unit vector in F_e.
    pub axis_e: [f64; 3],
}

/// Section across the curve of omega at the start of an arc, updated by [`super::return_detector::ReturnDetector`].
#[derive(Clone, Copy, Debug)]
pub struct PoincareSection {
    /// omega at the start.
    pub start: [f64; 3],
    /// Unit vector along omega' at the start.
    pub direction: [f64; 3],
    /// Largest squared distance from the start at the ends of steps.
    pub extent2: f64,
    /// Position along `direction` at the end of the last step.
    pub side: f64,
}

impl PoincareSection {
    /// The section at the start of an arc; `None` if omega does not move.
    #[inline]
    pub fn new(omega: [f64; 3], rate: [f64; 3]) -> Option<Self> {
        let norm2 = rate[0] * rate[0] + rate[1] * rate[1] + rate[2] * rate[2];
        if norm2 == 0.0 {
            return None;
        }
        let inverse = 1.0 / norm2.sqrt();
        Some(PoincareSection { start: omega, direction: rate.map(|x| x * inverse), extent2: 0.0, side: 0.0 })
    }

    /// Time within a step at which omega returns; `None` for a crossing on another branch of the curve.
    #[inline(always)]
    pub fn crossing<R: Real, const N: usize>(
        &self,
        jet: &[[R; N]],
        lane: usize,
        order: usize,
        length: f64,
        tolerance: f64,
    ) -> Option<f64> {
        let d = self.direction;
        let mut along = [0.0; MAX_ORDER + 1];
        for n in 0..=order {
            let mut omega = [jet[n][0].lane(lane), jet[n][1].lane(lane), jet[n][2].lane(lane)];
            if n == 0 {
                omega = [omega[0] - self.start[0], omega[1] - self.start[1], omega[2] - self.start[2]];
            }
            along[n] = omega[0].mul_add(d[0], omega[1].mul_add(d[1], omega[2] * d[2]));
        }
        // secant between both ends, then Newton's method inside the bracket
        let mut x = length * (along[0] / (along[0] - self.side));
        let (mut low, mut high) = (0.0, length);
        for _ in 0..NEWTON_STEPS {
            let (mut value, mut slope) = (0.0_f64, 0.0_f64);
            for n in (0..=order).rev() {
                slope = slope.mul_add(x, value);
                value = value.mul_add(x, along[n]);
            }
            if value < 0.0 {
                low = x;
            } else {
                high = x;
            }
            let next = x - value / slope;
            let next = if next >= low && next <= high { next } else { 0.5 * (low + high) };
            let moved = (next - x).abs();
            x = next;
            if moved <= f64::EPSILON * length {
                break;
            }
        }
        let (mut distance2, mut rate2) = (0.0, 0.0);
        for i in 0..3 {
            let mut omega = 0.0_f64;
            for n in (0..=order).rev() {
                omega = omega.mul_add(x, jet[n][i].lane(lane));
            }
            distance2 += (omega - self.start[i]) * (omega - self.start[i]);
            rate2 += omega * omega;
        }
        let of_rate = RETURN_OF_RATE + RETURN_OF_TOLERANCE * tolerance;
        let allowed2 = RETURN_OF_EXTENT * RETURN_OF_EXTENT * self.extent2 + of_rate * of_rate * rate2;
        (distance2 <= allowed2).then_some(x)
    }
}

impl Period {
    /// The period of length `length` that takes the attitude from `start` to `end`, with the angular momentum
    /// `momentum_e` in F_e and its reference |J| |omega|, `scale`; `None` if the axis is too inaccurate to be repeated.
    #[inline]
    pub fn new(length: [f64; 2], start: [f64; 4], end: [f64; 4], momentum_e: [f64; 3], scale: f64) -> Option<Self> {
        let magnitude = norm(momentum_e);
        let [w, x, y, z] = start;
        let turn = hamilton(end, [w, -x, -y, -z]);
        let axis_part = [turn[1], turn[2], turn[3]];
        let axis_e = if magnitude > SMALL_MOMENTUM * scale {
            momentum_e.map(|component| component / magnitude)
        } else {
            // without momentum omega is constant, and the rotation is about it
            let sine = norm(axis_part);
            if sine < SMALL_SINE {
                return None;
            }
            axis_part.map(|component| component / sine)
        };
        let half_turns = libm::atan2(dot(axis_part, axis_e), turn[0]) / core::f64::consts::TAU;
        Some(Period { length, half_turns, axis_e })
    }

    /// Splits times since the start of the arc into whole periods and the rest, 0 <= rest < P up to round-off.
    #[inline(always)]
    pub fn fold<S: Simd>(&self, time: Lanes<S>) -> (Lanes<S>, Lanes<S>) {
        let (high, low) = (time.splat(self.length[0]), time.splat(self.length[1]));
        let inverse = time.splat(1.0 / self.length[0]);
        let whole = (time * inverse).floor();
        // whole * high is exact: one rounding in all
        let rest = (-whole).mul_add(low, (-whole).mul_add(high, time));
        let zero = time.zero();
        let one = time.splat(1.0);
        // the quotient may have rounded up to the next whole number
        let below = rest.lt(zero);
        let rest = Real::select(below, rest + high, rest);
        let whole = Real::select(below, whole - one, whole);
        (whole, rest)
    }

    /// Quaternion of `whole` periods.
    #[inline(always)]
    pub fn turn<S: Simd>(&self, whole: Lanes<S>) -> [Lanes<S>; 4] {
        // exact as a sum of two: only the error of half_turns grows with the number of periods
        let half_turns = whole.splat(self.half_turns);
        let high = whole * half_turns;
        let low = whole.mul_add(half_turns, -high);
        let (sin, cos) = sin_cos_turns((high - high.round()) + low);
        let [x, y, z] = scaled(sin, constant(whole, self.axis_e));
        [cos, x, y, z]
    }
}

/// Share of |J| |omega| below which the angular momentum does not define the axis.
const SMALL_MOMENTUM: f64 = 1e-3;
/// Sine below which the vector part of the rotation does not give the axis to full precision.
const SMALL_SINE: f64 = 0.1;
