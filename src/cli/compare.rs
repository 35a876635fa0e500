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
use crate::report::comparison_text::{self, Compared, ComparedVerdict};
use crate::storage::{atomic, described_table};
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
    let verdicts = verdicts([first.end()?.verdicts, second.end()?.verdicts]);
    let compared = Compared { comparison: &found, keys: &keys, verdicts: &verdicts, tolerance: options.tolerance };
    let names = [&options.first, &options.second].map(|root| root.display().to_string());
    if let Some((path, format)) = options.out.as_deref().zip(format) {
        let bytes = format.bytes(first.plan(), &found, || comparison_text::json(names.clone(), compared));
        let written = bytes.and_then(|bytes| atomic::write_bytes(path, &bytes).map_err(|error| error.to_string()));
        written.map_err(|error| Failure::Files(format!("{}: {error}", path.display())))?;
    }
    let is_beyond = options.tolerance.is_some_and(|tolerance| found.is_beyond(tolerance));
    let verdict = match options.tolerance {
        Some(tolerance) if is_beyond => format!("\n  FAIL: a shift is beyond {tolerance:?} of the spread\n"),
        Some(tolerance) => format!("\n  PASS: no shift is beyond {tolerance:?} of the spread\n"),
        None => String::new(),
    };
    let worse = verdicts.iter().filter(|one| one.is_worse()).count();
    let worsened = match worse {
        0 => String::new(),
        1 => "\n  FAIL: one verdict is worse than before\n".to_owned(),
        worse => format!("\n  FAIL: {worse} verdicts are worse than before\n"),
    };
    let outcome = match worse + usize::from(is_beyond) {
        0 => CommandOutcome::Done,
        failed => CommandOutcome::RequirementsFailed(failed),
    };
    Ok((
        outcome,
        format!("{}\n{}{verdict}{worsened}", names.join(" | "), comparison_text::text(compared, screen::width())),
    ))
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
                "--out {}: a comparison is written as .json or .parquet; choose one of these",
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
