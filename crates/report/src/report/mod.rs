//! Layer 10: text and figures for people, from [`crate::findings`].

pub mod comparison_json;
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
