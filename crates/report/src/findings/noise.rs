//! The share of noise within a control loop in an outcome.

use crate::analysis::noise_share::NoiseShare;
use crate::analysis::observed::Observed;
use crate::campaign::Plan;
use crate::findings::finding::{Finding, Kind, Number};
use crate::findings::names;
use crate::findings::number::share;
use crate::statistics::share_within::FEWEST_OTHERS;

pub(super) fn finding(plan: &Plan, one: &NoiseShare) -> Finding {
    let observed = Observed::named(plan, core::iter::once(one.observable.as_str()));
    let name = observed.first().map_or(one.observable.clone(), |observed| names::of_quantity(&observed.quantity));
    let shares =
        one.share.map(|of| Number::share("share of noise", of.value, [of.lower, of.upper], 2 * one.scenes as u64));
    let found = Finding::new(Kind::Driver, format!("noise_{}", one.observable), name, sentence(one));
    Finding { numbers: shares.into_iter().collect(), rank: 1, ..found }
}

pub fn sentence(one: &NoiseShare) -> String {
    let scenes = one.scenes;
    match one.share {
        // a probability of differences cannot be estimated from none
        Some(share) if share.value == 0.0 => {
            format!("noise within the loop changes it in none of {scenes} scenes, each flown twice")
        }
        Some(of) => {
            let said = share([of.value; 2], [of.lower, of.upper]);
            format!("noise within the loop is {said} of the variance ({scenes} scenes, each flown twice)")
        }
        None if one.others > 0 => format!(
            "the share of noise within the loop is not known: {} of {} runs have another value than the others, and it \
             takes {FEWEST_OTHERS} ({scenes} scenes, each flown twice)",
            one.others,
            2 * scenes
        ),
        None => format!(
            "noise within the loop has no share of a variance ({scenes} scenes with a value, which do not vary)"
        ),
    }
}
