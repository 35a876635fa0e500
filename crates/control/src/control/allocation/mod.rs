//! Allocation of torque, force and dipole to wheels, thrusters and torque rods.

pub mod rods;
mod simplex;
#[cfg(test)]
mod tests;
pub mod thrust;
mod two_sided;
pub mod wheel_torque;

pub use thrust::ThrustAllocation;
pub use wheel_torque::WheelTorque;

/// Relative size below which a component of a force or torque is rounding of a lever, projection or difference
/// (measured: a few 1e-16). A thruster fired by rounding would cut arcs and be counted.
const ROUNDING: f64 = 1e-14;
