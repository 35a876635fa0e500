//! `spindrift compare`: two results, their plans, their verdicts and the shifts of their statistics.

use std::path::Path;

use crate::analysis::comparison::Comparison;
use crate::analysis::comparison_table;
use crate::campaign::Plan;
use crate::campaign::difference::differences;
use crate::cli::arguments::CompareOptions;
use crate::cli::command_outcome::{CommandOutcome, Failure};
use crate::cli::outputs::refuse_within;
use crate::cli::screen;
use crate::cli::terminal::Terminal;
use crate::report::compared::{Compared, ComparedVerdict, verdicts};
use crate::report::{comparison_json, comparison_text};
use crate::storage::atomic;
use crate::storage::columnar::{Packing, encoded};
use crate::storage::identity::provenance;
use crate::workflow::{Results, Session};

/// Runs the command.
///
/// # Errors
/// Where a folder has no result, or a file cannot be read or written.
pub fn run(options: &CompareOptions) -> Result<CommandOutcome, Failure> {
    let watch = Terminal::default();
    let (outcome, text) = compared(&Session::new(&watch)?.on_threads(options.threads), options)?;
    screen::print(&text)?;
    Ok(outcome)
}

/// Does what the command says; how it ends, and what it prints.
///
/// # Errors
/// As [`run`].
pub fn compared(session: &Session<'_>, options: &CompareOptions) -> Result<(CommandOutcome, String), Failure> {
    let format = options.out.as_deref().map(Format::of).transpose()?;
    for root in [&options.first, &options.second] {
        refuse_within(root, &[("--out", options.out.as_deref())])?;
    }
    let open = |folder: &Path| Results::open(folder, *session);
    let (first, second) = (open(&options.first)?, open(&options.second)?);
    let found = first.compare(&second)?;
    let keys = differences(first.plan(), second.plan());
    let verdicts = verdicts([first.end()?.verdicts, second.end()?.verdicts], &found);
    let names = &[&options.first, &options.second].map(|root| root.display().to_string());
    let tolerance = options.tolerance;
    let plans = [first.plan(), second.plan()];
    let is_strict = options.strict;
    let compared =
        Compared { names, plans, comparison: &found, keys: &keys, verdicts: &verdicts, tolerance, is_strict };
    if let Some((path, format)) = options.out.as_deref().zip(format) {
        let bytes = format.bytes(first.plan(), &found, || comparison_json::text(compared));
        let written = bytes.and_then(|bytes| atomic::write_bytes(path, &bytes).map_err(|error| error.to_string()));
        written.map_err(|error| Failure::Files(format!("{}: {error}", path.display())))?;
    }
    let counts = |one: &&ComparedVerdict| one.is_worse() && (is_strict || !one.is_within_chance);
    let worse = verdicts.iter().filter(counts).count();
    let outcome = match worse + usize::from(tolerance.is_some_and(|tolerance| found.is_beyond(tolerance))) {
        0 => CommandOutcome::Done,
        failed => CommandOutcome::RequirementsFailed(failed),
    };
    Ok((outcome, comparison_text::text(compared, options.verbose, screen::width())))
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
                "--out {}: a comparison is written as .json or .parquet; choose one of these",
                path.display()
            ))),
        }
    }

    /// The bytes of the file.
    fn bytes(self, plan: &Plan, found: &Comparison, json: impl Fn() -> String) -> Result<Vec<u8>, String> {
        match self {
            Format::Json => Ok(json().into_bytes()),
            Format::Parquet => encoded(&comparison_table::table(found), provenance(plan), Packing::Zstd)
                .map_err(|error| error.to_string()),
        }
    }
}
