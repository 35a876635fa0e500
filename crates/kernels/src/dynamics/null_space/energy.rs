//! Kinetic energies (36) of fuselage, wheels and debris in F_e: T_b = 1/2 nu_b^T M_b nu_b.

use super::kinematics::WheelMotion;
use super::parameters::Parameters;
use super::state::{State, rotated_back};
use crate::math::prelude::*;

/// The kinetic energies of the bodies, J.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KineticEnergies<const W: usize> {
    /// Fuselage.
    pub fuselage: f64,
    /// Wheels; zero for a missing one.
    pub wheels: [f64; W],
    /// Debris; zero if missing.
    pub debris: f64,
}

impl<const W: usize> KineticEnergies<W> {
    /// Total, J.
    pub fn total(&self) -> f64 {
        self.fuselage + self.wheels.iter().sum::<f64>() + self.debris
    }
}

/// The kinetic energies of the bodies in `state`.
#[inline(always)]
pub fn kinetic_energies<const W: usize>(parameters: &Parameters<W>, state: &State<W>) -> KineticEnergies<W> {
    let energy = |mass: f64, v: [f64; 3], inertia: [[f64; 3]; 3], omega: [f64; 3]| {
        0.5 * (mass * dot(v, v) + dot(omega, product(inertia, omega)))
    };
    // M_s has the first moment: 1/2 m v_p^2 + v_p . C (omega x c) + 1/2 omega . J_p omega
    let omega = state.omega_s;
    let coupling = dot(rotated_back(state.fuselage.dcm, state.v_p), cross(omega, parameters.fuselage_first));
    let fuselage = energy(parameters.fuselage_mass, state.v_p, parameters.fuselage_inertia, omega) + coupling;
    let wheel = |w: usize| {
        let motion = WheelMotion::of(&parameters.wheels[w], state, w);
        energy(parameters.wheels[w].mass, motion.velocity, parameters.wheels[w].inertia, motion.omega)
    };
    let debris = energy(parameters.debris_mass, state.v_gd, parameters.debris_inertia, state.omega_d);
    KineticEnergies { fuselage, wheels: std::array::from_fn(wheel), debris }
}
