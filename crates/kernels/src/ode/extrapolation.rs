//! [`Extrapolation`]: steps of high order in any arithmetic, for reference solutions.
//!
//! Gragg's midpoint rule with 2, 4, 6, ... parts, without smoothing, extrapolated by Neville's scheme in the square of
//! their length (Hairer, Norsett & Wanner 1993, section II.9, (9.10) and (9.13)); order 2j after j columns.
//! Coefficients are ratios of integers, exact in any arithmetic, unlike the digits published for Runge-Kutta methods.

use super::explicit::{Step, each};
use super::system::{System, Tolerance};
use crate::math::real::{Mask, Real};

/// Limit of columns: order 28, 210 evaluations.
pub const COLUMNS: usize = 14;

pub struct Extrapolation<R, const N: usize> {
    /// The last row of Neville's scheme.
    row: [[R; N]; COLUMNS],
}

impl<R: Real, const N: usize> Extrapolation<R, N> {
    pub fn new(zero: R) -> Self {
        Extrapolation { row: [[zero; N]; COLUMNS] }
    }

    /// Takes a step from `start` with the derivative `slope`. Returns its end, and the number of columns after which
    /// two agree to the tolerance; `None` if they never do.
    #[inline(always)]
    pub fn step<Q: System<R, N>>(
        &mut self,
        system: &Q,
        step: Step<R>,
        [start, slope]: [&[R; N]; 2],
        tolerance: Tolerance,
    ) -> Option<([R; N], usize)> {
        let number = |value: usize| step.time.splat(value as f64);
        for j in 0..COLUMNS {
            let parts = 2 * (j + 1);
            let length = step.length / number(parts);
            let (mut before, mut now) = (*start, each!(length, |n| length.mul_add(slope[n], start[n])));
            for part in 1..parts {
                let rate = system.derivative(number(part).mul_add(length, step.time), &now);
                let twice = length + length;
                for n in 0..N {
                    (before[n], now[n]) = (now[n], twice.mul_add(rate[n], before[n]));
                }
            }
            let mut difference = now;
            for k in 0..j {
                let (fine, coarse) = ((j + 1) * (j + 1), (j - k) * (j - k));
                let weight = number(coarse) / number(fine - coarse);
                for n in 0..N {
                    difference[n] = weight * (now[n] - self.row[k][n]);
                    (self.row[k][n], now[n]) = (now[n], now[n] + difference[n]);
                }
            }
            self.row[j] = now;
            let one = number(1);
            if j > 1 && !(!system.error_ratio(&difference, start, &now, tolerance).lt(one)).any() {
                return Some((now, j + 1));
            }
        }
        None
    }
}
