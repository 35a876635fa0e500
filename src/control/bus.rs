//! All that passes between the plant and flight software: [`Measurements`] one way, [`ActingCommands`] the other.

use super::allocation::rods::RodCommand;
use super::estimate::Estimate;
use super::measurement::Measurement;
use crate::scene::{MAX_THRUSTERS, MAX_TORQUE_RODS, MAX_WHEELS};

/// What flight software is told at a tick.
#[derive(Clone, Copy, Debug)]
pub struct Measurements<'a> {
    /// Time since the start of the run, s.
    pub time: f64,
    /// What the sensors deliver.
    pub delivered: &'a [Measurement],
    /// Perfect knowledge: the true state, where the loop is given it instead of sensors.
    pub perfect: Option<&'a Estimate>,
}

/// What the motors are commanded, N m, by wheel.
pub type MotorCommand = [f64; MAX_WHEELS];

/// What was commanded at a control tick, as telemetry has it.
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

/// What the thrusters are commanded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pulses {
    /// When they begin, s.
    pub begin: f64,
    /// Thrusts while they last, N, by thruster.
    pub thrust: [f64; MAX_THRUSTERS],
    /// How long each lasts, s.
    pub on_time: [f64; MAX_THRUSTERS],
}

/// No thruster fires.
pub const NO_PULSES: Pulses = Pulses { begin: 0.0, thrust: [0.0; MAX_THRUSTERS], on_time: [0.0; MAX_THRUSTERS] };

/// The commands that act at a time.
#[derive(Clone, Copy, Debug)]
pub struct ActingCommands<'a> {
    /// Of the motors, N m.
    pub motor_torque: &'a MotorCommand,
    /// Of the thrusters; `None` in a loop without them.
    pub pulses: Option<&'a Pulses>,
    /// Of the torque rods.
    pub rods: &'a RodCommand,
    /// Until when they act, s.
    pub until: f64,
}
