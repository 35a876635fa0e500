//! Largest numbers of devices of a spacecraft: scenes are arrays of these sizes, without allocation.

/// Largest number of wheels of a spacecraft.
pub const MAX_WHEELS: usize = 8;
/// Largest number of thrusters of a spacecraft.
pub const MAX_THRUSTERS: usize = 16;
/// Largest number of torque rods of a spacecraft.
pub const MAX_TORQUE_RODS: usize = 8;
