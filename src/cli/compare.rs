//! `spindrift compare`: two results, their plans and the shifts of their statistics.

use std::path::Path;

use crate::campaign::difference::differences;
use crate::campaign::{Overrides, Plan};
use crate::cli::arguments::CompareOptions;
use crate::cli::command_outcome::{CommandOutcome, Failure};
use crate::cli::screen;
use crate::dataset::claim::open;
use crate::dataset::comparison::{ResultRows, compare};
use crate::dataset::names::PLAN;
use crate::dataset::rows_reader::RowsReader;
use crate::dataset::storage::Disk;
use crate::report::comparison_text;

/// Runs the command.
///
/// # Errors
/// Where a folder has no result, or a file cannot be read.
pub fn run(options: &CompareOptions) -> Result<CommandOutcome, Failure> {
    let (first, second) = (result(&options.first)?, result(&options.second)?);
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
    screen::print(&format!("{names}\n{text}{verdict}"))?;
    Ok(if is_beyond { CommandOutcome::RequirementsFailed(1) } else { CommandOutcome::Done })
}

/// The plan and the rows of the result in a folder.
fn result(folder: &Path) -> Result<(Plan, RowsReader), Failure> {
    let plan = folder.join(PLAN);
    if !plan.is_file() {
        return Err(Failure::Input(format!("`{}` has no result of spindrift: there is no {PLAN}", folder.display())));
    }
    let plan = Plan::load(&plan, Overrides::default()).map_err(|error| Failure::Input(error.to_string()))?;
    let (found, _) = open(&Disk, folder).map_err(Failure::files)?;
    if !found.is_finished {
        return Err(Failure::Input(format!("the result in `{}` is not finished", folder.display())));
    }
    Ok((plan, RowsReader::new(found.row_files(folder))))
}
