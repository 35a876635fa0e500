//! What a reader has to know before any number of a result: first on the screen, on the page and in `summary.json`.

use crate::report::audit_summary::AuditSummary;

/// The warnings of a campaign with the audits `audit`, each a sentence that begins with what it is about in capitals; mostly none.
pub fn warnings(audit: Option<&AuditSummary>) -> Vec<String> {
    audit.map_or_else(Vec::new, AuditSummary::broken_promises)
}

/// Warnings as lines of the screen; nothing where there are none.
pub fn text(warnings: &[String]) -> String {
    warnings.iter().map(|one| format!("\n  {one}\n")).collect()
}
