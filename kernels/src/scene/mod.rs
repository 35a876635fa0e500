//! Layer 1: what is simulated. Bodies to mass properties, actuators, initial state; validated, immutable, SI, no serde.
//!
//! - [`schema`]: one row for each numeric key: unit, meaning, default, limit, where it is.
//! - [`input`]: the scene as written. [`table`]: where in it the tables of the schema are.
//! - [`second_moment`]: inertia by second moments of mass, and errors of a distribution of mass.
//! - [`solids`]: mass, centre and inertia of homogeneous solids (Berdoz's (60)-(67), in closed form).
//! - [`body`]: the body of the spacecraft and the debris from their input. [`wheel`]: wheels that turn. `tensor`:
//!   inertias by rows.
//! - [`mass`]: mass properties of the whole. [`orbit`]: the orbit at time zero. [`epoch`]: its date.
//! - [`parameter`]: the numeric keys that can be dispersed.
//! - [`check`], [`error`]: what makes a scene physical beyond single keys, and the message where it is not.
//!   `surroundings`: for air and light.
//! - [`actuated`]: what acts on a spacecraft at any time of a run.
//! - [`resolve`]: from an input to a [`Scene`].
//! - [`plate`]: the plates that air and light push.
//! - [`thruster`]: force and torque of thrusters. [`alignment`]: axes and directions, and their errors. [`name`]:
//!   names.
//! - [`unit_quaternion`]: the attitude that is used where one is written.
//! - `failures`: what failures of actuators make of a schedule.
//! - [`schedule`]: what the actuators make of the commands, and the arcs of constant actuation.

pub mod actuated;
pub mod alignment;
pub mod body;
pub mod check;
pub mod epoch;
pub mod error;
mod failures;
pub mod input;
pub mod mass;
pub mod name;
pub mod orbit;
pub mod parameter;
pub mod plate;
#[cfg(test)]
mod refusals;
pub mod resolve;
#[cfg(test)]
pub(crate) mod samples;
pub mod schedule;
pub mod schema;
pub mod second_moment;
pub mod solids;
mod surroundings;
pub mod table;
mod tensor;
pub mod thruster;
pub mod unit_quaternion;
pub mod wheel;

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

/// A physically valid scene: everything that a kernel starts from.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// Mass properties of all bodies and of the spacecraft as a whole.
    pub mass: MassProperties,
    /// The state at time zero.
    pub initial: InitialState,
    /// The thrusters.
    pub thrusters: Vec<Thruster>,
    /// The torque rods.
    pub torque_rods: Vec<TorqueRod>,
    /// Arcs of constant actuation as they are applied, in order, not overlapping, each with start < end.
    pub schedule: Vec<Arc>,
    /// The orbit of the centre of mass; `None` where gravity is neglected.
    pub orbit: Option<Orbit>,
    /// The plates that air and light push, where one of them acts.
    pub plates: Vec<Plate>,
    /// Where spacecraft and debris are relative to the orbit at time zero, where they may leave it.
    pub offsets: Option<Offsets>,
    /// Effects of the environment, as written.
    pub environment: EnvironmentInput,
    /// Whether the schedule commands thrust at all, whatever the thrusters make of it.
    pub commands_thrust: bool,
    /// The same of motor torque.
    pub commands_torque: bool,
    /// What actuators make of the commands of a control law; those of the schedule have it.
    pub actuators: ActuatorModels,
    /// The devices that fail during a run; the schedule has what becomes of its arcs already.
    pub failures: Vec<FailureInput>,
}

/// A torque rod: what a control law commands, and what it makes of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TorqueRod {
    /// Axis in F_s, a unit vector, with its alignment error.
    pub axis: [f64; 3],
    /// Largest dipole that is commanded, A m^2.
    pub limit: f64,
    /// Factor of the commanded dipole.
    pub scale: f64,
}

/// What the actuators make of the commands of a control law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ActuatorModels {
    /// Those of the thrusters, in their order; ideal beyond.
    pub thrusters: [ThrusterModel; MAX_THRUSTERS],
    /// Those of the wheels that turn, in their order; ideal beyond.
    pub wheels: [WheelModel; MAX_WHEELS],
}

/// What a thruster makes of a command.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThrusterModel {
    /// Factor of the commanded thrust.
    pub thrust_scale: f64,
    /// Largest thrust that is commanded, N; infinite without a limit.
    pub max_thrust: f64,
    /// Shortest firing, s.
    pub min_on_time: f64,
}

/// What a motor and its bearing make of a command.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WheelModel {
    /// Factor of the commanded torque.
    pub torque_scale: f64,
    /// Torque added to the scaled torque whenever the commanded torque is not zero, N m.
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

    /// Those of `input`.
    fn of(input: &SceneInput) -> Self {
        let mut models = Self::IDEAL;
        for (model, thruster) in models.thrusters.iter_mut().zip(&input.thrusters) {
            *model = ThrusterModel {
                thrust_scale: thruster.thrust_scale,
                max_thrust: thruster.max_thrust_n.unwrap_or(f64::INFINITY),
                min_on_time: thruster.min_on_time_s.unwrap_or(0.0),
            };
        }
        let turning = input.wheels.iter().filter(|wheel| wheel.mode != WheelMode::Locked);
        for (model, wheel) in models.wheels.iter_mut().zip(turning) {
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
    /// Wheel angles relative to the body, in the order of the wheels, rad; zero beyond.
    pub wheel_angles: [f64; MAX_WHEELS],
    /// Wheel rates relative to the body, in the order of the wheels, rad/s; zero beyond.
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
    /// Force of the thrusts `thrust` (N, in the order of the thrusters) in F_s, N (72).
    pub fn thruster_force_s(&self, thrust: [f64; MAX_THRUSTERS]) -> [f64; 3] {
        thruster::force_s(&self.thrusters, thrust)
    }

    /// Torque of the thrusts `thrust` (N, in the order of the thrusters) about the spacecraft's centre of mass c, in
    /// F_s, N m (72).
    pub fn thruster_torque_s(&self, thrust: [f64; MAX_THRUSTERS]) -> [f64; 3] {
        thruster::torque_s(&self.thrusters, thrust, self.mass.center)
    }
}
