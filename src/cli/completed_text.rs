//! [`text`]: what a command prints of a result that it has finished.

use std::path::Path;

use crate::cli::screen::width;
use crate::findings::number::{bytes, counted};
use crate::findings::numerics::cost;
use crate::report::screen;
use crate::report::summary::SummaryEnd;
use crate::storage::names::REPORT;
use crate::table::wrapped::wrapped;
use crate::workflow::Completed;

/// Lines of a screen without `--verbose`.
const SCREEN: usize = 24;

/// The result in words, on one screen or with all that is known of it; `replayed` is the campaign file as a word of the
/// command `simulate`.
pub fn text(completed: &Completed, replayed: &str, is_verbose: bool) -> String {
    let findings = &completed.findings;
    let head = question(completed.plan.description.as_deref()) + &headline(completed);
    let body = if is_verbose {
        screen::verbose(findings, replayed, width()) + &files(completed)
    } else {
        // the last line is the verdict
        let most = SCREEN.saturating_sub(head.lines().count() + 1);
        screen::text(findings, replayed, [most, width()])
    };
    head + &body + &verdict(&completed.end, &completed.root)
}

/// What a result takes: CPU time of audits, files.
fn files(completed: &Completed) -> String {
    let seconds = completed.made.unwrap_or_default().seconds;
    let audits = if completed.is_audited && seconds[1] > 0.0 {
        format!("\n  audits: {}\n", cost(seconds))
    } else {
        String::new()
    };
    let (root, files, size) = (completed.root.display(), completed.files, bytes(completed.bytes));
    format!("{audits}\n  {root}: {} of rows, {size}\n", counted(files, "file"))
}

/// The question of a campaign, which comes first.
pub fn question(question: Option<&str>) -> String {
    let Some(first) = question.and_then(|text| text.chars().next()) else { return String::new() };
    let rest = &question.unwrap_or_default()[first.len_utf8()..];
    wrapped(&format!("{}{rest}\n", first.to_uppercase()), width())
}

/// The warnings and verdicts of a finished result in `root`, and its page.
pub fn of_end(end: &SummaryEnd, root: &Path) -> String {
    let warnings: String = end.warnings.iter().map(|one| format!("  {one}\n")).collect();
    wrapped(&warnings, width()) + &screen::verdicts(&end.verdicts, width()) + &verdict(end, root)
}

/// The last line: the verdict, and the page in `root`, where there is one.
fn verdict(end: &SummaryEnd, root: &Path) -> String {
    let page = root.join(REPORT);
    end.verdict_line(if page.is_file() { &page } else { root }) + "\n"
}

/// What ran, how fast.
fn headline(completed: &Completed) -> String {
    let (name, end, seed) = (&completed.plan.name, &completed.end, completed.plan.seed);
    let ok = if end.failed > 0 { format!("{} of ", end.rows - end.failed) } else { String::new() };
    let run = match completed.made {
        Some(made) if made.samples > 0 => {
            let seconds = made.elapsed.as_secs_f64();
            let which =
                if made.samples == end.rows { String::new() } else { format!(", {} of them now,", made.samples) };
            format!("{which} in {seconds:.2} s ({})", rate(made.samples as f64 / seconds.max(1e-9)))
        }
        _ => String::new(),
    };
    // every other count is of the dispersed runs
    let has_nominal = end.rows == completed.plan.samples && end.rows > 1;
    let nominal = if has_nominal { " (1 nominal)" } else { "" };
    format!("{name}: {ok}{}{nominal} computed{run}, seed {seed}\n", counted(end.rows, "run"))
}

/// A number of samples per second: whole, or with one decimal below ten.
pub fn rate(rate: f64) -> String {
    format!("{rate:.*}/s", usize::from(rate < 9.95))
}
