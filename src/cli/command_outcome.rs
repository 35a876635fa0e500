//! [`CommandOutcome`], [`Failure`]: how a command ends, and the documented exit codes.

use crate::cli::{screen, signals};
use crate::findings::end::SummaryEnd;
use crate::run::Status;
/// A command that could not run: code 2 where arguments or campaign file are wrong, code 4 where files are.
pub use crate::workflow::WorkflowError as Failure;

/// How a command ended that could run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CommandOutcome {
    /// No run failed: code 0.
    Done,
    /// This many runs failed, or had errors above their estimates where more did than promised: code 1.
    SomeFailed(u64),
    /// A signal stopped it: code 128 and the signal's number.
    Stopped(i32),
    /// This many requirements failed: code 3.
    RequirementsFailed(usize),
    /// No requirement failed, and this many are undecided, a precision among them that `[stop]` did not reach: code 5.
    RequirementsUndecided(usize),
    /// What was verified is sound, and more is to come: code 5.
    Unfinished,
}

impl CommandOutcome {
    /// The outcome of a command that made one run.
    pub fn of(status: Status) -> Self {
        Self::of_campaign(u64::from(status != Status::Done), 0, 0)
    }

    /// The outcome of a command that finds a finished result: as of the one that finished it.
    pub fn of_end(end: &SummaryEnd) -> Self {
        let undecided = end.count("UNDECIDED") + usize::from(!end.is_reached);
        Self::of_campaign(end.failed + end.not_covered, end.count("FAIL"), undecided)
    }

    /// The outcome of a campaign with so many runs (those that broke the promise of their audits among them) and
    /// requirements that failed, and requirements that are undecided. A requirement that failed matters most, then one
    /// that is undecided, then failed runs.
    pub fn of_campaign(failed_runs: u64, failed: usize, undecided: usize) -> Self {
        match (failed, undecided, failed_runs) {
            (0, 0, 0) => CommandOutcome::Done,
            (0, 0, runs) => CommandOutcome::SomeFailed(runs),
            (0, undecided, _) => CommandOutcome::RequirementsUndecided(undecided),
            (failed, ..) => CommandOutcome::RequirementsFailed(failed),
        }
    }
}

/// Prints the reason of a failure and returns the exit code.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::findings::requirement::EndVerdict;

    /// Law: whatever makes a finished result no success gives its code, each alone: runs that failed, audits beyond
    /// their estimates, verdicts, a precision that was not reached.
    #[test]
    fn every_shortfall_has_its_code() {
        let end = |failed, not_covered, word: &str, is_reached| SummaryEnd {
            rows: 20,
            failed,
            not_covered,
            warnings: Vec::new(),
            verdicts: vec![EndVerdict {
                requirement: "p95".to_owned(),
                word: word.to_owned(),
                ..EndVerdict::default()
            }],
            is_reached,
        };
        for (end, code) in [
            (end(0, 0, "PASS", true), 0),
            (end(3, 0, "PASS", true), 1),
            (end(0, 2, "PASS", true), 1),
            (end(0, 0, "FAIL", true), 3),
            (end(0, 0, "UNDECIDED", true), 5),
            (end(0, 0, "PASS", false), 5),
        ] {
            assert_eq!(exit_code(Ok(CommandOutcome::of_end(&end))), code, "{end:?}");
        }
    }
}
