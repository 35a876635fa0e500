//! Layer 10: text and figures for people.
//!
//! - [`screen`], [`summary`], [`junit`], [`page`]: what a campaign has found ([`crate::findings`]), on a terminal, for
//!   programs, for build servers, as one HTML file. [`precision_text`]: work-precision measurements as text.
//! - [`figure`]: what a figure shows.
//! - [`figure_files`]: figures as files.
//! - `escaped`: text within markup.
//! - [`simulation_figure`], [`drawn_figure`] (of [`drawn_columns`], in [`histogram`]s, with [`expected_counts`], of
//!   numbers drawn together by [`marginal`]; [`origin_text`]: in words), [`precision_figure`]: the figures of the
//!   commands; [`over_time`]: those over time, of the page too.
//! - `surroundings`: Sun, shadow, field and the place below on an orbit.
//! - [`compared`], [`comparison_text`] (with [`changed_keys`], `compared_outcomes`), [`comparison_json`]: two results
//!   compared.
//! - [`time_table`]: one run over time on a terminal.
//! - [`index_page`]: all results of a folder.

pub mod changed_keys;
pub mod compared;
mod compared_outcomes;
pub mod comparison_json;
pub mod comparison_text;
pub mod drawn_columns;
pub mod drawn_figure;
mod escaped;
pub mod expected_counts;
pub mod figure;
pub mod figure_files;
pub mod histogram;
pub mod index_page;
pub mod junit;
pub mod marginal;
pub mod origin_text;
pub mod over_time;
pub mod page;
pub mod precision_figure;
pub mod precision_text;
pub mod screen;
pub mod simulation_figure;
pub mod summary;
mod surroundings;
pub mod time_table;
