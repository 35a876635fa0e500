//! Layer 3: control in the loop.
//!
//! - [`law`]: [`ControlLaw`], a law that a plan can fly: its name, its parameters, and how it is made for a run from a [`LawContext`]
//!   (in [`context`]).
//! - [`runs`]: the laws of the runs that an engine propagates together.
//!
//! Not here: the interface by which an engine asks a law ([`crate::dynamics::actuation`]), and which campaign flies which law (`campaign`).

pub mod context;
pub mod law;
pub mod runs;

pub use context::LawContext;
pub use law::ControlLaw;
pub use runs::LawRuns;
