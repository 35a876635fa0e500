//! `spindrift compare`: two results, their plans and the shifts of their statistics.

use std::path::Path;

use crate::campaign::Plan;
use crate::campaign::difference::differences;
use crate::cli::arguments::CompareOptions;
use crate::cli::command_outcome::{CommandOutcome, Failure};
use crate::cli::input::plan_in;
use crate::cli::screen;
use crate::dataset::claim::{FolderError, open};
use crate::dataset::comparison::{ResultRows, compare};
use crate::dataset::rows_reader::RowsReader;
use crate::dataset::storage::{Disk, Storage};
use crate::report::comparison_text;

/// Runs the command.
///
/// # Errors
/// Where a folder has no result, or a file cannot be read.
pub fn run(options: &CompareOptions) -> Result<CommandOutcome, Failure> {
    let (outcome, text) = compared(&Disk, options)?;
    screen::print(&text)?;
    Ok(outcome)
}

/// Does what the command says; how it ends, and what it prints.
///
/// # Errors
/// As [`run`].
pub fn compared(storage: &'static dyn Storage, options: &CompareOptions) -> Result<(CommandOutcome, String), Failure> {
    let (first, second) = (result(storage, &options.first)?, result(storage, &options.second)?);
    let rows = |(plan, reader)| ResultRows { plan, reader };
    let found = compare(rows((&first.0, &first.1)), rows((&second.0, &second.1)), options.threads);
    let found = found.map_err(Failure::files)?;
    let keys = differences(&first.0, &second.0);
    let text = comparison_text::text(&found, &keys, options.tolerance);
    let is_beyond = options.tolerance.is_some_and(|tolerance| found.is_beyond(tolerance));
    let verdict = match options.tolerance {
        Some(tolerance) if is_beyond => format!("\n  FAIL: a shift is beyond {tolerance:?} of the spread\n"),
        Some(tolerance) => format!("\n  PASS: no shift is beyond {tolerance:?} of the spread\n"),
        None => String::new(),
    };
    let names = format!("{} | {}", options.first.display(), options.second.display());
    let outcome = if is_beyond { CommandOutcome::RequirementsFailed(1) } else { CommandOutcome::Done };
    Ok((outcome, format!("{names}\n{text}{verdict}")))
}

/// The plan and the rows of the result in a folder.
fn result(storage: &'static dyn Storage, folder: &Path) -> Result<(Plan, RowsReader), Failure> {
    let (found, _) = open(storage, folder).map_err(|error| match error {
        FolderError::Nothing { .. } => Failure::Input(error.to_string()),
        error => Failure::files(error),
    })?;
    if !found.is_finished {
        return Err(Failure::Input(format!("the result in `{}` is not finished", folder.display())));
    }
    Ok((plan_in(folder, &found)?.0, RowsReader::new(storage, found.row_files(folder))))
}
