//! Layer 10: text and figures for people.
//!
//! - [`screen`], [`summary`], [`junit`], [`page`]: what a campaign has found ([`crate::findings`]), on a terminal, for
//!   programs, for build servers, as one HTML file.
//! - [`figure`]: what a figure shows.
//! - [`figure_files`]: figures as files.
//! - `escaped`: text within markup.
//! - [`simulation_figure`], [`precision_figure`]: figures of commands. [`inputs`], [`over_time`]: those of
//!   the page too.
//! - [`comparison_json`]: two results compared, for programs.
//! - [`time_table`]: one run over time on a terminal.
//! - [`index_page`]: all results of a folder.

pub mod comparison_json;
mod escaped;
pub mod figure;
pub mod figure_files;
pub mod index_page;
pub mod inputs;
pub mod junit;
pub mod over_time;
pub mod page;
pub mod precision_figure;
pub mod screen;
pub mod simulation_figure;
pub mod summary;
pub mod time_table;
