//! Layer 1: what a run consists of.
//!
//! - [`Grid`]: the observation times.
//! - [`StateTable`]: the physical states at these times, by [`StateField`].
//! - [`Trajectory`]: the components that a method integrates, from which a kernel completes the table.
//! - [`Outcome`]: how a run ended, what it cost, and the estimate of its errors.
//! - [`Telemetry`]: what a control law has recorded of a run.
//! - [`Quantity`]: name, unit and meaning of a column of numbers.

mod grid;
mod outcome;
mod quantity;
mod state_field;
mod state_table;
mod telemetry;
mod trajectory;

pub use grid::{Grid, points_before, points_to};
pub use outcome::{LocalErrors, Outcome, Status, StepStatistics, rate_scale};
pub use quantity::Quantity;
pub use state_field::{StateField, StateFields};
pub use state_table::StateTable;
pub use telemetry::Telemetry;
pub use trajectory::Trajectory;
