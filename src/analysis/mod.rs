//! Layer 7: what the rows say.
//!
//! - [`statistics`]: of every observable ([`observed`], [`population`]), counted by [`column_counts`] from [`part_columns`], or by [`running_counts`] while
//!   the rows are made; [`tally`], [`audit_tally`]: statuses, worst runs, audits.
//! - [`verdicts`]: of the requirements, each an [`assessment`] (over time: `band_verdicts`); [`mod@stopping`]: whether the rows are enough.
//! - [`sensitivity`]: which input matters; [`drivers`]: which of them the rows show. - [`statistics_table`], [`sensitivity_table`]: both as files.
//! - [`comparison`]: two results, by the samples that both drew ([`pairing`]); [`comparison_table`]: as a file.
//! - [`trajectories`]: which runs are retained, and their time series.
//!
//! Not here: files and their protocol (`storage`), formulas of statistics (`statistics`), text and figures (`report`).

pub mod assessment;
pub mod audit_tally;
mod band_verdicts;
pub mod column_counts;
pub mod comparison;
pub mod comparison_table;
pub mod drivers;
pub mod observed;
pub mod pairing;
pub mod part_columns;
pub mod population;
pub mod running_counts;
pub mod sensitivity;
pub mod sensitivity_table;
#[cfg(test)]
mod small_plan;
pub mod statistics;
pub mod statistics_table;
pub mod stopping;
pub mod tally;
pub mod trajectories;
pub mod verdicts;
