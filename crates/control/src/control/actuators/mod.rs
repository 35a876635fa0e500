//! Models of actuators: constant torques and thrusts over an arc in response to commands. Alignment errors belong to
//! the scene.

pub mod delay;
pub mod modulation;
pub mod thruster_drive;
pub mod wheel_drive;

pub use delay::DelayQueue;
pub use thruster_drive::{Pulse, PulseState, ThrustMode};
pub use wheel_drive::{Driven, WheelDrive};
