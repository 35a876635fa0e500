//! [`text`]: the output for a finished result.

use std::path::Path;

use crate::cli::screen::width;
use crate::findings::end::SummaryEnd;
use crate::findings::number::{bytes, counted};
use crate::findings::numerics::cost;
use crate::report::screen;
use crate::table::wrapped::wrapped;
use crate::workflow::Completed;
use crate::workflow::outcome::place;

/// The result on one screen or in full; `replayed` is the campaign file for replay commands, quoted.
pub fn text(completed: &Completed, replayed: &str, is_verbose: bool) -> String {
    let findings = &completed.findings;
    let head = screen::question(completed.plan.description.as_deref(), width()) + &headline(completed);
    let body = if is_verbose {
        screen::verbose(findings, replayed, width()) + &files(completed)
    } else {
        // one line for the verdict
        let most = screen::LINES.saturating_sub(head.lines().count() + 1);
        screen::text(findings, replayed, [most, width()])
    };
    head + &body + &completed.end.verdict_line(&place(&completed.root)) + "\n"
}

/// CPU time of audits, size of files.
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

/// Warnings, verdicts and page of the result in `root`.
pub fn of_end(end: &SummaryEnd, root: &Path) -> String {
    screen::end(end, &place(root), width())
}

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
    // all other counts are of dispersed runs
    let has_nominal = end.rows == completed.plan.samples && end.rows > 1;
    let nominal = if has_nominal { " (1 nominal)" } else { "" };
    wrapped(&format!("{name}: {ok}{}{nominal} computed{run}, seed {seed}\n", counted(end.rows, "run")), width())
}

/// Samples per second, with one decimal below ten.
pub fn rate(rate: f64) -> String {
    format!("{rate:.*}/s", usize::from(rate < 9.95))
}
