//! [`text`]: what a command prints of a result that it has finished.

use std::path::Path;

use crate::cli::screen::width;
use crate::report::audit_summary::cost;
use crate::report::drivers_text;
use crate::report::number::bytes;
use crate::report::summary::SummaryEnd;
use crate::storage::names::REPORT;
use crate::workflow::Completed;

/// The result in words; `replayed` is the campaign file as a word of the command `simulate`.
pub fn text(completed: &Completed, replayed: &str) -> String {
    let Completed { plan, summary, .. } = completed;
    let seconds = completed.made.unwrap_or_default().seconds;
    let audits = if completed.is_audited && seconds[1] > 0.0 {
        format!("\n  audits: {}\n", cost(seconds))
    } else {
        String::new()
    };
    format!(
        "{}\n{}{audits}\n  {}: {} file{} of rows, {}\n{}",
        headline(completed),
        summary.text(&drivers_text::text(plan, &completed.sensitivities), replayed, width()),
        completed.root.display(),
        completed.files,
        if completed.files == 1 { "" } else { "s" },
        bytes(completed.bytes),
        page(&completed.root),
    )
}

/// The warnings and verdicts of a finished result in `root`, and its page.
pub fn of_end(end: &SummaryEnd, root: &Path) -> String {
    let verdicts: String = end.verdicts.iter().map(|(one, verdict)| format!("  {verdict:<10}{one}\n")).collect();
    let warnings: String = end.warnings.iter().map(|one| format!("  {one}\n")).collect();
    warnings + &verdicts + &page(root)
}

/// The name of the page in `root`, where there is one.
fn page(root: &Path) -> String {
    let page = root.join(REPORT);
    if page.is_file() { format!("  {}\n", page.display()) } else { String::new() }
}

fn headline(completed: &Completed) -> String {
    let (name, samples, seed) = (&completed.plan.name, completed.plan.rows(), completed.plan.seed);
    let run = match completed.made {
        Some(made) if made.samples > 0 => {
            let seconds = made.elapsed.as_secs_f64();
            let which = if made.samples == samples { String::new() } else { format!("{} of them now, ", made.samples) };
            format!(", {which}in {seconds:.2} s ({:.0}/s)", made.samples as f64 / seconds.max(1e-9))
        }
        _ => String::new(),
    };
    format!(
        "{name}: {samples} {} ({}){run}, seed {seed}",
        if samples == 1 { "sample" } else { "samples" },
        completed.summary.samples()
    )
}
