//! Layer 8: what the rows say.
//!
//! - [`analysed`]: all that follows is in one place. [`fold`]: one pass over the parts, of rows in memory or in files
//!   ([`part_columns`]), in which everything that follows gathers what it needs, each by an [`accumulator`].
//! - [`statistics`]: of every observable ([`observed`], [`population`], [`column_counts`], [`order_statistics`]);
//!   [`tally`]: how runs ended ([`statuses`]), the worst ones ([`worst_runs`]), audits ([`audit_tally`]).
//! - [`verdicts`]: of the requirements, each an [`assessment`] (of a number of each run: `row_verdicts`; over time:
//!   `band_verdicts`); [`mod@stopping`]: whether the rows are enough. [`mod@ending`]: how the campaign ended.
//! - [`sensitivity`]: which input matters ([`input_sensitivity`]), from the [`first_rows`] (`block_indices`: of a
//!   `saltelli` design); [`effects`]: tests whether it does, also of an [`event`]; [`drivers`]: the ranking of what the
//!   rows show; [`noise_share`]: what noise within loops does.
//! - [`statistics_table`], [`sensitivity_table`]: both as files.
//! - [`comparison`]: two results, by the samples that both drew ([`pairing`]); [`comparison_table`]: as a file.
//! - [`trajectories`]: which runs are retained, and their time series.
//! - [`survey`]: what the page shows of the rows.
//!
//! Not here: files and their protocol (`storage`), formulas of statistics (`statistics`), text and figures (`report`).

pub mod accumulator;
pub mod analysed;
pub mod assessment;
pub mod audit_tally;
mod band_verdicts;
mod block_indices;
pub mod column_counts;
pub mod comparison;
#[cfg(test)]
pub mod comparison_of_known_truth;
pub mod comparison_table;
pub mod derived_table;
pub mod drivers;
pub mod effects;
pub mod ending;
pub mod event;
pub mod first_rows;
pub mod fold;
pub mod input_sensitivity;
pub mod missions;
pub mod noise_share;
pub mod observed;
pub mod order_statistics;
pub mod outcomes;
pub mod pairing;
pub mod part_columns;
pub mod population;
mod row_verdicts;
pub mod sensitivity;
pub mod sensitivity_table;
#[cfg(test)]
mod small_plan;
pub mod statistics;
pub mod statistics_table;
pub mod statuses;
pub mod stopping;
pub mod survey;
pub mod tally;
pub mod trajectories;
pub mod verdicts;
pub mod worst_runs;
