//! Layer 1: data of a run.
//!
//! [`Grid`]: observation times. [`StateTable`]: physical states by [`StateField`]. [`Trajectory`]: integrated
//! components. [`Outcome`]: status, effort and estimated errors. [`Telemetry`]: records of a control law. [`Quantity`]:
//! name, unit and meaning of a column.

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
