//! The program `spindrift`; what it does, the library does.

use std::process::ExitCode;

use spindrift::cli::{Command, arguments, campaign, check, precision, sample, simulate, verdict};

fn main() -> ExitCode {
    let ended = match arguments().command {
        Command::Campaign(options) => campaign::run(&options),
        Command::Check(options) => check::run(&options),
        Command::Precision(options) => precision::run(&options),
        Command::Sample(options) => sample::run(&options),
        Command::Simulate(options) => simulate::run(&options),
    };
    verdict::exit_code(ended)
}
