//! [`Verdict`], [`Failure`]: how a command ends, and the documented exit codes.

use std::process::ExitCode;

use crate::cli::screen;
use crate::dynamics::outcome::Status;

/// A command that ran to its end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
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

impl Verdict {
    /// The verdict on one run.
    pub fn of(status: Status) -> Self {
        if status == Status::Done { Verdict::Done } else { Verdict::SomeFailed(1) }
    }
}

impl Failure {
    /// An error of input or output.
    pub fn files(error: impl std::fmt::Display) -> Self {
        Failure::Files(error.to_string())
    }
}

/// The exit code, after the reason has been said.
pub fn exit_code(ended: Result<Verdict, Failure>) -> ExitCode {
    ExitCode::from(match ended {
        Ok(Verdict::Done) => 0,
        Ok(Verdict::SomeFailed(_)) => 1,
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
