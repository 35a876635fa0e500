//! Floor 3: methods that march a run to its observation grid.
//!
//! Every method fills, per run, the integrated components at the observation times; a kernel then completes them to the
//! physical [`crate::dynamics::table::StateTable`]. Runs stand in lanes that never share a decision.

pub mod method;
pub mod propagate;
pub mod reference_runs;
pub mod system;
pub mod taylor;

pub use crate::dynamics::outcome::{self, Effort, Outcome, Status};
pub use method::Method;
pub use propagate::{Control, Engine, Propagator, Width};
pub use reference_runs::ReferenceRuns;
pub use system::{Runs, System, Tolerance};
