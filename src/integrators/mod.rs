//! Floor 3: methods that march a run to its observation grid.
//!
//! Every method fills, per run, the integrated components at the observation times; a kernel then completes them to the
//! physical [`crate::dynamics::table::StateTable`]. Runs stand in lanes that never share a decision.

pub mod adaptive;
pub mod embedded;
pub mod explicit;
pub mod fixed;
pub mod gauss_legendre;
pub mod gyrostat_batch;
pub mod gyrostat_runs;
pub mod local_error;
pub mod method;
pub mod propagate;
pub mod reference_engine;
pub mod reference_runs;
pub mod runge_kutta_engine;
pub mod step_control;
pub mod system;
pub mod tableau;
pub mod taylor;
pub mod workspace;

pub use crate::dynamics::outcome::{self, Effort, Outcome, Status};
pub use method::Method;
pub use propagate::{Engine, Propagator};
pub use reference_runs::ReferenceRuns;
pub use step_control::Control;
pub use system::{Runs, System, Tolerance};
pub use workspace::Workspace;
