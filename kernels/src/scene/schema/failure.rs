//! `[[failure]]`: a wheel, a thruster, a torque rod or a sensor that fails during a run.

use super::components::{SCALAR, XYZ};
use super::limit::Limit;
use super::numbers::Numbers;
use super::rows::rows;
use crate::scene::name::Name;

rows! {
    /// A device that fails at a time of a run. Control software is not told.
    pub struct FailureInput in FailureInput [table => table] {
    at_s: f64 = 0.0, "s", "When the device fails; after the end of the run it does not", SCALAR, Plain, Limit::NotNegative,
        (required "100.0");
    torque_scale: Option<f64> = None, "1", "Of a wheel: what becomes of its motor's torque, as a factor; 0 for a motor that gives none", SCALAR,
        Plain, Limit::Finite, (optional);
    coulomb_friction_n_m: Option<f64> = None, "N m", "Of a wheel under a control loop: friction of its bearing from then on, independent of the rate",
        SCALAR, Plain, Limit::NotNegative, (optional);
    viscous_friction_n_m_s: Option<f64> = None, "N m s",
        "Of a wheel under a control loop: friction of its bearing from then on, in proportion to the rate", SCALAR, Plain, Limit::NotNegative,
        (optional);
    thrust_n: Option<f64> = None, "N", "Of a thruster: its thrust from then on, whatever is commanded; 0 for one that is stuck off", SCALAR, Plain,
        Limit::NotNegative, (optional);
    dipole_a_m2: Option<f64> = None, "A m^2", "Of a torque rod: its dipole from then on, whatever is commanded; 0 for one that is dead", SCALAR, Plain,
        Limit::Finite, (optional);
    bias_rad_s: Option<[f64; 3]> = None, "rad/s", "Of a rate gyro: what its bias changes by", XYZ, Plain, Limit::Finite, (optional);
    bias_rad: Option<[f64; 3]> = None, "rad", "Of a star tracker: what its bias changes by", XYZ, Plain, Limit::Finite, (optional);
    } others {
        /// The name.
        name: Name = Name::NONE,
        /// What fails.
        device: Device = Device::Unknown,
        /// What a sensor delivers from then on, where it is not biased.
        output: Option<SensorOutput> = None,
    }
}

/// What fails.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Device {
    /// A wheel, by its place among those that turn.
    Wheel(usize),
    /// A thruster, by its place.
    Thruster(usize),
    /// A torque rod, by its place.
    Rod(usize),
    /// A sensor of the control loop, by its place.
    Sensor(usize),
    /// Not read yet.
    Unknown,
}

/// What a sensor that has failed delivers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SensorOutput {
    /// Nothing.
    Silent,
    /// Its last measurement, again and again.
    Frozen,
}

impl SensorOutput {
    /// All values.
    pub const ALL: [SensorOutput; 2] = [SensorOutput::Silent, SensorOutput::Frozen];

    /// The name in campaign files.
    pub const fn name(self) -> &'static str {
        match self {
            SensorOutput::Silent => "silent",
            SensorOutput::Frozen => "frozen",
        }
    }

    /// The value called `name`.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|output| output.name() == name)
    }
}

impl FailureInput {
    /// The keys of a wheel's failure.
    pub const OF_WHEELS: [&'static str; 3] = ["torque_scale", "coulomb_friction_n_m", "viscous_friction_n_m_s"];
    /// The keys of a thruster's failure.
    pub const OF_THRUSTERS: [&'static str; 1] = ["thrust_n"];
    /// The keys of a torque rod's failure.
    pub const OF_RODS: [&'static str; 1] = ["dipole_a_m2"];
    /// The keys of a sensor's failure.
    pub const OF_SENSORS: [&'static str; 3] = ["output", "bias_rad_s", "bias_rad"];
}
