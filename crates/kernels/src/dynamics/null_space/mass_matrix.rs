//! M-hat = Pi^T M Pi (25) and its solution by Cholesky's method.
//!
//! M-hat has the blocks spacecraft (v_p, omega_s, wheel rates), m_d 1 and J_d. The v_p block m 1 has the factor sqrt(m)
//! 1; only omega_s and the wheel rates are factored. A wheel of constant speed has the row and column of the unit
//! matrix.

#![expect(clippy::needless_range_loop, reason = "indices of a matrix, as in the formulas")]

use super::kinematics::{WheelMotion, for_each_wheel, lever};
use super::parameters::Parameters;
use super::state::State;
use crate::math::prelude::*;

/// A lower triangular Cholesky factor with the reciprocals on its diagonal.
pub type Factor<const N: usize> = [[f64; N]; N];

/// Spacecraft block of M-hat with `W` wheels.
#[derive(Clone, Copy, Debug)]
pub struct SpacecraftMass<const W: usize> {
    /// v_p with v_p: m, times the unit matrix, kg.
    pub total: f64,
    /// v_p (rows) with omega_s (columns), by columns, kg m: -C_es (c_s + sum m_i z_i)^x.
    pub coupling: [[f64; 3]; 3],
    /// The block of omega_s and the wheel rates.
    pub rotation: RotationBlock<W>,
}

/// The block of omega_s and the wheel rates of a symmetric matrix (lower triangle), or its Cholesky factor; kg m^2.
#[derive(Clone, Copy, Debug)]
pub struct RotationBlock<const W: usize> {
    pub omega: [[f64; 3]; 3],
    /// Wheel rates (rows) with omega_s.
    pub mixed: [[f64; 3]; W],
    /// Wheel rates with themselves.
    pub wheels: [[f64; W]; W],
}

impl<const W: usize> SpacecraftMass<W> {
    #[inline(always)]
    pub fn of(parameters: &Parameters<W>, state: &State<W>, wheels: &[WheelMotion; W]) -> Self {
        let minus = lever(state.fuselage.dcm, parameters.first);
        let mut rotation = RotationBlock { omega: [[0.0; 3]; 3], mixed: [[0.0; 3]; W], wheels: [[0.0; W]; W] };
        for i in 0..3 {
            for j in 0..=i {
                rotation.omega[i][j] = parameters.fuselage_inertia[i][j];
            }
        }
        for_each_wheel::<W>(
            #[inline(always)]
            |w| {
                let (wheel, motion) = (&parameters.wheels[w], &wheels[w]);
                let turned = [
                    product(wheel.inertia, motion.c_ws[0]),
                    product(wheel.inertia, motion.c_ws[1]),
                    product(wheel.inertia, motion.c_ws[2]),
                ];
                let axial = product(wheel.inertia, wheel.axis);
                for i in 0..3 {
                    for j in 0..=i {
                        rotation.omega[i][j] +=
                            wheel.mass.mul_add(dot(motion.lever[i], motion.lever[j]), dot(motion.c_ws[i], turned[j]));
                    }
                    rotation.mixed[w][i] = wheel.free * dot(axial, motion.c_ws[i]);
                }
                rotation.wheels[w][w] = wheel.free * dot(wheel.axis, axial) + wheel.idle;
            },
        );
        SpacecraftMass {
            total: parameters.total,
            coupling: [scaled(-1.0, minus[0]), scaled(-1.0, minus[1]), scaled(-1.0, minus[2])],
            rotation,
        }
    }

