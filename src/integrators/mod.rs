//! Floor 3: methods that march a run to its observation grid.
//!
//! Every method fills, per run, the integrated components at the observation times; a kernel then completes them to the
//! physical [`crate::dynamics::table::StateTable`]. Runs stand in lanes that never share a decision.

pub mod adaptive;
pub mod embedded;
pub mod explicit;
pub mod fixed;
pub mod gauss_legendre;
pub mod method;
pub mod propagate;
pub mod step_control;
pub mod system;
pub mod tableau;
pub mod taylor;
pub mod workspace;

pub use crate::dynamics::outcome::{self, Effort, Outcome, Status};
pub use method::Method;
pub use propagate::{Control, Engine, Propagator, Width};
pub use system::{Runs, System, Tolerance};
pub use workspace::Workspace;
