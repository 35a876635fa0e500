//! The constants of a scene in the null-space formulation.

use crate::math::list::List;
use crate::scene::mass::{Body, Wheel};
use crate::scene::{MAX_THRUSTERS, Scene, Thruster, WheelMode};

/// Constants of a scene for a kernel of `W` wheels. Missing bodies are decoupled: a wheel of zero mass and inertia with
/// a unit on its diagonal of M-hat; debris of unit mass and inertia at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameters<const W: usize> {
    /// Mass m_s of the fuselage, kg.
    pub fuselage_mass: f64,
    /// First moment c_s of the fuselage about p, in F_s, kg m.
    pub fuselage_first: [f64; 3],
    /// Inertia J_s of the fuselage about p, in F_s, kg m^2, by rows.
    pub fuselage_inertia: [[f64; 3]; 3],
    /// The wheels.
    pub wheels: [WheelParameters; W],
    /// Mass of fuselage and wheels, kg.
    pub total: f64,
    /// First moment of fuselage and wheels about p, kg m.
    pub first: [f64; 3],
    /// Mass of the debris, kg.
    pub debris_mass: f64,
    /// Inertia of the debris about its centre, in F_d, kg m^2, by rows.
    pub debris_inertia: [[f64; 3]; 3],
    /// The thrusters.
    pub thrusters: List<Thruster, MAX_THRUSTERS>,
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
    /// One if the wheel's rate is an unknown of M-hat; zero for constant speed.
    pub free: f64,
    /// One on the diagonal of M-hat beside a^T J a if the wheel is missing or of constant speed, else zero.
    pub idle: f64,
}

impl WheelParameters {
    const MISSING: WheelParameters = WheelParameters {
        mass: 0.0,
        center: [0.0; 3],
        axis: [0.0, 1.0, 0.0],
        inertia: [[0.0; 3]; 3],
        free: 1.0,
        idle: 1.0,
    };

    fn of(wheel: &Wheel) -> Self {
        let is_free = wheel.mode == WheelMode::Free;
        WheelParameters {
            mass: wheel.mass,
            center: wheel.center,
            axis: wheel.axis,
            inertia: wheel.inertia(),
            free: if is_free { 1.0 } else { 0.0 },
            idle: if is_free { 0.0 } else { 1.0 },
        }
    }
}

impl<const W: usize> Parameters<W> {
    /// The constants of `scene`, which has at most `W` wheels.
    pub fn of(scene: &Scene) -> Self {
        const UNIT: Body =
            Body { mass: 1.0, center: [0.0; 3], inertia: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] };
        let mass = &scene.mass;
        let wheels = std::array::from_fn(|i| mass.wheels.get(i).map_or(WheelParameters::MISSING, WheelParameters::of));
        let fuselage_first = mass.body.first_moment();
        let mut first = fuselage_first;
        for wheel in &wheels {
            for (sum, z) in first.iter_mut().zip(wheel.center) {
                *sum = wheel.mass.mul_add(z, *sum);
            }
        }
        let debris = mass.debris.unwrap_or(UNIT);
        let mut thrusters = List::empty(Thruster { position: [0.0; 3], direction: [0.0; 3] });
        for thruster in &scene.thrusters {
            thrusters.push(*thruster);
        }
        Parameters {
            fuselage_mass: mass.body.mass,
            fuselage_first,
            fuselage_inertia: mass.body.inertia_about_origin(),
            wheels,
            total: mass.total,
            first,
            debris_mass: debris.mass,
            debris_inertia: debris.inertia,
            thrusters,
            center: mass.center,
        }
    }
}
