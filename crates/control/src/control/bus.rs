//! The interface between plant and flight software: [`Measurements`] one way, [`ActingCommands`] the other.

use super::allocation::rods::RodCommand;
use crate::loops::estimate::Estimate;
use crate::loops::measurement::Measurement;
use crate::scene::{MAX_THRUSTERS, MAX_TORQUE_RODS, MAX_WHEELS};

/// Measurements of a tick.
#[derive(Clone, Copy, Debug)]
pub struct Measurements<'a> {
    pub time: f64,
    pub delivered: &'a [Measurement],
    /// Output of an ideal sensor of the whole state, if any.
    pub state: Option<&'a Estimate>,
}

/// Torques of the motors by wheel.
pub type MotorCommand = [f64; MAX_WHEELS];

/// Commands of a control tick, for telemetry.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Commanded {
    pub motor_torque: MotorCommand,
    /// Mean thrusts over the control period.
    pub thrust: [f64; MAX_THRUSTERS],
    pub dipoles: [f64; MAX_TORQUE_RODS],
}

/// A command of the thrusters.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pulses {
    pub begin: f64,
    /// Thrusts while they last, by thruster.
    pub thrust: [f64; MAX_THRUSTERS],
    /// Durations by thruster.
    pub on_time: [f64; MAX_THRUSTERS],
}

/// Commands that act at a time.
#[derive(Clone, Copy, Debug)]
pub struct ActingCommands<'a> {
    pub motor_torque: &'a MotorCommand,
    /// `None` in a loop without thrusters.
    pub pulses: Option<&'a Pulses>,
    pub rods: &'a RodCommand,
    pub until: f64,
}
