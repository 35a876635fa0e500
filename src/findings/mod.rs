//! Layer 9: what a campaign has found, in words and numbers, once. Screen, page, JSON, JUnit and notebook choose from
//! it by rank and width, and compose nothing.
//!
//! - [`findings`]: all of it. [`finding`]: of what it consists.
//! - `warnings`: what comes first. [`requirement`]: the nearest to its limit first. [`loss`]: runs without numbers,
//!   missions, `[stop]`. [`outcome`]: distributions. [`drivers`]: what outcomes depend on. [`numerics`]: errors,
//!   audits.
//! - [`checked`], with [`dispersions`] ([`origin`]: of one number) and [`scene`]: what a campaign would run.
//! - [`compared`], [`comparison`] (with [`changed_keys`]): two results compared.
//! - [`end`]: how a campaign ended; [`results_index`]: how several did; [`verified`]; [`precision`].
//! - [`number`]: numbers in text, the one formatter. [`names`]: columns and parameters in words. [`shell_word`]: words
//!   of commands.

pub mod changed_keys;
pub mod checked;
pub mod compared;
pub mod comparison;
pub mod dispersions;
pub mod drivers;
pub mod end;
pub mod finding;
pub mod loss;
pub mod names;
pub mod number;
pub mod numerics;
pub mod origin;
pub mod outcome;
pub mod precision;
pub mod requirement;
pub mod results_index;
pub mod scene;
pub mod shell_word;
pub mod verified;
mod warnings;

pub use self::finding::{Figures, Finding, Findings, Kind, Number, Verdict};
use crate::analysis::analysed::Analysed;
use crate::analysis::noise_share::NoiseShare;
use crate::campaign::Plan;
use crate::statistics::quantile::percent;

/// What `analysed` says of `plan`; `noise`: the share of noise in its outcomes, where that was measured.
pub fn findings(plan: &Plan, analysed: &Analysed, noise: &[NoiseShare]) -> Findings {
    let mut list = warnings::warnings(plan, analysed);
    let verdicts = requirement::findings(plan, &analysed.verdicts, &analysed.statistics);
    let order = [Verdict::Fail, Verdict::Undecided, Verdict::Pass];
    let verdict = order.into_iter().find(|one| verdicts.iter().any(|finding| finding.verdict == Some(*one)));
    let required = requirement::required(plan, &verdicts);
    list.extend(verdicts);
    list.extend(loss::stop(plan, analysed));
    list.extend(loss::losses(analysed));
    list.extend(loss::missions(plan, analysed));
    list.extend(loss::notes(analysed));
    // said before the campaign on a terminal
    let of_plan = |said: String| Finding { rank: 2, ..Finding::new(Kind::Note, "plan", "note", said) };
    list.extend(plan.notes().into_iter().map(of_plan));
    list.extend(outcome::findings(plan, analysed));
    list.extend(drivers::findings(plan, analysed, noise));
    list.extend(numerics::findings(plan, analysed, &required));
    fn has_interval(one: &Finding) -> bool {
        one.numbers.iter().any(Number::has_interval) || one.children.iter().any(has_interval)
    }
    let confidence = list.iter().any(has_interval).then_some(analysed.statistics.confidence);
    let asked = requirement::common_confidence(&analysed.verdicts);
    let asked = asked.map_or(String::new(), |confidence| format!(", with {}% confidence", percent(confidence)));
    Findings { list, verdict, asked: format!("requirement{asked}"), confidence }
}
