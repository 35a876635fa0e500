//! [`CommandOutcome`], [`Failure`]: how a command ends, and the documented exit codes.

use std::process::ExitCode;

use crate::cli::screen;
use crate::run::Status;

/// A command that ran to its end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CommandOutcome {
    /// All is well: code 0.
    Done,
    /// It ran, but this many runs failed: code 1.
    SomeFailed(u64),
}

/// A command that could not run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Failure {
    /// Arguments or campaign file are wrong: code 2.
    Input(String),
    /// The file system refused, or something is in the way: code 4.
    Files(String),
}

impl CommandOutcome {
    /// The verdict on one run.
    pub fn of(status: Status) -> Self {
        if status == Status::Done { CommandOutcome::Done } else { CommandOutcome::SomeFailed(1) }
    }
}

impl Failure {
    /// An error of input or output.
    pub fn files(error: impl std::fmt::Display) -> Self {
        Failure::Files(error.to_string())
    }
}

/// The exit code, after the reason has been said.
pub fn exit_code(ended: Result<CommandOutcome, Failure>) -> ExitCode {
    ExitCode::from(match ended {
        Ok(CommandOutcome::Done) => 0,
        Ok(CommandOutcome::SomeFailed(_)) => 1,
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
