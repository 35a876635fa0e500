//! All that passes between the plant and flight software: [`Measurements`] one way, [`ActingCommands`] the other.

use super::allocation::rods::RodCommand;
use super::estimate::Estimate;
use super::measurement::Measurement;
use crate::scene::{MAX_THRUSTERS, MAX_TORQUE_RODS, MAX_WHEELS};

/// The measurements of a tick.
#[derive(Clone, Copy, Debug)]
pub struct Measurements<'a> {
    /// Time since the start of the run, s.
    pub time: f64,
    pub delivered: &'a [Measurement],
    /// The measurement of an ideal sensor of the whole state; `None` in a loop without one.
    pub state: Option<&'a Estimate>,
}

/// Torques of the motors, N m, by wheel.
pub type MotorCommand = [f64; MAX_WHEELS];

/// The commands of a control tick, for telemetry.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Commanded {
    /// Torques of the motors, N m.
    pub motor_torque: MotorCommand,
    /// Mean thrusts over the control period, N.
    pub thrust: [f64; MAX_THRUSTERS],
    /// Dipoles of the torque rods, A m^2.
    pub dipoles: [f64; MAX_TORQUE_RODS],
}

impl Commanded {
    /// Nothing.
    pub const NOTHING: Commanded =
        Commanded { motor_torque: [0.0; MAX_WHEELS], thrust: [0.0; MAX_THRUSTERS], dipoles: [0.0; MAX_TORQUE_RODS] };
}

/// A command of the thrusters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pulses {
    /// Start, s.
    pub begin: f64,
    /// Thrusts while they last, N, by thruster.
    pub thrust: [f64; MAX_THRUSTERS],
    /// Length of each, s.
    pub on_time: [f64; MAX_THRUSTERS],
}

/// No thruster fires.
pub const NO_PULSES: Pulses = Pulses { begin: 0.0, thrust: [0.0; MAX_THRUSTERS], on_time: [0.0; MAX_THRUSTERS] };

/// The commands that act at a time.
#[derive(Clone, Copy, Debug)]
pub struct ActingCommands<'a> {
    pub motor_torque: &'a MotorCommand,
    /// `None` in a loop without thrusters.
    pub pulses: Option<&'a Pulses>,
    pub rods: &'a RodCommand,
    /// End, s.
    pub until: f64,
}
