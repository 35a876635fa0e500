//! Layer 1: what is simulated. Bodies to mass properties, actuators, initial state; validated, immutable, SI, no serde.
//!
//! - [`schema`]: one row for each numeric key: unit, meaning, default, limit, where it is.
//! - [`input`]: the scene as written.
//! - [`second_moment`]: inertia by second moments of mass, and errors of a distribution of mass.
//! - [`solids`]: mass, centre and inertia of homogeneous solids (the report's (60)-(67), in closed form).
//! - [`mass`]: mass properties of the bodies and of the whole.
//! - [`parameter`]: the numeric keys that can be dispersed.
//! - [`check`], [`error`]: what makes a scene physical beyond single keys, and the message where it is not.
//! - [`resolve`]: from an input to a [`Scene`].
//! - [`schedule`]: what the actuators make of the commands, and the arcs of constant actuation.

pub mod check;
pub mod error;
pub mod input;
pub mod mass;
pub mod parameter;
#[cfg(test)]
mod refusals;
pub mod resolve;
#[cfg(test)]
pub(crate) mod samples;
pub mod schedule;
pub mod schema;
pub mod second_moment;
pub mod solids;

pub use error::SceneError;
pub use input::SceneInput;
pub use mass::MassProperties;
pub use parameter::Parameter;
pub use schedule::{Actuation, Arc, THRUSTERS, WHEELS};
pub use schema::{
    ActuationInput, ActuatorsInput, DebrisInput, EnvironmentInput, FuselageInput, InitialInput, MassErrors,
    PrincipalInertia, PrincipalMoments, WheelInput, WheelMode,
};

use crate::math::vector::{cross, difference, scaled, sum};

/// A physically valid scene: everything that a kernel starts from.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// Mass properties of all bodies and of the spacecraft as a whole.
    pub mass: MassProperties,
    /// The state at time zero.
    pub initial: InitialState,
    /// Distance rho_p of the thrusters P2 and P3 from the axis s3, m.
    pub thruster_offset: f64,
    /// Station l_s of the thrusters P2 and P3 on the axis s3, m.
    pub thruster_station: f64,
    /// Directions in which the thrusts P1, P2, P3 push, unit vectors in F_s: nominally s3, -s3, -s3.
    pub thruster_directions: [[f64; 3]; 3],
    /// Arcs of constant actuation as they are applied, in order, not overlapping, each with start < end.
    pub schedule: Vec<Arc>,
    /// Torques of the environment, as written.
    pub environment: EnvironmentInput,
    /// Whether the schedule commands thrust at all, whatever the thrusters make of it.
    pub commands_thrust: bool,
    /// The same of motor torque.
    pub commands_torque: bool,
}

/// The nominal directions of the thrusts P1, P2, P3 in F_s (72).
pub const THRUSTER_DIRECTIONS: [[f64; 3]; 3] = [[0.0, 0.0, 1.0], [0.0, 0.0, -1.0], [0.0, 0.0, -1.0]];

/// The full state at time zero, in the frames that the kernels use.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InitialState {
    /// Position of p, m.
    pub r_po_e: [f64; 3],
    /// Velocity of p, m/s.
    pub v_po_e: [f64; 3],
    /// Attitude of the fuselage, F_s -> F_e, unit norm.
    pub q_es: [f64; 4],
    /// Angular velocity of the fuselage, rad/s.
    pub omega_se_s: [f64; 3],
    /// Wheel angles alpha, beta, rad.
    pub wheel_angles: [f64; 2],
    /// Wheel rates relative to the fuselage, rad/s.
    pub wheel_rates: [f64; 2],
    /// Position of the debris's centre, m.
    pub r_gdo_e: [f64; 3],
    /// Velocity of the debris's centre, m/s.
    pub v_gdo_e: [f64; 3],
    /// Attitude of the debris, F_d -> F_e, unit norm: q_es (x) q_sd.
    pub q_ed: [f64; 4],
    /// Angular velocity omega^de of the debris in F_d, rad/s: omega^ds + C_ds omega^se (59).
    pub omega_de_d: [f64; 3],
}

impl Scene {
    /// Force of the thrusts P1, P2, P3 in F_s, N (72).
    pub fn thruster_force_s(&self, thrust: [f64; 3]) -> [f64; 3] {
        if self.thruster_directions == THRUSTER_DIRECTIONS {
            return [0.0, 0.0, thrust[0] - thrust[1] - thrust[2]];
        }
        let [p1, p2, p3] = self.thruster_directions;
        sum(scaled(thrust[0], p1), sum(scaled(thrust[1], p2), scaled(thrust[2], p3)))
    }

    /// Torque of the thrusts P1, P2, P3 about the spacecraft's centre of mass c, in F_s, N m (72).
    ///
    /// P1 acts at p, P2 at (0, -rho_p, l_s), P3 at (0, +rho_p, l_s).
    pub fn thruster_torque_s(&self, thrust: [f64; 3]) -> [f64; 3] {
        let c = self.mass.center;
        if self.thruster_directions != THRUSTER_DIRECTIONS {
            let (offset, station) = (self.thruster_offset, self.thruster_station);
            let points = [[0.0; 3], [0.0, -offset, station], [0.0, offset, station]];
            let of = |k: usize| cross(difference(points[k], c), scaled(thrust[k], self.thruster_directions[k]));
            return sum(of(0), sum(of(1), of(2)));
        }
        let force = thrust[0] - thrust[1] - thrust[2];
        // about p, minus c x F
        [self.thruster_offset * (thrust[1] - thrust[2]) - c[1] * force, c[0] * force, 0.0]
    }
}
