//! From a wanted torque, force and dipole to commands of wheels, thrusters and torque rods.
//!
//! - [`rods`]: to dipoles of torque rods, within their limits.
//! - [`thrust`]: to thrusts, none negative, with the least total, by a `simplex` of fixed size.
//! - [`wheel_torque`]: to torques of wheels' motors, with the least norm.

pub mod rods;
mod simplex;
#[cfg(test)]
mod tests;
pub mod thrust;
mod two_sided;
pub mod wheel_torque;

pub use thrust::ThrustAllocation;
pub use wheel_torque::WheelTorque;

/// A component of a force or torque below this, relative to its length, is rounding: of a lever, a projection, a
/// difference. Measured: a few 1e-16. A thruster that fired because of it would cut arcs and be counted.
const ROUNDING: f64 = 1e-14;
