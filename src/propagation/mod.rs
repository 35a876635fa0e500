//! Layer 3: engines that turn scenes into state tables.
//!
//! Every method fills, per run, the integrated components at the observation times; a kernel then completes them to the
//! physical [`crate::run::StateTable`]. Runs stand in lanes that never share a decision.

pub mod arc_source;
pub mod gyrostat_batch;
pub mod gyrostat_runs;
pub mod local_error;
pub mod method;
pub mod null_space_engine;
pub mod null_space_runs;
pub mod runge_kutta_engine;
pub mod settings;
pub mod taylor;

pub use method::Method;
pub use null_space_runs::NullSpaceRuns;
pub use settings::{CompletedRun, Engine, PropagationSettings};