    /// (v_p-dot, omega_s-dot, wheel accelerations) from their right-hand sides.
    #[inline(always)]
    pub fn solution(&self, force: [f64; 3], torque: [f64; 3], axial: [f64; W]) -> ([f64; 3], [f64; 3], [f64; W]) {
        let root = 1.0 / self.total.sqrt();
        // no `map`: it is compiled without the caller's instructions
        let b = [scaled(root, self.coupling[0]), scaled(root, self.coupling[1]), scaled(root, self.coupling[2])];
        let mut rest = self.rotation;
        for i in 0..3 {
            for j in 0..=i {
                rest.omega[i][j] -= dot(b[i], b[j]);
            }
        }
        let y = scaled(root, force);
        let mut right = torque;
        for i in 0..3 {
            right[i] -= dot(b[i], y);
        }
        let (omega, wheels) = rest.factor().solved(right, axial);
        let mut v = y;
        for i in 0..3 {
            let sum = b[0][i].mul_add(omega[0], b[1][i].mul_add(omega[1], b[2][i] * omega[2]));
            v[i] = (y[i] - sum) * root;
        }
        (v, omega, wheels)
    }
}

impl<const W: usize> RotationBlock<W> {
    /// Cholesky factor with reciprocals on its diagonal, by the operations of [`cholesky`].
    #[inline(always)]
    pub fn factor(&self) -> Self {
        let omega = cholesky(self.omega);
        let (mut mixed, mut wheels) = (self.mixed, self.wheels);
        for w in 0..W {
            for j in 0..3 {
                let mut x = mixed[w][j];
                for k in 0..j {
                    x = (-mixed[w][k]).mul_add(omega[j][k], x);
                }
                mixed[w][j] = x * omega[j][j];
            }
        }
        for j in 0..W {
            for i in j..W {
                let mut x = wheels[i][j];
                for k in 0..3 {
                    x = (-mixed[i][k]).mul_add(mixed[j][k], x);
                }
                wheels[i][j] = x;
            }
        }
        RotationBlock { omega, mixed, wheels: cholesky(wheels) }
    }

    /// L^-T L^-1 of the rows of omega_s and the wheel rates, with this factor L.
    #[inline(always)]
    pub fn solved(&self, omega: [f64; 3], wheels: [f64; W]) -> ([f64; 3], [f64; W]) {
        let mut x = forward(&self.omega, omega);
        let mut y = wheels;
        for w in 0..W {
            for k in 0..3 {
                y[w] = (-self.mixed[w][k]).mul_add(x[k], y[w]);
            }
        }
        y = backward(&self.wheels, forward(&self.wheels, y));
        for i in (0..3).rev() {
            for k in i + 1..3 {
                x[i] = (-self.omega[k][i]).mul_add(x[k], x[i]);
            }
            for w in 0..W {
                x[i] = (-self.mixed[w][i]).mul_add(y[w], x[i]);
            }
            x[i] *= self.omega[i][i];
        }
        (x, y)
    }
}

/// The Cholesky factor of a symmetric positive definite matrix, from its lower triangle.
#[inline(always)]
pub fn cholesky<const N: usize>(a: [[f64; N]; N]) -> Factor<N> {
    let mut l = a;
    for j in 0..N {
        let mut pivot = l[j][j];
        for k in 0..j {
            pivot = (-l[j][k]).mul_add(l[j][k], pivot);
        }
        let reciprocal = 1.0 / pivot.sqrt();
        for i in j + 1..N {
            let mut x = l[i][j];
            for k in 0..j {
                x = (-l[i][k]).mul_add(l[j][k], x);
            }
            l[i][j] = x * reciprocal;
        }
        l[j][j] = reciprocal;
    }
    l
}

#[inline(always)]
pub fn solved<const N: usize>(l: &Factor<N>, right: [f64; N]) -> [f64; N] {
    backward(l, forward(l, right))
}

#[inline(always)]
fn forward<const N: usize>(l: &Factor<N>, right: [f64; N]) -> [f64; N] {
    let mut x = right;
    for i in 0..N {
        for k in 0..i {
            x[i] = (-l[i][k]).mul_add(x[k], x[i]);
        }
        x[i] *= l[i][i];
    }
    x
}

#[inline(always)]
fn backward<const N: usize>(l: &Factor<N>, right: [f64; N]) -> [f64; N] {
    let mut x = right;
    for i in (0..N).rev() {
        for k in i + 1..N {
            x[i] = (-l[k][i]).mul_add(x[k], x[i]);
        }
        x[i] *= l[i][i];
    }
    x
}
