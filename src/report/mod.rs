//! Layer 10: text and figures for people.
//!
//! - [`brief_text`], [`summary`], [`observable_lines`], [`audit_summary`]: statistics of a campaign.
//! - [`warnings`]: what comes before them.
//! - [`failure_text`]: why runs failed. [`share_text`]: shares of runs, and of noise.
//! - [`requirements`]: verdicts, also as JUnit XML; [`verdict_table`]: as a table.
//! - [`drivers_text`]: what drives an outcome. [`filter_text`]: filters that do not know their errors.
//! - [`precision_text`]: work-precision measurements as text.
//! - [`figure`]: what a figure shows.
//! - [`figure_files`]: figures as files.
//! - `escaped`: text within markup.
//! - [`simulation_figure`], [`drawn_figure`] (of [`drawn_columns`], in [`histogram`]s, with [`expected_counts`], of
//!   numbers drawn together by [`marginal`]; [`origin_text`]: in words), [`precision_figure`]: the figures of the
//!   commands; [`over_time`]: those over time, of the page too.
//! - `surroundings`: Sun, shadow, field and the place below on an orbit.
//! - [`compared`], [`comparison_text`] (with [`changed_keys`], `compared_outcomes`), [`comparison_json`]: two results
//!   compared.
//! - [`stopping_text`]: looks of a campaign with `[stop]`.
//! - [`time_table`]: one run over time on a terminal. - - [`page`]: the report of a campaign as one HTML file.
//!   [`index_page`]: all results of a folder.

pub mod audit_summary;
pub mod brief_text;
pub mod changed_keys;
pub mod compared;
mod compared_outcomes;
pub mod comparison_json;
pub mod comparison_text;
pub mod drawn_columns;
pub mod drawn_figure;
pub mod drivers_text;
mod escaped;
pub mod expected_counts;
pub mod failure_text;
pub mod figure;
pub mod figure_files;
pub mod filter_text;
pub mod histogram;
pub mod index_page;
pub mod marginal;
pub mod mission_text;
pub mod observable_lines;
pub mod origin_text;
pub mod over_time;
pub mod page;
pub mod precision_figure;
pub mod precision_text;
pub mod requirements;
pub mod share_text;
pub mod simulation_figure;
pub mod stopping_text;
pub mod summary;
mod summary_text;
mod surroundings;
pub mod time_table;
pub mod verdict_table;
pub mod warnings;
