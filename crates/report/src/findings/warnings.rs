//! Warnings before any number: many lost runs, density table exceeded, failed audits.

use crate::analysis::analysed::Analysed;
use crate::analysis::input_sensitivity::COMPUTED;
use crate::analysis::population::Loss;
use crate::campaign::Plan;
use crate::findings::drivers;
use crate::findings::finding::{Finding, Kind};
use crate::findings::number::{counted, percent};
use crate::findings::numerics::AuditSummary;
use crate::run::Status;

pub(super) fn warnings(plan: &Plan, analysed: &Analysed) -> Vec<Finding> {
    let warning = |id: &str, title: &str, sentence| Finding::new(Kind::Warning, id, title, sentence);
    let lost = not_computed(plan, analysed).map(|said| warning("not_computed", "NOT COMPUTED", said));
    let beyond = analysed.tally.beyond_air.filter(|count| *count > 0).map(|count| {
        let said = format!(
            "{} left the heights of environment.air_heights_m, where the density is extrapolated: extend the table",
            counted(count, "run")
        );
        warning("beyond_air", "BEYOND THE AIR", said)
    });
    let audit = AuditSummary::of(plan, &analysed.tally).map_or_else(Vec::new, |audit| audit.broken_promises());
    let audit = audit.into_iter().map(|said| warning("audit", "AUDIT FAILED", said));
    lost.into_iter().chain(beyond).chain(audit).collect()
}

fn not_computed(plan: &Plan, analysed: &Analysed) -> Option<String> {
    let loss = analysed.statistics.loss();
    let Loss { missing, runs, .. } = loss;
    if !loss.is_big() {
        return None;
    }
    let ended = Status::ALL.into_iter().zip(analysed.statistics.statuses);
    let ended = ended.filter(|(status, count)| *count > 0 && ![Status::Done, Status::InvalidSample].contains(status));
    let ended: Vec<String> = ended.map(|(status, count)| format!("{} {count}", status.name())).collect();
    let drivers = match drivers::found(plan, &analysed.failures, COMPUTED) {
        none if none.is_empty() => String::new(),
        drivers => format!(". What decides it: {}", drivers.join("; ")),
    };
    let others = match runs - missing {
        0 => "There are no results to show for them".to_owned(),
        left => {
            format!("The numbers below describe only the other {left}, which may differ: they have no intervals")
        }
    };
    let share = percent(missing as f64 / runs as f64);
    let counts = if plan.samples == 1 { "the only run".to_owned() } else { loss.counts() };
    Some(format!("{counts}, {share}% ({}). {others}{drivers}", ended.join(", ")))
}
