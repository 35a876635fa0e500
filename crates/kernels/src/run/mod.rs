//! Layer 1: data of a run.

mod grid;
mod outcome;
mod quantity;
mod state_field;
mod state_table;
mod telemetry;
mod trajectory;

pub use grid::{Grid, points_before, points_to};
pub use outcome::{LocalErrors, Outcome, Status, StepStatistics, rate_scale, rate_scale_of};
pub use quantity::Quantity;
pub use state_field::{StateField, StateFields};
pub use state_table::StateTable;
pub use telemetry::Telemetry;
pub use trajectory::Trajectory;
