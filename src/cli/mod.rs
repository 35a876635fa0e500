//! Layer 12: the command line, one file per command. No physics, sampling or file formats here; campaigns and results
//! are those of `workflow`.

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
