//! Layer 1: integrators of ordinary differential equations, without physics; imports [`crate::math`] only.
#![allow(clippy::needless_range_loop, reason = "iterators over lanes are not always inlined, see `explicit::each`")]

pub(crate) mod adaptive;
pub(crate) mod embedded;
mod error_model;
pub mod explicit;
pub(crate) mod extrapolation;
pub(crate) mod fixed;
pub(crate) mod integrators;
pub(crate) mod lane_driver;
mod lane_slot;
mod runs;
mod step;
mod step_control;
pub(crate) mod stepper;
pub mod switches;
mod system;
pub(crate) mod tableau;

pub use adaptive::Adaptive;
pub use error_model::{ErrorModel, Remainder, StepErrors};
pub use fixed::Fixed;
pub use integrators::{Dop853, DormandPrince, DormandPrinceRestepped, GaussLegendre, Integrator, RungeKutta4};
pub use lane_driver::integrate;
pub use runs::{EndedRun, Recorder, Runs, Termination};
pub use step::Step;
pub use step_control::{Control, PACE_STEPS, is_out_of_reach};
pub use stepper::LaneMethod;
pub use system::{System, Tolerance};
