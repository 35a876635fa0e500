//! What a look at a campaign with `[stop]` found, in words.

use crate::analysis::stopping::{LookFound, Stopping};
use crate::campaign::Plan;
use crate::campaign::stop::When;
use crate::findings::number::short;

/// One sentence on `stopping`, a look at the campaign of `plan`; a second one where it ended the campaign.
pub fn text(plan: &Plan, stopping: &Stopping) -> String {
    let Some(stop) = &plan.analysis.stop else { return String::new() };
    let (what, goal) = match (&stopping.found, &stop.when) {
        (LookFound::Precision(look), When::Precise { observable, goal }) => {
            let [lower, upper] = look.interval.map(|end| end.map_or("not bounded".to_owned(), short));
            let found = format!(
                "p{} of {observable} = {} in [{lower}, {upper}] at {:.4} confidence, wanted half width {}",
                short(100.0 * goal.quantile),
                look.estimate.map_or("-".to_owned(), short),
                look.confidence,
                short(goal.half_width),
            );
            (found, "precise enough")
        }
        (LookFound::Undecided(undecided), _) => {
            (format!("{undecided} of {} requirements undecided", plan.analysis.requirements.len()), "decided")
        }
        (LookFound::Precision(_), When::Decided) => (String::new(), "decided"),
    };
    let reached = match (stopping.is_reached(), stopping.ends()) {
        (true, _) => goal.to_owned(),
        (false, true) => format!("not {goal} with stop.max_samples"),
        (false, false) => format!("not {goal} yet"),
    };
    let bias = match (stopping.is_reached(), stopping.look) {
        (true, look) if look < stopping.looks => {
            ". The rows decided when to stop: estimates lean to the side that stops earlier"
        }
        _ => "",
    };
    let Stopping { look, looks, samples, .. } = stopping;
    format!("look {look} of at most {looks}, {samples} samples: {what}: {reached}{bias}")
}
