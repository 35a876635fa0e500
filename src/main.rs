//! The program `spindrift`: selects the command; the library does the rest.

#![forbid(unsafe_code)]
#![warn(clippy::unwrap_used, clippy::print_stdout)] // failures are values; a printing macro panics where the pipe is closed

use std::process::ExitCode;

use spindrift::cli::arguments::{Command, arguments};
use spindrift::cli::{
    check, columns, command_outcome, compare, finish_campaign, index, new, precision, report, run_campaign, sample,
    signals, simulate, slurm, verify,
};

fn main() -> ExitCode {
    signals::report_file_limit();
    let ended = match arguments().command {
        Command::Campaign(options) => run_campaign::run(&options),
        Command::CompleteResult(options) => finish_campaign::run(&options),
        Command::Verify(options) => verify::run(&options),
        Command::Check(options) => check::run(&options),
        Command::Compare(options) => compare::run(&options),
        Command::Columns(options) => columns::run(&options),
        Command::Index(options) => index::run(&options),
        Command::New(options) => new::run(&options),
        Command::Precision(options) => precision::run(&options),
        Command::Report(options) => report::run(&options),
        Command::Sample(options) => sample::run(&options),
        Command::Simulate(options) => simulate::run(&options),
        Command::Slurm(options) => slurm::run(&options),
    };
    command_outcome::exit_code(ended)
}
