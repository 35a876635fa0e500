//! From a wanted torque and force to commands of wheels and thrusters.
//!
//! - [`thrust`]: to thrusts, none negative, with the least total, by a `simplex` of fixed size.
//! - [`wheel_torque`]: to torques of wheels' motors, with the least norm.

mod simplex;
#[cfg(test)]
mod tests;
pub mod thrust;
mod two_sided;
pub mod wheel_torque;

pub use thrust::ThrustAllocation;
pub use wheel_torque::WheelTorque;
