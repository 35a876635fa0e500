//! Layer 1: integrators of ordinary differential equations, without physics; imports [`crate::math`] only.

pub mod adaptive;
pub mod embedded;
mod error_model;
pub mod explicit;
pub mod extrapolation;
pub mod fixed;
pub mod integrators;
pub mod lane_driver;
mod lane_slot;
mod runs;
mod step;
mod step_control;
pub mod stepper;
pub mod switches;
mod system;
pub mod tableau;

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
