//! `[[failure]]`: a wheel, a thruster, a torque rod or a sensor that fails during a run.

use super::components::{SCALAR, XYZ};
use super::limit::Limit;
use super::numbers::Numbers;
use super::rows::rows;
use crate::scene::name::Name;

rows! {
    /// A device that fails at a time of a run. Control software is not told.
    pub struct FailureInput in FailureInput [table => table] {
    at_s: f64 = 0.0, "s", "Time at which the device fails; after the end of the run it has no effect", SCALAR, Plain,
        Limit::NotNegative,
        (required "100.0");
    torque_scale: Option<f64> = None, "1",
        "For a wheel: factor on the torque that its motor gives within its limit, from then on; 0 for a dead motor",
            SCALAR,
        Plain, Limit::Finite, (optional);
    coulomb_friction_n_m: Option<f64> = None, "N m",
        "For a wheel under a control loop: its bearing friction from then on, independent of the rate",
        SCALAR, Plain, Limit::NotNegative, (optional);
    viscous_friction_n_m_s: Option<f64> = None, "N m s",
        "For a wheel under a control loop: its bearing friction from then on, proportional to the rate", SCALAR,
            Plain, Limit::NotNegative,
        (optional);
    thrust_n: Option<f64> = None, "N", "For a thruster: its thrust from then on, whatever is commanded; 0 if it is \
        stuck off", SCALAR, Plain,
        Limit::NotNegative, (optional);
    dipole_a_m2: Option<f64> = None, "A m^2", "For a torque rod: its dipole from then on, whatever is commanded; 0 if \
        it is dead", SCALAR, Plain,
        Limit::Finite, (optional);
    bias_rad_s: Option<[f64; 3]> = None, "rad/s", "For a rate gyro: the change in its bias", XYZ, Plain,
        Limit::Finite, (optional);
    bias_rad: Option<[f64; 3]> = None, "rad", "For a star tracker: the change in its bias", XYZ, Plain,
        Limit::Finite, (optional);
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
