//! Layer 12: the command line.
//!
//! - [`program`]: the program as a whole.
//! - [`arguments`]: commands and options; [`argument_values`]: their values; [`help`]: what their help texts end with.
//! - [`outputs`]: which files a command may write.
//! - [`run_campaign`], [`finish_campaign`], [`verify`], [`check`], [`columns`], [`compare`], [`index`], [`new`],
//!   [`precision`], [`report`], [`sample`], [`show`], [`simulate`]: one command each; [`completed_text`]: what is
//!   printed of a result.
//! - [`dispersions`]: the dispersions of a plan as text.
//! - [`terminal`]: notes and the progress bar; [`screen`]: printing, [`terminal_width`]: how wide, [`colour`]: in
//!   colour; [`signals`].
//! - [`command_outcome`]: how a command ends, and its exit code.
//!
//! Not here: physics, sampling, file formats, and what campaigns and results are (`workflow`).

pub mod argument_values;
pub mod arguments;
pub mod check;
pub mod colour;
pub mod columns;
pub mod command_outcome;
pub mod compare;
pub mod completed_text;
pub mod dispersions;
pub mod finish_campaign;
pub mod help;
pub mod index;
pub mod new;
pub mod outputs;
pub mod precision;
pub mod program;
pub mod report;
pub mod run_campaign;
pub mod sample;
mod scene_text;
pub mod screen;
pub mod show;
pub mod signals;
pub mod simulate;
pub mod terminal;
pub mod terminal_width;
pub mod verify;
