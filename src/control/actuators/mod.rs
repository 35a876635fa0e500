//! Models of actuators: what they make of a command, as torques and thrusts that are held over an arc.
//!
//! - [`wheel_drive`]: a wheel's motor with its limits, and friction.
//! - [`thruster_drive`]: a thruster that is throttled, or on or off.
//! - [`modulation`]: the list of how thrusters are driven.
//! - [`delay`]: commands on their way.
//!
//! Not here: alignment errors, which are the scene's, and where the commands come from ([`super::allocation`]).

pub mod delay;
pub mod modulation;
pub mod thruster_drive;
pub mod wheel_drive;

pub use delay::DelayQueue;
pub use thruster_drive::{Pulse, PulseState, ThrustMode, ThrusterDrive};
pub use wheel_drive::{Driven, WheelDrive};
