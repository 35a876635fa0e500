//! Layer 1: the simulated scene: mass properties, actuators, initial state; validated, SI.

pub(crate) mod actuated;
pub(crate) mod alignment;
pub mod body;
pub mod check;
pub mod epoch;
pub mod error;
mod failures;
pub mod input;
pub mod mass;
pub(crate) mod name;
pub mod orbit;
pub mod parameter;
pub(crate) mod plate;
pub(crate) mod resolve;
#[cfg(test)]
pub(crate) mod samples;
pub mod schedule;
pub mod schema;
pub(crate) mod second_moment;
pub(crate) mod solids;
mod surroundings;
pub mod table;
mod tensor;
pub mod thruster;
pub mod unit_quaternion;
pub(crate) mod wheel;

pub use actuated::Actuated;
pub use epoch::Epoch;
pub use error::SceneError;
pub use input::SceneInput;
pub use mass::MassProperties;
pub use name::Name;
pub use orbit::{LocalFrame, Offset, Offsets, Orbit};
pub use parameter::Parameter;
pub use plate::Plate;
pub use schedule::{Actuation, Arc};
pub use schema::{
    ActuationInput, ActuatorsInput, ArcErrors, BodyInput, ControlInput, DebrisInput, DeclaredTable, Device,
    EnvironmentInput, FailureInput, FieldModel, InitialInput, LawParameter, MAX_PLATES, MAX_THRUSTERS, MAX_TORQUE_RODS,
    MAX_WHEELS, MassErrors, OrbitInput, PartInput, PartShape, PlateInput, PrincipalInertia, PrincipalMoments,
    SensorOutput, Shadow, ThrusterInput, TorqueRodInput, WheelInput, WheelMode,
};

pub use thruster::Thruster;

/// A physically valid scene, the input of kernels.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// Mass properties of all bodies and of the spacecraft.
    pub mass: MassProperties,
    /// The state at time zero.
    pub initial: InitialState,
    /// The thrusters.
    pub thrusters: Vec<Thruster>,
    /// The torque rods.
    pub torque_rods: Vec<TorqueRod>,
    /// Arcs of constant actuation as applied, in order, not overlapping.
    pub schedule: Vec<Arc>,
    /// Orbit of the centre of mass; `None` without gravity.
    pub orbit: Option<Orbit>,
    /// Plates, if air or light acts.
    pub plates: Vec<Plate>,
    /// Positions of spacecraft and debris relative to the orbit at time zero, if they may leave it.
    pub offsets: Option<Offsets>,
    /// Effects of the environment, as written.
    pub environment: EnvironmentInput,
    /// True if the schedule commands thrust, even if the thrusters apply none.
    pub commands_thrust: bool,
    /// True if the schedule commands motor torque.
    pub commands_torque: bool,
    /// Actuator models for commands of a control law.
    pub actuators: ActuatorModels,
    /// Failures during a run, as in the schedule.
    pub failures: Vec<FailureInput>,
}

/// A torque rod: limit and response.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TorqueRod {
    /// Axis in F_s, a unit vector, with its alignment error.
    pub axis: [f64; 3],
    /// Largest commanded dipole, A m^2.
    pub limit: f64,
    /// Factor of the commanded dipole.
    pub scale: f64,
}

/// Response of the actuators to commands of a control law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ActuatorModels {
    /// Thrusters in order; ideal beyond.
    pub thrusters: [ThrusterModel; MAX_THRUSTERS],
    /// Turning wheels in order; ideal beyond.
    pub wheels: [WheelModel; MAX_WHEELS],
}

/// Response of a thruster.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThrusterModel {
    /// Factor of the commanded thrust.
    pub thrust_scale: f64,
    /// Largest commanded thrust, N; infinite without a limit.
    pub max_thrust: f64,
    /// Shortest firing, s.
    pub min_on_time: f64,
}

/// Response of a motor and its bearing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WheelModel {
    /// Factor of the commanded torque.
    pub torque_scale: f64,
    /// Torque added to the scaled torque unless the command is zero, N m.
    pub torque_bias: f64,
    /// Largest torque, N m; infinite without a limit.
    pub torque_limit: f64,
    /// Largest rate relative to the body, rad/s; infinite without a limit.
    pub speed_limit: f64,
    /// Coulomb friction, N m.
    pub coulomb_friction: f64,
    /// Viscous friction, N m s.
    pub viscous_friction: f64,
}

impl ThrusterModel {
    /// An ideal thruster.
    pub const IDEAL: ThrusterModel = ThrusterModel { thrust_scale: 1.0, max_thrust: f64::INFINITY, min_on_time: 0.0 };
}

impl WheelModel {
    /// An ideal motor without friction.
    pub const IDEAL: WheelModel = WheelModel {
        torque_scale: 1.0,
        torque_bias: 0.0,
        torque_limit: f64::INFINITY,
        speed_limit: f64::INFINITY,
        coulomb_friction: 0.0,
        viscous_friction: 0.0,
    };
}

impl ActuatorModels {
    /// Ideal actuators.
    pub const IDEAL: ActuatorModels =
        ActuatorModels { thrusters: [ThrusterModel::IDEAL; MAX_THRUSTERS], wheels: [WheelModel::IDEAL; MAX_WHEELS] };

    /// Models of `input`.
    fn of(input: &SceneInput) -> Self {
        let mut models = Self::IDEAL;
        for (model, thruster) in models.thrusters.iter_mut().zip(&input.thrusters) {
            *model = ThrusterModel {
                thrust_scale: thruster.thrust_scale,
                max_thrust: thruster.max_thrust_n.unwrap_or(f64::INFINITY),
                min_on_time: thruster.min_on_time_s.unwrap_or(0.0),
            };
        }
        for (model, wheel) in models.wheels.iter_mut().zip(input.turning()) {
            *model = WheelModel {
                torque_scale: wheel.torque_scale,
                torque_bias: wheel.torque_bias_n_m,
                torque_limit: wheel.torque_limit_n_m.unwrap_or(f64::INFINITY),
                speed_limit: wheel.speed_limit_rad_s.unwrap_or(f64::INFINITY),
                coulomb_friction: wheel.coulomb_friction_n_m.unwrap_or(0.0),
                viscous_friction: wheel.viscous_friction_n_m_s.unwrap_or(0.0),
            };
        }
        models
    }
}

/// The full state at time zero, in the frames that the kernels use.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InitialState {
    /// Position of p, m.
    pub r_po_e: [f64; 3],
    /// Velocity of p, m/s.
    pub v_po_e: [f64; 3],
    /// Attitude of the body, F_s -> F_e, unit norm.
    pub q_es: [f64; 4],
    /// Angular velocity of the body, rad/s.
    pub omega_se_s: [f64; 3],
    /// Wheel angles relative to the body, rad; zero beyond the wheels.
    pub wheel_angles: [f64; MAX_WHEELS],
    /// Wheel rates relative to the body, rad/s; zero beyond the wheels.
    pub wheel_rates: [f64; MAX_WHEELS],
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
    /// Force of the thrusts `thrust` (N, by thruster) in F_s, N (72).
    pub fn thruster_force_s(&self, thrust: [f64; MAX_THRUSTERS]) -> [f64; 3] {
        thruster::force_s(&self.thrusters, thrust)
    }

    /// Their torque about the centre of mass c, F_s, N m (72).
    pub fn thruster_torque_s(&self, thrust: [f64; MAX_THRUSTERS]) -> [f64; 3] {
        thruster::torque_s(&self.thrusters, thrust, self.mass.center)
    }
}
