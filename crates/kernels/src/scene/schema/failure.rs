//! `[[failure]]`: a wheel, a thruster, a torque rod or a sensor that fails during a run.

use super::rows::rows;
use crate::math::enumeration::named;
use crate::scene::name::Name;

rows! {
    /// A device that fails at a time of a run; control software does not know.
    pub struct FailureInput in FailureInput [table => table] {
    at_s: f64 = 0.0, "s",
        "Time at which the device fails; after the end of the run it has no effect", NotNegative, required "100.0";
    torque_scale: Option<f64> = None, "1",
        "For a wheel: factor on the torque that its motor gives within its limit, from then on; 0 for a dead motor",
        Finite;
    coulomb_friction_n_m: Option<f64> = None, "N m",
        "For a wheel under a control loop: its bearing friction from then on, independent of the rate", NotNegative;
    viscous_friction_n_m_s: Option<f64> = None, "N m s",
        "For a wheel under a control loop: its bearing friction from then on, proportional to the rate", NotNegative;
    thrust_n: Option<f64> = None, "N",
        "For a thruster: its thrust from then on, whatever is commanded; 0 if it is stuck off", NotNegative;
    dipole_a_m2: Option<f64> = None, "A m^2",
        "For a torque rod: its dipole from then on, whatever is commanded; 0 if it is dead", Finite;
    bias_rad_s: Option<[f64; 3]> = None, "rad/s", "For a rate gyro: the change in its bias", Finite;
    bias_rad: Option<[f64; 3]> = None, "rad", "For a star tracker: the change in its bias", Finite;
    } others {
        /// The name.
        name: Name = Name::NONE,
        /// The failing device.
        device: Device = Device::Unknown,
        /// Output of a sensor from then on, unless it is biased.
        output: Option<SensorOutput> = None,
    }
}

/// A failing device.
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

named! {
    /// Output of a sensor that has failed.
    pub enum SensorOutput {
        /// Nothing.
        Silent = "silent",
        /// Its last measurement, repeated.
        Frozen = "frozen",
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
