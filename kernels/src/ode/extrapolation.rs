//! [`Extrapolation`]: steps of high order in any arithmetic, for reference solutions.
//!
//! Gragg's midpoint rule with 2, 4, 6, ... parts, without smoothing, extrapolated to parts of zero length by Neville's
//! scheme in the square of their length (E. Hairer, S. Norsett & G. Wanner, *Solving Ordinary Differential Equations
//! I*, 1993, section II.9, (9.10) and (9.13)); order 2j after j columns. Its coefficients are ratios of integers, exact
//! in any arithmetic; those of Runge-Kutta methods of order 8 are published with 16 to 20 digits.

use super::explicit::{Step, each};
use super::system::{System, Tolerance};
use crate::math::real::{Mask, Real};

/// Limit of columns: order 28, 210 evaluations.
pub const COLUMNS: usize = 14;

/// Memory for a step.
pub struct Extrapolation<R, const N: usize> {
    /// The last row of Neville's scheme.
    row: [[R; N]; COLUMNS],
}

impl<R: Real, const N: usize> Extrapolation<R, N> {
    /// Memory in the arithmetic of `zero`.
    pub fn new(zero: R) -> Self {
        Extrapolation { row: [[zero; N]; COLUMNS] }
    }

    /// Takes a step from `start` with the derivative `slope`: the state at its end, and the number of columns until the
    /// last two agreed to the tolerance; `None` if they never do.
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
            let (mut before, mut now) = (
                *start,
                each(
                    length,
                    #[inline(always)]
                    |n| length.mul_add(slope[n], start[n]),
                ),
            );
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::double_double::DoubleDouble;

    /// y'' = -y.
    struct Oscillator;

    impl System<DoubleDouble, 2> for Oscillator {
        fn derivative(&self, _time: DoubleDouble, [y, v]: &[DoubleDouble; 2]) -> [DoubleDouble; 2] {
            [*v, -*y]
        }

        fn error_ratio(
            &self,
            error: &[DoubleDouble; 2],
            _old: &[DoubleDouble; 2],
            _new: &[DoubleDouble; 2],
            tolerance: Tolerance,
        ) -> DoubleDouble {
            error[0].abs().larger(error[1].abs()) / DoubleDouble::exact(tolerance.absolute)
        }
    }

    /// Truth: sine and cosine of 1 to 32 digits. A step converges to the tolerance, and to no less than rounding.
    #[test]
    fn an_oscillator_has_the_digits_of_its_tolerance() {
        let exact = DoubleDouble::exact;
        let truth = [
            DoubleDouble { high: 0.841_470_984_807_896_5, low: 1.776_845_092_935_536e-18 },
            DoubleDouble { high: 0.540_302_305_868_139_8, low: -4.760_954_612_604_417e-17 },
        ];
        let mut extrapolation = Extrapolation::new(exact(0.0));
        for tolerance in [1e-6, 1e-12, 1e-18, 1e-24] {
            let asked = Tolerance { relative: tolerance, absolute: tolerance };
            let mut state = [exact(0.0), exact(1.0)];
            for k in 0..4 {
                let (start, end) = (exact(0.25 * f64::from(k)), exact(0.25 * f64::from(k + 1)));
                let step = Step { time: start, end, length: end - start };
                let slope = Oscillator.derivative(start, &state);
                (state, _) = extrapolation.step(&Oscillator, step, [&state, &slope], asked).expect("it converges");
            }
            let off = [0, 1].map(|n| (state[n] - truth[n]).high.abs());
            println!("{tolerance:e}: {off:?}");
            assert!(off[0] < tolerance && off[1] < tolerance, "{tolerance:e}: {off:?}");
        }
        let step = Step { time: exact(0.0), end: exact(60.0), length: exact(60.0) };
        let state = [exact(0.0), exact(1.0)];
        let slope = Oscillator.derivative(exact(0.0), &state);
        let asked = Tolerance { relative: 1e-20, absolute: 1e-20 };
        assert!(extrapolation.step(&Oscillator, step, [&state, &slope], asked).is_none());
    }
}
