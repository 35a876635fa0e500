//! The program as a user runs it: commands, files, audits, columns.

#[path = "../support/mod.rs"]
mod support;

mod audit;
mod cli;
mod csv_digits;
mod motion;
mod observation;
mod precision;
mod result_files;
