//! What a look at a campaign with `[stop]` found, in words.

use crate::campaign::Plan;
use crate::dataset::stopping::Stopping;
use crate::report::number::short;

/// One sentence on `stopping`, a look at the campaign of `plan`.
pub fn text(plan: &Plan, stopping: &Stopping) -> String {
    let Some(stop) = &plan.analysis.stop else { return String::new() };
    let end = |end: Option<f64>| end.map_or("not bounded".to_owned(), short);
    let [lower, upper] = stopping.found.interval.map(end);
    let reached = match (stopping.found.stops, stopping.ends()) {
        (true, _) => "precise enough",
        (false, true) => "not precise enough with stop.max_samples",
        (false, false) => "not precise enough yet",
    };
    format!(
        "look {} of at most {}, {} samples: p{} of {} = {} in [{lower}, {upper}] at {:.4} confidence, wanted half width {}: {reached}",
        stopping.look,
        stopping.looks,
        stopping.samples,
        short(100.0 * stop.goal.quantile),
        stop.observable,
        stopping.found.estimate.map_or("-".to_owned(), short),
        stopping.found.confidence,
        short(stop.goal.half_width),
    )
}
