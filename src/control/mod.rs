//! Layer 4: control in the loop.
//!
//! - [`law`]: [`ControlLaw`], a law that a plan can fly: its name, its parameters, and how it is made for a run from a [`LawContext`]
//!   (in [`context`]).
//! - [`runs`]: the laws of the runs that an engine propagates together.
//! - [`truth`]: the true state at a tick. [`sensors`]: what is measured of it ([`measurement`]).
//! - [`estimators`]: from measurements to an [`estimate`].
//! - [`laws`]: from an estimate to a wanted torque.
//! - [`allocation`]: from a wanted torque and force to wheels and thrusters. [`actuators`]: what these make of it.
//! - [`rotation`], [`small_matrix`]: what all of them compute with.
//!
//! Not here: the interface by which an engine asks a law ([`crate::dynamics::actuation`]), and which campaign flies which law (`campaign`).

pub mod actuators;
pub mod allocation;
pub mod context;
pub mod estimate;
pub mod estimators;
pub mod law;
pub mod laws;
pub mod measurement;
pub mod rotation;
pub mod runs;
pub mod sensors;
pub mod small_matrix;
pub mod truth;

pub use context::LawContext;
pub use law::ControlLaw;
pub use runs::LawRuns;
