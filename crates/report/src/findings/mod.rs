//! Layer 9: the results of a campaign in words and numbers. Screen, page, JSON, JUnit and notebook select by rank and
//! width and compose nothing.

pub mod changed_keys;
pub mod checked;
pub mod compared;
pub mod comparison;
pub mod dispersions;
pub mod driver_sentence;
pub mod drivers;
pub mod end;
pub mod finding;
#[cfg(test)]
#[path = "../../../ensemble/src/analysis/known_truth.rs"]
pub mod known_truth;
pub mod loss;
pub mod names;
mod noise;
pub mod number;
pub mod numerics;
pub mod origin;
pub mod outcome;
pub mod precision;
pub mod requirement;
pub mod results_index;
pub mod scene;
pub mod shell_word;
#[cfg(test)]
pub(crate) mod shipped;
pub mod verified;
mod warnings;

pub use self::finding::{Figures, Finding, Findings, Kind, Number, Verdict};
use crate::analysis::analysed::Analysed;
use crate::analysis::noise_share::NoiseShare;
use crate::campaign::Plan;
use crate::statistics::quantile::percent;

/// All findings; `noise` is the measured share of noise in the outcomes.
pub fn findings(plan: &Plan, analysed: &Analysed, noise: &[NoiseShare]) -> Findings {
    let mut list = warnings::warnings(plan, analysed);
    let verdicts = requirement::findings(plan, &analysed.verdicts, &analysed.statistics);
    let order = [Verdict::Fail, Verdict::Undecided, Verdict::Pass];
    let verdict = order.into_iter().find(|one| verdicts.iter().any(|finding| finding.verdict == Some(*one)));
    let required = requirement::required(plan, &verdicts);
    list.extend(verdicts);
    list.extend(loss::stop(plan, analysed));
    list.extend(loss::losses(plan, analysed));
    list.extend(loss::missions(plan, analysed));
    list.extend(loss::notes(plan, analysed));
    list.extend(numerics::beyond_tolerance(plan, analysed));
    // the terminal shows them before the campaign
    let of_plan = |said: String| Finding { rank: 2, ..Finding::new(Kind::Note, "plan", "note", said) };
    list.extend(plan.notes().into_iter().map(of_plan));
    list.extend(outcome::findings(plan, analysed));
    list.extend(drivers::findings(plan, analysed, (noise, &required)));
    list.extend(numerics::findings(plan, analysed, &required));
    fn has_interval(one: &Finding) -> bool {
        one.numbers.iter().any(Number::has_interval) || one.children.iter().any(has_interval)
    }
    let confidence = list.iter().any(has_interval).then_some(analysed.statistics.confidence);
    let asked = requirement::common_confidence(&analysed.verdicts);
    let asked = asked.map_or(String::new(), |confidence| format!(", with {}% confidence", percent(confidence)));
    Findings { list, verdict, asked: format!("requirement{asked}"), confidence }
}
