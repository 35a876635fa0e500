//! Findings on the drivers of each outcome, those of unmet requirements first.

use crate::analysis::analysed::Analysed;
use crate::analysis::drivers::{Question, Ranked, Ranking, is_known, rankings};
use crate::analysis::event::{Event, Occurs};
use crate::analysis::input_sensitivity::InputSensitivity;
use crate::analysis::noise_share::NoiseShare;
use crate::analysis::verdicts::Verdicts;
use crate::campaign::Plan;
use crate::findings::driver_sentence::{sentence, too_few, verb};
use crate::findings::finding::{Figures, Finding, Kind, Number};
use crate::findings::number::counted;
use crate::findings::{loss, names, noise};
use crate::sampling::Design;
use crate::statistics::binomial::Decision;

pub const SEE_INTERACTIONS: &str =
    "interactions of inputs are not included, but are in total indices (design.kind = \"saltelli\")";

/// The observables of `all` that are outcomes of the campaign, in their order.
pub fn outcomes(plan: &Plan, all: &[InputSensitivity]) -> Vec<String> {
    let mut names = crate::analysis::outcomes::outcomes(plan);
    names.retain(|name| all.iter().any(|one| one.observable == *name));
    names
}

/// Reason for refusing all driver tests ([`Plan::bound_inputs`]); `None` if tests ran or there is nothing to test.
pub fn refused(plan: &Plan, all: &[InputSensitivity]) -> Option<String> {
    let rows = all.first()?.rows;
    plan.bound_inputs(rows)?;
    let design = plan.design.name();
    Some(format!(
        "no driver was tested: in {rows} runs of design {design} some inputs vary together; design random tells them \
        apart"
    ))
}

pub fn ranked<'a>(plan: &Plan, all: &'a [InputSensitivity], outcome: &str) -> Vec<Ranking<'a>> {
    if refused(plan, all).is_some() {
        return Vec::new();
    }
    rankings(all, outcome, 1.0 - plan.analysis.confidence)
}

pub(super) fn found(plan: &Plan, all: &[InputSensitivity], outcome: &str) -> Vec<String> {
    let rankings = ranked(plan, all, outcome);
    let known = rankings.iter().filter(|ranking| ranking.drivers().next().is_some());
    known.map(|ranking| sentence(plan, outcome, ranking)).collect()
}

const DRIVEN: usize = 3;

/// A finding for each ranking, with its drivers as children: rankings with drivers first, then unmet outcomes, then
/// events of unmet requirements, spread last; outcomes in the order of `required`, then the others, then errors, each
/// strongest first.
pub(super) fn findings(
    plan: &Plan,
    analysed: &Analysed,
    (noise, required): (&[NoiseShare], &[String]),
) -> Vec<Finding> {
    let (all, verdicts) = (&analysed.sensitivities, &analysed.verdicts);
    let share = |one: &Finding| one.children.first().and_then(|driver| driver.numbers.first()).map(|share| share.value);
    let strength = |one: &Finding| share(one).filter(|share| share.is_finite()).unwrap_or(0.0);
    let is_error = |name: &str| analysed.survey.outcome(name).is_some_and(|(_, outcome)| outcome.is_error);
    let place = |name: &str| {
        let place = required.iter().position(|one| one == name);
        place.unwrap_or(required.len() + usize::from(is_error(name)))
    };
    let mut found: Vec<(Finding, ([bool; 3], usize))> = Vec::new();
    let mut few: Vec<(String, u64)> = Vec::new();
    for outcome in outcomes(plan, all) {
        let has_runs = |ranking: &&Ranking<'_>| ranking.inputs.first().is_some_and(|first| first.input.rows > 0);
        for ranking in ranked(plan, all, &outcome).iter().filter(has_runs) {
            let one = finding(plan, analysed, &outcome, ranking);
            few.extend(too_few(ranking).map(|runs| (one.title.clone(), runs)));
            let order = [one.children.is_empty(), is_met(verdicts, &outcome), is_settled(verdicts, ranking)];
            found.push((one, (order, place(&outcome))));
        }
    }
    found.sort_by(|(one, order), (other, after)| order.cmp(after).then(strength(other).total_cmp(&strength(one))));
    // one entry for identical empty results
    let mut list: Vec<Finding> = Vec::new();
    for (one, _) in found {
        let same = list.last_mut().filter(|last| last.children.is_empty() && last.sentence.ends_with(&one.sentence));
        match same {
            Some(last) => {
                let titles = last.sentence.strip_suffix(&one.sentence).filter(|_| last.title.is_empty());
                let titles = titles.map_or(last.title.as_str(), |titles| titles.trim_end_matches(": "));
                last.sentence = format!("{titles}; {}: {}", one.title, one.sentence);
                last.title.clear();
            }
            None => list.push(one),
        }
    }
    let mut found = list;
    let most = if verdicts.list.is_empty() { DRIVEN } else { 1 };
    let mut seen: Vec<String> = Vec::new();
    for one in &mut found {
        let outcome = one.title.split(": ").next().unwrap_or_default().to_owned();
        let is_first = !one.children.is_empty() && seen.len() < most && !seen.contains(&outcome);
        seen.extend(is_first.then_some(outcome));
        one.rank = u8::from(!is_first);
    }
    let about =
        |id: &str, title: &str, rank: u8, said: String| Finding { rank, ..Finding::new(Kind::Driver, id, title, said) };
    if let Some(why) = loss::all_fail(&analysed.missions) {
        found.insert(0, about("all_fail", "failures", 0, why));
    } else if let Some(why) = refused(plan, all) {
        found = vec![about("untold", "", 0, why)];
    } else if let Some(first) = found.first_mut().filter(|_| seen.is_empty() && !analysed.statistics.loss().is_big()) {
        first.rank = 0;
    }
    if let Some(runs) = few.iter().map(|(_, runs)| *runs).max() {
        let said = format!("{} are too few for shares of the variance", counted(runs, "run"));
        let is_shown = |one: &Finding| one.rank == 0 && few.iter().any(|(title, _)| *title == one.title);
        let rank = u8::from(!found.iter().any(is_shown));
        let more = if few.len() > 1 { format!(" and {} more", few.len() - 1) } else { String::new() };
        found.push(about("few", &format!("{}{more}", few[0].0), rank, said));
    }
    let has_rest = found.iter().any(|one| one.sentence.contains("; the rest is "));
    if has_rest && !matches!(plan.design, Design::Saltelli(_)) {
        found.push(about("interactions", "shares of the variance", 1, SEE_INTERACTIONS.to_owned()));
    }
    if plan.law.is_some() && noise.is_empty() && !all.is_empty() {
        let said = "noise in the loop is no input: spindrift report . --noise 256 measures its share";
        found.push(about("noise", "", 1, said.to_owned()));
    }
    found.extend(noise.iter().map(|one| noise::finding(plan, one)));
    found
}

