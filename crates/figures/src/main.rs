//! `spindrift` with files of figures as SVG.

use std::process::ExitCode;

fn main() -> ExitCode {
    spindrift_figures::register();
    ExitCode::from(spindrift::cli::program::run(std::env::args_os()))
}
