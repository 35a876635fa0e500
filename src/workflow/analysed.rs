//! The ending of a result, and its verdicts as a file.

use std::path::Path;

pub use crate::analysis::analysed::{Analysed, computed};
use crate::campaign::Plan;
use crate::findings::end::SummaryEnd;
use crate::findings::{Findings, findings};
use crate::report::junit;
use crate::storage::atomic;
use crate::workflow::error::{Result, WorkflowError};

pub fn end_of_analysed(analysed: &Analysed, found: &Findings) -> SummaryEnd {
    let end = SummaryEnd::of(&analysed.ending(), Some(&analysed.statistics));
    SummaryEnd { warnings: found.warnings(), ..end }
}

/// Writes the verdicts to `file`, if any, as JUnit XML.
pub fn write_junit(plan: &Plan, analysed: &Analysed, file: Option<&Path>) -> Result<()> {
    let Some(file) = file else { return Ok(()) };
    let text = junit::text(plan, analysed, &findings(plan, analysed, &[]));
    atomic::write_bytes(file, text.as_bytes()).map_err(|error| WorkflowError::at(file, error))
}
