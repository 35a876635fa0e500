//! Layer 3: engines that integrate scenes at the observation times and complete the components to the physical
//! [`crate::run::StateTable`]. Lanes share no decision.

pub(crate) mod arc_source;
pub mod engine;
mod factory;
pub(crate) mod gyrostat_batch;
pub(crate) mod gyrostat_runs;
pub(crate) mod integrated_effects;
pub(crate) mod local_error;
pub(crate) mod method;
pub(crate) mod null_space_engine;
pub(crate) mod null_space_runs;
pub(crate) mod rotation_errors;
pub(crate) mod runge_kutta_engine;
pub(crate) mod series_remainder;
pub mod settings;
pub mod taylor;
pub mod trajectory_recorder;

pub use engine::{CompletedRun, CompletionCallback, Engine};
pub use method::Method;
pub use null_space_runs::NullSpaceRuns;
pub use rotation_errors::{RotationError, debris_rotation_errors, rotation_difference, rotation_errors};
pub use settings::PropagationSettings;
