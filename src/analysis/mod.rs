//! Layer 8: statistics and verdicts from rows.
//!
//! - [`analysed`]: all results; [`fold`]: one pass over the parts, in memory or in files ([`part_columns`]), with an
//!   [`accumulator`] for each result.
//! - [`statistics`]: of every observable ([`observed`], [`population`], [`column_counts`], [`order_statistics`]), with
//!   their list ([`mod@statistic`]).
//! - [`tally`]: ends of runs ([`statuses`]), worst runs ([`worst_runs`]), audits ([`audit_tally`]).
//! - [`verdicts`]: requirements, each an [`assessment`] (`row_verdicts`, over time `band_verdicts`);
//!   [`mod@stopping`]: looks of `[stop]`; [`mod@ending`]: the end of the campaign.
//! - [`sensitivity`]: effects of inputs ([`input_sensitivity`]) from the [`first_rows`] (`block_indices`: of a
//!   `saltelli` design); [`effects`]: their tests, also on an [`event`]; [`drivers`]: their ranking; [`noise_share`]:
//!   noise within loops.
//! - [`comparison`]: two results, in pairs of samples that both drew ([`pairing`]).
//! - [`statistics_table`], [`sensitivity_table`], [`comparison_table`]: results as files.
//! - [`trajectories`]: retained runs and their time series.
//! - [`survey`]: the data of the page.
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
pub mod statistic;
pub mod statistics;
pub mod statistics_table;
pub mod statuses;
pub mod stopping;
pub mod survey;
pub mod tally;
pub mod trajectories;
pub mod verdicts;
pub mod worst_runs;
