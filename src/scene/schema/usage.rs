//! [`Usage`]: what a scene has and commands, on which depends which keys exist and whether a change of them has an effect.

/// What a scene has and commands.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Usage {
    /// Whether there is a schedule.
    pub is_scheduled: bool,
    /// Whether the schedule ever fires each thruster.
    pub fires: [bool; 3],
    /// Whether the schedule ever commands the motor of each wheel, and the wheel is there.
    pub drives: [bool; 2],
    /// Whether each wheel is there.
    pub wheels: [bool; 2],
    /// Whether there is debris.
    pub debris: bool,
}
