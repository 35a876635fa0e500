//! Gragg-Bulirsch-Stoer extrapolation of the modified midpoint rule: an integrator for tests that shares nothing with the crate's.
//!
//! Source: Hairer, Norsett & Wanner (1993), II.9, harmonic sequence of even numbers, eight columns: order 16.

use spindrift::math::Isa;
use spindrift::math::isa::Work;
use spindrift::ode::System;

/// Basic step, s: a wheel at 340 rad/s turns by 0.7 rad, whose order-16 error is far below rounding (at 1.6 rad it is 1e-11).
const STEP: f64 = 0.002;

/// The state after `duration` seconds from `state`.
pub fn integrate<const N: usize, Y: System<f64, N>>(system: &Y, state: [f64; N], duration: f64) -> [f64; N] {
    Isa::best().run(Integrate { system, state, duration })
}

struct Integrate<'a, Y, const N: usize> {
    system: &'a Y,
    state: [f64; N],
    duration: f64,
}

impl<const N: usize, Y: System<f64, N>> Work for Integrate<'_, Y, N> {
    type Output = [f64; N];

    #[inline(always)]
    fn run<S: fearless_simd::Simd>(self, _simd: S) -> [f64; N] {
        const COLUMNS: usize = 8;
        let steps = (self.duration / STEP).ceil().max(1.0);
        let big = self.duration / steps;
        let mut x = self.state;
        for _ in 0..steps as usize {
            let mut table = [[0.0; N]; COLUMNS];
            for row in 0..COLUMNS {
                let n = 2 * (row + 1);
                let h = big / n as f64;
                let f = self.system.derivative(0.0, &x);
                let mut before = x;
                let mut here: [f64; N] = std::array::from_fn(|i| x[i] + h * f[i]);
                for _ in 1..n {
                    let f = self.system.derivative(0.0, &here);
                    let after = std::array::from_fn(|i| before[i] + 2.0 * h * f[i]);
                    before = std::mem::replace(&mut here, after);
                }
                let f = self.system.derivative(0.0, &here);
                let smooth: [f64; N] = std::array::from_fn(|i| 0.5 * (here[i] + before[i] + h * f[i]));
                // Aitken-Neville, in place: table[k] holds column k of the row before
                let mut previous = smooth;
                for (column, above) in table.iter_mut().enumerate().take(row) {
                    let ratio = (row + 1) as f64 / (row - column) as f64;
                    let next = std::array::from_fn(|i| previous[i] + (previous[i] - above[i]) / (ratio * ratio - 1.0));
                    *above = std::mem::replace(&mut previous, next);
                }
                table[row] = previous;
            }
            x = table[COLUMNS - 1];
        }
        x
    }
}
