//! The program `spindrift`; what it does, the library does.

use std::process::ExitCode;

use spindrift::cli::{Command, arguments, check, command_outcome, precision, run_campaign, sample, simulate};

fn main() -> ExitCode {
    let ended = match arguments().command {
        Command::Campaign(options) => run_campaign::run(&options),
        Command::Check(options) => check::run(&options),
        Command::Precision(options) => precision::run(&options),
        Command::Sample(options) => sample::run(&options),
        Command::Simulate(options) => simulate::run(&options),
    };
    command_outcome::exit_code(ended)
}
