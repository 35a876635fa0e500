//! [`Actuated`]: actuation that does work on a spacecraft, or changes its momentum.

use super::input::SceneInput;
use super::schema::{Device, FailureInput, WheelInput, WheelMode};

/// Kinds of actuation during a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Actuated {
    /// The schedule commands a thrust, or a thruster may be stuck on.
    pub thrusters: bool,
    /// The schedule commands a motor torque, or a motor holds the speed of its wheel.
    pub motors: bool,
    /// Torques on the body, of the environment or of a control law, or the force of gravity on an orbit.
    pub body_torque: bool,
}

impl Actuated {
    /// Nothing acts.
    pub const NONE: Actuated = Actuated { thrusters: false, motors: false, body_torque: false };
    /// Everything acts, as under a control law.
    pub const ALL: Actuated = Actuated { thrusters: true, motors: true, body_torque: true };

    /// Actuation of the scenes of `input`.
    pub fn of(input: &SceneInput) -> Self {
        let is_held = |wheel: &WheelInput| wheel.mode == WheelMode::SpeedHeld;
        let commands = |numbers: &[f64]| numbers.iter().any(|number| *number != 0.0);
        let is_of_thruster = |failure: &FailureInput| matches!(failure.device, Device::Thruster(_));
        let arcs = || input.actuation.iter();
        Actuated {
            thrusters: arcs().any(|arc| commands(&arc.thrust_n)) || input.failures.iter().any(is_of_thruster),
            motors: arcs().any(|arc| commands(&arc.torque_n_m)) || input.wheels.iter().any(is_held),
            body_torque: input.environment.acts() || input.orbit.is_some(),
        }
    }

    /// The union of both.
    #[must_use]
    pub const fn and(self, other: Actuated) -> Self {
        Actuated {
            thrusters: self.thrusters || other.thrusters,
            motors: self.motors || other.motors,
            body_torque: self.body_torque || other.body_torque,
        }
    }

    /// True if anything acts.
    pub const fn any(self) -> bool {
        self.thrusters || self.motors || self.body_torque
    }

    /// True if an external torque acts.
    pub const fn external(self) -> bool {
        self.thrusters || self.body_torque
    }
}
