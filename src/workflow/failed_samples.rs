//! Failed samples, run again under another plan ([`plan_of_failed`]) or ending the campaign.

use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

use crate::campaign::{FilesRead, Plan};
use crate::control::tables::Overrides;
use crate::ensemble::Rows;
use crate::findings::loss::readable;
use crate::findings::number::counted;
use crate::run::Status;
use crate::sampling::SampleId;
use crate::storage::claim::open;
use crate::storage::dataset::rows;
use crate::storage::rows_reader::{PartReader, RowsError, RowsReader};
use crate::workflow::error::{Result, WorkflowError};
use crate::workflow::session::Session;
use crate::workflow::source::{plan_and_files, sound};

/// The samples that are not `ok`, in the order of the files.
fn failed(part: &mut PartReader) -> Result<Vec<SampleId>, RowsError> {
    let rows = part.samples()?.into_iter().zip(part.statuses()?);
    Ok(rows.filter(|(_, status)| *status != Status::Done).map(|(sample, _)| sample).collect())
}

/// The plan of `file` for the failed samples of the result `of`, with its seed and number of samples, so that numbers
/// mean the same samples; and its files. `None` if none failed.
///
/// # Errors
/// A damaged result, or a wrong campaign file.
pub fn plan_of_failed(
    session: &Session<'_>,
    file: &Path,
    of: &Path,
    overrides: Overrides,
) -> Result<Option<(Plan, FilesRead)>> {
    let store = session.store(of)?;
    let (found, _lock) = open(&*store, true)?;
    let (drawn, parts) = sound(session, (&*store, &found), None)?;
    if !found.is_finished {
        session.watch.note(&format!(
            "{}: not finished: the failures among {} so far",
            of.display(),
            counted(parts.iter().map(|part| part.part.count).sum::<usize>(), "row")
        ));
    }
    let mut samples = Vec::new();
    let add = |some: Vec<SampleId>| {
        samples.extend(some.into_iter().map(|sample| sample.0));
        Ok::<(), RowsError>(())
    };
    rows(&store, &parts).visit(None, failed, add)?;
    let same = Overrides { samples: Some(drawn.samples), seed: Some(drawn.seed), ..overrides };
    let (plan, files) = plan_and_files(file, same)?;
    if samples.is_empty() {
        return Ok(None);
    }
    let input = |why| WorkflowError::Input(format!("--only-failed-of {}: {why}", of.display()));
    plan.only(samples).map(|plan| Some((plan, files))).map_err(input)
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FailedRun {
    pub sample: SampleId,
    /// Status and reason.
    pub what: String,
}

pub fn first_failed(reader: &RowsReader) -> Result<Option<FailedRun>, RowsError> {
    let mut first = None;
    let read = |part: &mut PartReader| -> Result<Option<FailedRun>, RowsError> {
        let statuses = part.statuses()?;
        let Some(row) = statuses.iter().position(|status| *status != Status::Done) else { return Ok(None) };
        let reason = part.reasons()?.swap_remove(row);
        Ok(Some(FailedRun { sample: part.samples()?[row], what: said(statuses[row], reason.as_deref()) }))
    };
    reader.visit(None, read, |found| {
        first = first.take().or(found);
        Ok::<(), RowsError>(())
    })?;
    Ok(first)
}

fn said(status: Status, reason: Option<&str>) -> String {
    reason.map_or_else(|| status.name().to_owned(), |reason| format!("{}: {}", status.name(), readable(reason)))
}

/// Starts no further part after a failed run in `rows`, and keeps the `first` such run in sample order.
pub(super) fn fail_fast(rows: &Rows, first: &Mutex<Option<FailedRun>>, stop: &AtomicBool) {
    let Some(row) = rows.statuses().iter().position(|status| *status != Status::Done) else { return };
    let reason = rows.reasons().iter().find(|(at, _)| *at == row).map(|(_, reason)| reason.as_str());
    let found = FailedRun { sample: rows.samples()[row], what: said(rows.statuses()[row], reason) };
    let mut first = first.lock().unwrap_or_else(PoisonError::into_inner);
    if first.as_ref().is_none_or(|first| found.sample < first.sample) {
        *first = Some(found);
    }
    stop.store(true, Ordering::SeqCst);
}
