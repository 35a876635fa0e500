//! [`CommandsUnderWay`]: commands from their tick until they act no more.

use crate::control::actuators::DelayQueue;
use crate::control::allocation::rods::{NO_DIPOLES, RodCommand};
use crate::control::bus::{MotorCommand, NO_PULSES, Pulses};
use crate::scene::MAX_WHEELS;

/// Commands that act, or will.
#[derive(Clone, Debug)]
pub struct CommandsUnderWay {
    pub(super) motors: DelayQueue<MotorCommand>,
    /// Stays empty in a loop without thrusters.
    pub(in crate::control) thrust: DelayQueue<Pulses>,
    /// Stays empty in a loop without torque rods.
    pub(super) rods: DelayQueue<RodCommand>,
}

impl CommandsUnderWay {
    /// None, with room for those of a loop with this delay and period, s, and with torque rods or without.
    pub fn new(delay: f64, period: f64, has_rods: bool) -> Self {
        CommandsUnderWay {
            motors: DelayQueue::new([0.0; MAX_WHEELS], delay, period),
            thrust: DelayQueue::new(NO_PULSES, delay, period),
            rods: if has_rods { DelayQueue::new(NO_DIPOLES, delay, period) } else { DelayQueue::constant(NO_DIPOLES) },
        }
    }
}
