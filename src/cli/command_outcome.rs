//! [`CommandOutcome`], [`Failure`]: how a command ends, and the documented exit codes.

use std::process::ExitCode;

use crate::cli::{screen, signals};
use crate::run::Status;

/// How a command ended that could run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CommandOutcome {
    /// No run failed: code 0.
    Done,
    /// This many runs failed: code 1.
    SomeFailed(u64),
    /// A signal stopped it: code 128 and the signal's number.
    Stopped(i32),
}

/// A command that could not run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Failure {
    /// Arguments or campaign file are wrong: code 2.
    Input(String),
    /// A file operation failed, or an existing result may not be replaced: code 4.
    Files(String),
}

impl CommandOutcome {
    /// The outcome of a command that made one run.
    pub fn of(status: Status) -> Self {
        if status == Status::Done { CommandOutcome::Done } else { CommandOutcome::SomeFailed(1) }
    }
}

impl From<std::io::Error> for Failure {
    fn from(error: std::io::Error) -> Self {
        Failure::Files(error.to_string())
    }
}

impl Failure {
    /// An error of input or output.
    pub fn files(error: impl std::fmt::Display) -> Self {
        Failure::Files(error.to_string())
    }
}

/// Prints the reason of a failure and returns the exit code.
pub fn exit_code(ended: Result<CommandOutcome, Failure>) -> ExitCode {
    ExitCode::from(match ended {
        Ok(CommandOutcome::Done) => 0,
        Ok(CommandOutcome::SomeFailed(_)) => 1,
        Ok(CommandOutcome::Stopped(signal)) => signals::exit_code(signal),
        Err(Failure::Input(reason)) => {
            screen::note(&format!("error: {reason}"));
            2
        }
        Err(Failure::Files(reason)) => {
            screen::note(&format!("error: {reason}"));
            4
        }
    })
}