fn is_met(verdicts: &Verdicts, outcome: &str) -> bool {
    let mut of = verdicts.list.iter().filter(|one| one.requirement.observable() == Some(outcome));
    of.all(|one| one.gate.decision == Decision::Pass)
}

/// True if a ranking matters less: the requirement is met, or it explains only the spread.
fn is_settled(verdicts: &Verdicts, ranking: &Ranking<'_>) -> bool {
    match ranking.question {
        Question::Event(Event { occurs: Occurs::Missed { requirement, .. }, .. }) => {
            verdicts.list.get(requirement).is_some_and(|one| one.gate.decision == Decision::Pass)
        }
        Question::Event(_) => false,
        Question::Spread => true,
    }
}

fn finding(plan: &Plan, analysed: &Analysed, outcome: &str, ranking: &Ranking<'_>) -> Finding {
    let unit = analysed.statistics.column(outcome).map_or("", |column| column.quantity.unit());
    let name = names::of_column(outcome, unit);
    let (title, part) = match &ranking.question {
        Question::Spread => (name, String::new()),
        Question::Event(event) => (format!("{name}: which runs {}", verb(plan, outcome, event, u64::MAX)), part(event)),
    };
    let row = match &ranking.question {
        Question::Event(event) => row(event),
        Question::Spread => String::new(),
    };
    let driver = |ranked: &Ranked<'_>| {
        let input = &ranked.input.input;
        let figures = Figures { small: Some(format!("scatter_{outcome}{row}_{input}")), large: None };
        let share = ranked.share.filter(is_known).map(|share| {
            Number::share("share of the variance", share.value, [share.lower, share.upper], ranked.input.rows)
        });
        let found = Finding::new(Kind::Driver, input, names::of_input_column(plan, input), "");
        Finding { numbers: share.into_iter().collect(), figures, ..found }
    };
    let figures = Figures { small: None, large: Some(format!("influence_{outcome}{part}")) };
    let found = Finding::new(Kind::Driver, format!("drivers_{outcome}{part}"), title, sentence(plan, outcome, ranking));
    Finding { children: ranking.drivers().map(driver).collect(), figures, ..found }
}

/// Suffix of the names of figures of single runs, for one of several requirements on an outcome.
pub fn row(event: &Event) -> String {
    match event.occurs {
        Occurs::Missed { is_only: false, .. } => part(event),
        _ => String::new(),
    }
}

/// Suffix of figure names for an event.
pub fn part(event: &Event) -> String {
    match event.occurs {
        Occurs::Missed { requirement, is_only: false } => format!("_event_{}", requirement + 1),
        _ if event.has_few_values => String::new(),
        _ => "_event".to_owned(),
    }
}
