//! Layer 12: the command line.
//!
//! - `program`: the program as a whole.
//! - `arguments`: commands and options; `argument_values`: their values; `help`: what their help texts end with.
//! - `run_campaign`, `finish_campaign`, `verify`, `check`, `columns`, `compare`, `index`, `new`,
//!   `precision`, `report`, `sample`, `show`, `simulate`: one command each; `completed_text`: what is
//!   printed of a result.
//! - `terminal`: notes and the progress bar; `screen`: printing, `terminal_width`: how wide, `colour`: in
//!   colour; `signals`.
//! - `command_outcome`: how a command ends, and its exit code.
//!
//! Not here: physics, sampling, file formats, and what campaigns and results are (`workflow`).

mod argument_values;
pub mod arguments;
mod check;
mod colour;
mod columns;
pub mod command_outcome;
mod compare;
mod completed_text;
mod finish_campaign;
mod help;
mod index;
mod new;
mod precision;
pub mod program;
mod report;
mod run_campaign;
mod sample;
pub mod screen;
mod show;
pub mod signals;
mod simulate;
pub mod terminal;
mod terminal_width;
mod verify;
