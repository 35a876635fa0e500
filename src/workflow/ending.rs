//! [`end_of`]: the ending of the campaign of a finished result, by its rows and summary.

use crate::analysis::ending::ending;
use crate::campaign::Plan;
use crate::ensemble::Ensemble;
use crate::findings::end::SummaryEnd;
use crate::findings::requirement::EndVerdict;
use crate::findings::shell_word::quoted_path;
use crate::report::summary;
use crate::storage::claim::Finished;
use crate::storage::dataset::rows;
use crate::storage::names::{MANIFEST, SUMMARY};
use crate::storage::rows_reader::RowsReader;
use crate::workflow::error::{Result, WorkflowError};
use crate::workflow::session::Session;

/// The ending of the campaign `plan` by its rows; its `summary` must agree, since programs read that.
///
/// # Errors
/// Unreadable rows, or a contradicting summary.
pub(super) fn end_of(summary: &[u8], plan: &Plan, rows: &RowsReader, session: &Session<'_>) -> Result<SummaryEnd> {
    let ensemble = Ensemble::new(plan, session.isa);
    let end = SummaryEnd::of(&ending(&ensemble, rows, session.threads)?, None);
    if let Some(said) = summary::read(summary)
        && said.without_words() == end.without_words()
    {
        let both = end.verdicts.into_iter().zip(said.verdicts);
        let verdicts = both.map(|(rows, said)| EndVerdict { found: said.found, ..rows }).collect();
        return Ok(SummaryEnd { warnings: said.warnings, verdicts, ..end });
    }
    let why = format!(
        "does not say what the rows say, though it has the checksum that {MANIFEST} lists; this makes it again: \
        spindrift verify {} --repair",
        quoted_path(rows.store().root())
    );
    Err(WorkflowError::at(&rows.store().path(SUMMARY), why))
}

/// [`end_of`] for a finished and undamaged result.
///
/// # Errors
/// As [`end_of`].
pub(super) fn end_of_finished(session: &Session<'_>, plan: &Plan, finished: &Finished) -> Result<SummaryEnd> {
    let samples = finished.parts.iter().map(|part| part.part.count as u64).sum();
    let plan = plan.clone().at_look(samples);
    end_of(finished.summary.as_bytes(), &plan, &rows(&finished.store, &finished.parts), session)
}
