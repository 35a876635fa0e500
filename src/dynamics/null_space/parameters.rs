//! The constants of a scene in the null-space formulation.

use crate::scene::Scene;
use crate::scene::WheelMode;
use crate::scene::mass::{Body, Wheel};

/// The constants of a scene. Absent bodies remain in the equations, decoupled: a missing wheel has zero mass and inertia and a
/// unit on its diagonal of M-hat, missing debris is a body of unit mass and inertia at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameters {
    /// Mass m_s of the fuselage, kg.
    pub fuselage_mass: f64,
    /// First moment c_s of the fuselage about p, in F_s, kg m.
    pub fuselage_first: [f64; 3],
    /// Inertia J_s of the fuselage about p, in F_s, kg m^2, by rows.
    pub fuselage_inertia: [[f64; 3]; 3],
    /// The wheels.
    pub wheels: [WheelParameters; 2],
    /// Mass of fuselage and wheels, kg.
    pub total: f64,
    /// First moment of fuselage and wheels about p, kg m.
    pub first: [f64; 3],
    /// Mass of the debris, kg.
    pub debris_mass: f64,
    /// Inertia of the debris about its centre, in F_d, kg m^2, by rows.
    pub debris_inertia: [[f64; 3]; 3],
    /// Points of application of P1, P2, P3, from p in F_s, m: p, (0, -rho_p, l_s), (0, +rho_p, l_s).
    pub thruster_points: [[f64; 3]; 3],
    /// Directions of the thrusts, unit vectors in F_s.
    pub thruster_directions: [[f64; 3]; 3],
    /// Centre of mass c of the spacecraft from p in F_s, m.
    pub center: [f64; 3],
}

/// The constants of a wheel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WheelParameters {
    /// Mass, kg; zero if missing.
    pub mass: f64,
    /// Centre z from p in F_s, m.
    pub center: [f64; 3],
    /// Unit spin axis, in F_s and in the wheel's frame.
    pub axis: [f64; 3],
    /// Inertia about the centre in the wheel's frame, kg m^2, by rows.
    pub inertia: [[f64; 3]; 3],
    /// One if the wheel's rate is an unknown of M-hat; zero if its motor keeps it constant, and its row says that the rate does
    /// not change.
    pub free: f64,
    /// Added to a^T J a on the diagonal of M-hat: zero, or one if the wheel is missing or of constant speed.
    pub idle: f64,
}

impl WheelParameters {
    fn of(wheel: &Wheel) -> Self {
        let is_free = wheel.mode == WheelMode::Free;
        WheelParameters {
            mass: wheel.mass,
            center: wheel.center,
            axis: wheel.axis,
            inertia: wheel.inertia(),
            free: if is_free { 1.0 } else { 0.0 },
            idle: if wheel.is_present() && is_free { 0.0 } else { 1.0 },
        }
    }
}

impl Parameters {
    /// The constants of `scene`.
    pub fn of(scene: &Scene) -> Self {
        const UNIT: Body =
            Body { mass: 1.0, center: [0.0; 3], inertia: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] };
        let mass = &scene.mass;
        let wheels = [WheelParameters::of(&mass.wheels[0]), WheelParameters::of(&mass.wheels[1])];
        let fuselage_first = mass.fuselage.first_moment();
        let mut first = fuselage_first;
        for wheel in &wheels {
            for (sum, z) in first.iter_mut().zip(wheel.center) {
                *sum = wheel.mass.mul_add(z, *sum);
            }
        }
        let debris = mass.debris.unwrap_or(UNIT);
        Parameters {
            fuselage_mass: mass.fuselage.mass,
            fuselage_first,
            fuselage_inertia: mass.fuselage.inertia_about_origin(),
            wheels,
            total: mass.total,
            first,
            debris_mass: debris.mass,
            debris_inertia: debris.inertia,
            thruster_points: [
                [0.0; 3],
                [0.0, -scene.thruster_offset, scene.thruster_station],
                [0.0, scene.thruster_offset, scene.thruster_station],
            ],
            thruster_directions: scene.thruster_directions,
            center: mass.center,
        }
    }
}
