//! What a reader has to know before any number of a result: first on the screen, on the page and in `summary.json`.

use crate::analysis::input_sensitivity::{COMPUTED, InputSensitivity};
use crate::analysis::population::Loss;
use crate::analysis::statistics::Statistics;
use crate::campaign::Plan;
use crate::findings::number::counted;
use crate::report::audit_summary::AuditSummary;
use crate::report::drivers_text::{ranked, sentence};
use crate::report::share_text::with_interval;
use crate::run::Status;

/// The warnings of a campaign with these `statistics` and the audits `audit`, each a sentence that begins with what it
/// is about in capitals; mostly none. `failures`: what drives whether a run is computed; `beyond_air`: how many runs
/// have left the table of the air.
pub fn warnings(
    plan: &Plan,
    statistics: &Statistics,
    audit: Option<&AuditSummary>,
    failures: &[InputSensitivity],
    beyond_air: Option<u64>,
) -> Vec<String> {
    let mut found: Vec<String> = not_computed(plan, statistics, failures).into_iter().collect();
    found.extend(beyond_air.filter(|count| *count > 0).map(|count| {
        format!(
            "BEYOND THE AIR: {} left the heights of environment.air_heights_m, where the density is extrapolated: \
             extend the table",
            counted(count, "run")
        )
    }));
    found.extend(audit.map_or_else(Vec::new, AuditSummary::broken_promises));
    found
}

/// That many runs have no numbers, and what decides which.
fn not_computed(plan: &Plan, statistics: &Statistics, failures: &[InputSensitivity]) -> Option<String> {
    let loss = statistics.loss();
    let Loss { missing, runs, .. } = loss;
    if !loss.is_big() {
        return None;
    }
    let ended = Status::ALL
        .into_iter()
        .zip(statistics.statuses)
        .filter(|(status, count)| *count > 0 && ![Status::Done, Status::InvalidSample].contains(status));
    let ended: Vec<String> = ended.map(|(status, count)| format!("{} {count}", status.name())).collect();
    let rankings = ranked(plan, failures, COMPUTED);
    let known = rankings.iter().filter(|ranking| ranking.drivers().next().is_some());
    let drivers = match known.map(|ranking| sentence(plan, COMPUTED, ranking)).collect::<Vec<_>>() {
        none if none.is_empty() => String::new(),
        drivers => format!(". What decides it: {}", drivers.join("; ")),
    };
    let others = match runs - missing {
        0 => "There are no results to show for them".to_owned(),
        left => {
            format!("The numbers below describe only the other {left}, which may differ: they have no intervals")
        }
    };
    let share = missing as f64 / runs as f64;
    Some(format!(
        "NOT COMPUTED: {}, {} ({}). {others}{drivers}",
        if plan.samples == 1 { "the only run".to_owned() } else { loss.counts() },
        with_interval([share; 2], [f64::NAN; 2]),
        ended.join(", ")
    ))
}

/// Warnings as lines of the screen; nothing where there are none.
pub fn text(warnings: &[String]) -> String {
    warnings.iter().map(|one| format!("\n  {one}\n")).collect()
}
