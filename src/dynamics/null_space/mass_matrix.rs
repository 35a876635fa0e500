//! M-hat = Pi^T M Pi (25) and its solution by Cholesky's method.
//!
//! M-hat is block diagonal: the spacecraft's 8x8 (v_p, omega_s, alpha-dot, beta-dot), m_d 1, J_d. In the 8x8 the block of v_p is
//! m 1, so that its part of the factor is sqrt(m) 1 and only a 5x5 remains to be factored.
//!
//! The rate of a wheel of constant speed is not an unknown; its row and column are those of the unit matrix, so that its rate of
//! change is zero.

#![expect(clippy::needless_range_loop, reason = "indices of a matrix, as in the formulas")]

use super::kinematics::{WheelMotion, lever};
use super::parameters::Parameters;
use super::state::State;
use crate::math::vector::{dot, product, scaled};

/// A lower triangular Cholesky factor with the reciprocals on its diagonal.
pub type Factor<const N: usize> = [[f64; N]; N];

/// The spacecraft's block of M-hat.
#[derive(Clone, Copy, Debug)]
pub struct SpacecraftMass {
    /// v_p with v_p: m, times the unit matrix, kg.
    pub total: f64,
    /// v_p (rows) with omega_s (columns), by columns, kg m: -C_es (c_s + m_1 z_1 + m_2 z_2)^x.
    pub coupling: [[f64; 3]; 3],
    /// (omega_s, alpha-dot, beta-dot) with themselves, kg m^2; the lower triangle is filled.
    pub rotation: [[f64; 5]; 5],
}

impl SpacecraftMass {
    /// Pi^T M Pi of fuselage and wheels.
    #[inline(always)]
    pub fn of(parameters: &Parameters, state: &State, wheels: &[WheelMotion; 2]) -> Self {
        let minus = lever(state.dcm[0], parameters.first);
        let mut rotation = [[0.0; 5]; 5];
        for i in 0..3 {
            for j in 0..=i {
                rotation[i][j] = parameters.fuselage_inertia[i][j];
            }
        }
        for (w, motion) in wheels.iter().enumerate() {
            let wheel = &parameters.wheels[w];
            // J C_ws, by columns, and J a
            let turned = [
                product(wheel.inertia, motion.c_ws[0]),
                product(wheel.inertia, motion.c_ws[1]),
                product(wheel.inertia, motion.c_ws[2]),
            ];
            let axial = product(wheel.inertia, wheel.axis);
            for i in 0..3 {
                for j in 0..=i {
                    rotation[i][j] +=
                        wheel.mass.mul_add(dot(motion.lever[i], motion.lever[j]), dot(motion.c_ws[i], turned[j]));
                }
                rotation[3 + w][i] = wheel.free * dot(axial, motion.c_ws[i]);
            }
            rotation[3 + w][3 + w] = wheel.free * dot(wheel.axis, axial) + wheel.idle;
        }
        SpacecraftMass {
            total: parameters.total,
            coupling: [scaled(-1.0, minus[0]), scaled(-1.0, minus[1]), scaled(-1.0, minus[2])],
            rotation,
        }
    }

    /// Solves for (v_p-dot, [omega_s-dot, alpha-dot-dot, beta-dot-dot]).
    #[inline(always)]
    pub fn solution(&self, force: [f64; 3], torque: [f64; 5]) -> ([f64; 3], [f64; 5]) {
        let root = 1.0 / self.total.sqrt();
        // not `map`: it is compiled separately, without the instructions of the caller
        let b = [scaled(root, self.coupling[0]), scaled(root, self.coupling[1]), scaled(root, self.coupling[2])];
        let mut rest = self.rotation;
        for i in 0..3 {
            for j in 0..=i {
                rest[i][j] -= dot(b[i], b[j]);
            }
        }
        let factor = cholesky(rest);
        let y = scaled(root, force);
        let mut right = torque;
        for i in 0..3 {
            right[i] -= dot(b[i], y);
        }
        let rotation = solved(&factor, right);
        let mut v = y;
        for i in 0..3 {
            let sum = b[0][i].mul_add(rotation[0], b[1][i].mul_add(rotation[1], b[2][i] * rotation[2]));
            v[i] = (y[i] - sum) * root;
        }
        (v, rotation)
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

/// L^-T L^-1 `right`.
#[inline(always)]
pub fn solved<const N: usize>(l: &Factor<N>, right: [f64; N]) -> [f64; N] {
    let mut x = right;
    for i in 0..N {
        for k in 0..i {
            x[i] = (-l[i][k]).mul_add(x[k], x[i]);
        }
        x[i] *= l[i][i];
    }
    for i in (0..N).rev() {
        for k in i + 1..N {
            x[i] = (-l[k][i]).mul_add(x[k], x[i]);
        }
        x[i] *= l[i][i];
    }
    x
}
