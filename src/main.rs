//! The program `spindrift`; the library does the work.

#![forbid(unsafe_code)]

use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(spindrift::cli::program::run(std::env::args_os()))
}
