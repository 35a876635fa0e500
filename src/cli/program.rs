//! [`run`]: the program, for the binary and the Python package.

use std::ffi::OsString;

use crate::cli::arguments::{Command, arguments};
use crate::cli::{
    check, columns, command_outcome, compare, finish_campaign, index, new, precision, report, run_campaign, sample,
    show, signals, simulate, verify,
};

/// Runs the command in `words`, which begin with the program's name; returns the exit code.
pub fn run(words: impl Iterator<Item = OsString>) -> u8 {
    signals::report_file_limit();
    let ended = match arguments(words).command {
        Command::Campaign(options) => run_campaign::run(&options),
        Command::CompleteResult(options) => finish_campaign::run(&options),
        Command::Show(options) => show::run(&options),
        Command::Verify(options) => verify::run(&options),
        Command::Check(options) => check::run(&options),
        Command::Compare(options) => compare::run(&options),
        Command::Columns(options) => columns::run(&options),
        Command::Index(options) => index::run(&options),
        Command::New(options) => new::run(&options),
        Command::Precision(options) => precision::run(&options),
        Command::Report(options) => report::run(&options),
        Command::Schema => new::print_schema(),
        Command::Sample(options) => sample::run(&options),
        Command::Simulate(options) => simulate::run(&options),
    };
    command_outcome::exit_code(ended)
}
