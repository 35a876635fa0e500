//! [`Usage`]: what a scene has and commands, on which depends which keys exist and whether a change of them has an effect.

/// Largest number of wheels of a spacecraft.
pub const MAX_WHEELS: usize = 8;
/// Largest number of thrusters of a spacecraft.
pub const MAX_THRUSTERS: usize = 16;

/// What a scene has and commands.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Usage {
    /// Whether there is a schedule.
    pub is_scheduled: bool,
    /// Whether the schedule ever fires each thruster.
    pub fires: [bool; MAX_THRUSTERS],
    /// Whether the schedule ever commands the motor of each wheel.
    pub drives: [bool; MAX_WHEELS],
}
