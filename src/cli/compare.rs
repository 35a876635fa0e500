//! `spindrift compare`: two results, their plans, their verdicts and the shifts of their statistics.

use std::num::NonZeroUsize;
use std::path::Path;

use crate::analysis::comparison::{Comparison, compare};
use crate::analysis::comparison_table;
use crate::analysis::pairing::ResultRows;
use crate::campaign::Plan;
use crate::campaign::difference::differences;
use crate::cli::arguments::CompareOptions;
use crate::cli::command_outcome::{CommandOutcome, Failure};
use crate::cli::input::plan_of_sound;
use crate::cli::outputs::refuse_within;
use crate::cli::screen;
use crate::report::comparison_text::{self, Compared, ComparedVerdict};
use crate::report::summary;
use crate::storage::claim::{FolderError, Locks, open};
use crate::storage::disk::{Disk, Storage};
use crate::storage::folder::MOST_SUMMARY;
use crate::storage::names::SUMMARY;
use crate::storage::rows_reader::RowsReader;
use crate::storage::{atomic, described_table};

/// Runs the command.
///
/// # Errors
/// Where a folder has no result, or a file cannot be read or written.
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
    let format = options.out.as_deref().map(Format::of).transpose()?;
    for root in [&options.first, &options.second] {
        refuse_within(root, &[("--out", options.out.as_deref())])?;
    }
    let open = |folder: &Path| Compare::open(storage, folder, options.threads);
    let (first, second) = (open(&options.first)?, open(&options.second)?);
    let found = compare(first.rows(), second.rows(), options.threads).map_err(Failure::files)?;
    let (keys, verdicts) = (differences(&first.plan, &second.plan), verdicts([first.verdicts, second.verdicts]));
    let compared = Compared { comparison: &found, keys: &keys, verdicts: &verdicts, tolerance: options.tolerance };
    let names = [&options.first, &options.second].map(|root| root.display().to_string());
    if let Some((path, format)) = options.out.as_deref().zip(format) {
        let bytes = format.bytes(&first.plan, &found, || comparison_text::json(names.clone(), compared));
        let written = bytes.and_then(|bytes| atomic::write_bytes(path, &bytes).map_err(|error| error.to_string()));
        written.map_err(|error| Failure::Files(format!("{}: {error}", path.display())))?;
    }
    let is_beyond = options.tolerance.is_some_and(|tolerance| found.is_beyond(tolerance));
    let verdict = match options.tolerance {
        Some(tolerance) if is_beyond => format!("\n  FAIL: a shift is beyond {tolerance:?} of the spread\n"),
        Some(tolerance) => format!("\n  PASS: no shift is beyond {tolerance:?} of the spread\n"),
        None => String::new(),
    };
    let outcome = if is_beyond { CommandOutcome::RequirementsFailed(1) } else { CommandOutcome::Done };
    Ok((outcome, format!("{}\n{}{verdict}", names.join(" | "), comparison_text::text(compared))))
}

/// A result that is compared.
struct Compare {
    plan: Plan,
    reader: RowsReader,
    /// No process changes it meanwhile.
    _locks: Locks,
    /// Each requirement, and its verdict.
    verdicts: Vec<(String, String)>,
}

impl Compare {
    /// The result in a folder.
    fn open(storage: &'static dyn Storage, folder: &Path, threads: Option<NonZeroUsize>) -> Result<Self, Failure> {
        let (found, locks) = open(storage, folder, true).map_err(|error| match error {
            FolderError::Nothing { .. } => Failure::Input(error.to_string()),
            error => Failure::files(error),
        })?;
        if !found.is_finished {
            return Err(Failure::Input(format!("the result in `{}` is not finished", folder.display())));
        }
        let plan = plan_of_sound(storage, (folder, &found), threads, None)?;
        let path = folder.join(SUMMARY);
        let damaged = |error: &dyn std::fmt::Display| Failure::Files(format!("{}: {error}", path.display()));
        let summary = storage.read(&path, MOST_SUMMARY).map_err(|error| damaged(&error))?;
        let verdicts = summary::verdicts(&summary).ok_or_else(|| damaged(&"its content has changed"))?;
        Ok(Compare { plan, _locks: locks, reader: RowsReader::new(storage, found.row_files(folder)), verdicts })
    }

    fn rows(&self) -> ResultRows<'_> {
        ResultRows { plan: &self.plan, reader: &self.reader }
    }
}

/// The requirements of both results: those of the first in their order, then those that only the second has.
fn verdicts([first, second]: [Vec<(String, String)>; 2]) -> Vec<ComparedVerdict> {
    let verdict = |list: &[(String, String)], name: &str| {
        list.iter().find(|(known, _)| known == name).map(|(_, verdict)| verdict.clone())
    };
    let both = first.iter().chain(second.iter().filter(|(name, _)| verdict(&first, name).is_none()));
    both.map(|(name, _)| ComparedVerdict {
        requirement: name.clone(),
        verdicts: [verdict(&first, name), verdict(&second, name)],
    })
    .collect()
}

/// The formats of the file of a comparison.
#[derive(Clone, Copy)]
enum Format {
    Json,
    Parquet,
}

impl Format {
    /// The one that the extension of `path` names.
    fn of(path: &Path) -> Result<Self, Failure> {
        match path.extension().and_then(|extension| extension.to_str()).map(str::to_ascii_lowercase).as_deref() {
            Some("json") => Ok(Format::Json),
            Some("parquet") => Ok(Format::Parquet),
            _ => Err(Failure::Input(format!(
                "--out {}: a comparison is written as .json or .parquet; choose one of both",
                path.display()
            ))),
        }
    }

    /// The bytes of the file.
    fn bytes(self, plan: &Plan, found: &Comparison, json: impl Fn() -> String) -> Result<Vec<u8>, String> {
        match self {
            Format::Json => Ok(json().into_bytes()),
            Format::Parquet => {
                described_table::encoded(plan, &comparison_table::table(found)).map_err(|error| error.to_string())
            }
        }
    }
}
