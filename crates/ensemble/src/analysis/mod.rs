//! Layer 8: statistics and verdicts from rows. One [`fold`] over the parts, in memory or in files ([`part_columns`]),
//! has an [`accumulator`] per result; [`analysed`] has all results, [`comparison`] compares two.

pub mod accumulator;
pub mod analysed;
pub mod assessment;
pub mod audit_tally;
mod band_verdicts;
pub mod bins;
mod block_indices;
pub mod column_counts;
pub mod comparison;
#[cfg(test)]
mod comparison_of_known_truth;
pub mod comparison_table;
pub mod derived_table;
pub mod drivers;
pub mod effects;
pub mod ending;
pub mod envelope;
pub mod event;
pub mod expected;
pub mod first_rows;
pub mod fold;
pub mod input_sensitivity;
#[cfg(test)]
mod known_truth;
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
pub mod spectrum;
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
