//! Layer 1: what a run consists of: the observation grid, the state table, how it ended and what it cost.

pub mod outcome;
pub mod state_table;

pub use outcome::{LocalErrors, Outcome, Status, StepStatistics};
pub use state_table::{Grid, StateField, StateFields, StateTable, Trajectory};
