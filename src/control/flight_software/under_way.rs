//! [`CommandsUnderWay`]: commands from their tick until they cease to act.

use crate::control::actuators::DelayQueue;
use crate::control::allocation::rods::{NO_DIPOLES, RodCommand};
use crate::control::bus::{MotorCommand, NO_PULSES, Pulses};
use crate::scene::MAX_WHEELS;

#[derive(Clone, Debug)]
pub struct CommandsUnderWay {
    pub(super) motors: DelayQueue<MotorCommand>,
    /// Empty in a loop without thrusters.
    pub thrust: DelayQueue<Pulses>,
    /// Empty in a loop without torque rods.
    pub(super) rods: DelayQueue<RodCommand>,
}

impl CommandsUnderWay {
    /// Reserves room for a loop of this delay and period.
    pub fn new(delay: f64, period: f64, has_rods: bool) -> Self {
        CommandsUnderWay {
            motors: DelayQueue::new([0.0; MAX_WHEELS], delay, period),
            thrust: DelayQueue::new(NO_PULSES, delay, period),
            rods: if has_rods { DelayQueue::new(NO_DIPOLES, delay, period) } else { DelayQueue::constant(NO_DIPOLES) },
        }
    }
}
