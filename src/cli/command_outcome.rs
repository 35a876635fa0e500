//! [`CommandOutcome`], [`Failure`]: ends of commands, and the documented exit codes.

use crate::cli::{screen, signals};
use crate::findings::end::SummaryEnd;
use crate::run::Status;
/// A command that could not run: code 2 for arguments or campaign file, code 4 for other files.
pub use crate::workflow::WorkflowError as Failure;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CommandOutcome {
    /// Code 0.
    Done,
    /// Failed runs, or runs that break the promise of their error estimates: code 1.
    SomeFailed(u64),
    /// Signal: code 128 plus its number.
    Stopped(i32),
    /// Failed requirements: code 3.
    RequirementsFailed(usize),
    /// Undecided requirements, including an unreached goal of `[stop]`: code 5.
    RequirementsUndecided(usize),
    /// Sound but unfinished: code 5.
    Unfinished,
}

impl CommandOutcome {
    pub fn of(status: Status) -> Self {
        Self::of_campaign(u64::from(status != Status::Done), 0, 0)
    }

    pub fn of_end(end: &SummaryEnd) -> Self {
        let undecided = end.count("UNDECIDED") + usize::from(!end.is_reached);
        Self::of_campaign(end.failed + end.not_covered, end.count("FAIL"), undecided)
    }

    /// Requirements that failed take precedence, then undecided ones, then failed runs, including those that break the
    /// promise of their audits.
    pub fn of_campaign(failed_runs: u64, failed: usize, undecided: usize) -> Self {
        match (failed, undecided, failed_runs) {
            (0, 0, 0) => CommandOutcome::Done,
            (0, 0, runs) => CommandOutcome::SomeFailed(runs),
            (0, undecided, _) => CommandOutcome::RequirementsUndecided(undecided),
            (failed, ..) => CommandOutcome::RequirementsFailed(failed),
        }
    }
}

/// Prints the reason of a failure.
pub fn exit_code(ended: Result<CommandOutcome, Failure>) -> u8 {
    match ended {
        Ok(CommandOutcome::Done) => 0,
        Ok(CommandOutcome::SomeFailed(_)) => 1,
        Ok(CommandOutcome::Stopped(signal)) => signals::exit_code(signal),
        Ok(CommandOutcome::RequirementsFailed(_)) => 3,
        Ok(CommandOutcome::RequirementsUndecided(_) | CommandOutcome::Unfinished) => 5,
        Err(Failure::Input(reason)) => {
            screen::note(&format!("error: {reason}"));
            2
        }
        Err(Failure::Files(reason)) => {
            screen::note(&format!("error: {reason}"));
            4
        }
    }
}
