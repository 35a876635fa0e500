//! What drives an outcome, in words: on the screen, on the cards and at the charts of the page.

use crate::analysis::drivers::{Question, Ranked, Ranking, rankings};
use crate::analysis::effects::{Dependence, Direction, Level};
use crate::analysis::event::{Event, Occurs};
use crate::analysis::input_sensitivity::{COMPUTED, InputSensitivity};
use crate::campaign::{Plan, ShownUnit};
use crate::report::names;
use crate::report::number::{brief, outward, short};
use crate::report::origin_text::unit_of;
use crate::report::text_table::{Align, TextTable};
use crate::sampling::Design;
use crate::statistics::quantile::percent;

const NAMED: usize = 2;

/// How a campaign shows interactions.
pub const SEE_INTERACTIONS: &str =
    "interactions of inputs are not included, but are in total indices (design.kind = \"saltelli\")";

/// The observables of `all` whose drivers are shown: the outcomes of the campaign.
pub fn outcomes<'a>(plan: &Plan, all: &'a [InputSensitivity]) -> Vec<&'a str> {
    let mut names: Vec<&str> = all.iter().map(|one| one.observable.as_str()).collect();
    names.dedup();
    let order = crate::analysis::outcomes::outcomes(plan);
    let place = |name: &&str| order.iter().position(|outcome| outcome == name);
    names.retain(|name| place(name).is_some());
    names.sort_by_key(place);
    names
}

/// The rankings of an outcome, at the confidence of the plan.
pub fn ranked<'a>(plan: &Plan, all: &'a [InputSensitivity], outcome: &str) -> Vec<Ranking<'a>> {
    rankings(all, outcome, 1.0 - plan.analysis.confidence)
}

/// What happens in a run in which the event of `outcome` occurs: "fail".
pub fn verb(outcome: &str, event: &Event, runs: u64) -> String {
    let of = |one: &'static str, several: &'static str| if runs == 1 { one } else { several };
    match event.occurs {
        Occurs::Missed if ["launched", "failure"].contains(&outcome) => of("fails", "fail").to_owned(),
        Occurs::Missed => format!("{} the limit", of("misses", "miss")),
        Occurs::Value(value) if outcome == COMPUTED => {
            format!("{} {}computed", of("was", "were"), if value == 1.0 { "" } else { "not " })
        }
        Occurs::Value(value) => format!("{} {}", of("has", "have"), short(value)),
        Occurs::OtherThan(value) => format!("{} another value than {}", of("has", "have"), short(value)),
        Occurs::Worst(share) => {
            format!("{} among the worst {}%", of("is", "are"), short(libm::round(1e9 * share) / 1e7))
        }
    }
}

/// The runs in which the event of `outcome` occurs: "the runs that fail", "the worst 5% of runs".
fn such_runs(outcome: &str, event: &Event) -> String {
    match event.occurs {
        Occurs::Worst(share) => format!("the worst {}% of runs", short(libm::round(1e9 * share) / 1e7)),
        _ => format!("the runs that {}", verb(outcome, event, u64::MAX)),
    }
}

pub fn sentence(plan: &Plan, outcome: &str, ranking: &Ranking<'_>) -> String {
    match &ranking.question {
        Question::Event(event) => of_event(plan, [outcome, &such_runs(outcome, event)], event, ranking),
        Question::Spread => of_spread(plan, ranking),
    }
}

fn of_event(plan: &Plan, [outcome, runs]: [&str; 2], event: &Event, ranking: &Ranking<'_>) -> String {
    if let Some(together) = at_a_distance(plan, runs, ranking) {
        return together;
    }
    let confidence = percent(plan.analysis.confidence);
    let phrase = |ranked: &Ranked<'_>| {
        let column = &ranked.input.input;
        let name = names::of_input_column(plan, column);
        let shown = names::place_of(plan, column).map_or_else(|| ShownUnit::own(""), |place| unit_of(plan, place));
        let amount = |value: f64| format!("{} {}", short(shown.value(value)), shown.unit).trim_end().to_owned();
        let dependence = ranked.input.on_event.as_ref().map(|effect| &effect.dependence)?;
        Some(match dependence {
            Dependence::Levels { levels, most, ratio } => {
                let level = |level: &Level| {
                    let value =
                        level.value.map_or("at other values".to_owned(), |value| format!("= {}", amount(value)));
                    format!(
                        "{value}: {} of {} {}",
                        level.of.events,
                        level.of.runs,
                        verb(outcome, event, level.of.events)
                    )
                };
                let mut listed: Vec<&Level> = levels.iter().collect();
                let first = listed.remove(*most);
                listed.insert(0, first);
                let listed: Vec<String> = listed.into_iter().map(level).collect();
                let end = |end: f64| if end.is_finite() { brief(end) } else { "no bound".to_owned() };
                let times = if ratio.value.is_finite() {
                    let [low, high] = outward([ratio.lower, ratio.upper], 3).map(end);
                    format!("risk ratio {} [{low}, {high}]", brief(ratio.value))
                } else {
                    format!("risk ratio above {} with {confidence}% confidence", brief(ratio.lower))
                };
                format!("{name} {} ({times})", listed.join("; "))
            }
            Dependence::Shift { chance, medians } => {
                let word = if *chance > 0.5 { "larger" } else { "smaller" };
                let [with, without] = medians.map(amount);
                format!("{name} is {word} in {runs} (median {with}, others {without})")
            }
            Dependence::Distance { chance } => {
                let word = if *chance > 0.5 { "farther from" } else { "nearer to" };
                format!("{name} is {word} its median in {runs}")
            }
        })
    };
    let named: Vec<String> = ranking.drivers().take(NAMED).filter_map(phrase).collect();
    if named.is_empty() {
        let of = event.of;
        let verb = verb(outcome, event, of.events);
        return format!("{} of {} runs {verb}; no input was found that explains which", of.events, of.runs);
    }
    named.join("; ")
}

/// The drivers where all that are named are farther from their medians, or all nearer to them, in one phrase; `None` where they are not, or are not several.
fn at_a_distance(plan: &Plan, runs: &str, ranking: &Ranking<'_>) -> Option<String> {
    let is_far = |ranked: &Ranked<'_>| match ranked.input.on_event.as_ref()?.dependence {
        Dependence::Distance { chance } => Some(chance > 0.5),
        _ => None,
    };
    let named: Vec<&Ranked<'_>> = ranking.drivers().take(NAMED).collect();
    let first = is_far(named.first()?)?;
    if named.len() < 2 || named.iter().any(|ranked| is_far(ranked) != Some(first)) {
        return None;
    }
    let listed: Vec<String> = named.iter().map(|ranked| names::of_input_column(plan, &ranked.input.input)).collect();
    let word = if first { "farther from" } else { "nearer to" };
    Some(format!("{} are {word} their medians in {runs}", listed.join(" and ")))
}

fn of_spread(plan: &Plan, ranking: &Ranking<'_>) -> String {
    let Some(first) = ranking.inputs.first() else { return String::new() };
    let is_total = first.input.total.is_some();
    let name = |(place, ranked): (usize, &Ranked<'_>)| {
        let direction = match ranked.input.direction {
            Some(Direction::Rises) => " (rises with it)",
            Some(Direction::Falls) => " (falls with it)",
            Some(Direction::NotMonotonic) => " (not monotonic)",
            None => "",
        };
        let name = names::of_input_column(plan, &ranked.input.input);
        match (is_total, place) {
            (true, _) => format!("{name} {:.2}{direction}", ranked.share.value),
            (false, 0) => format!("{name} explains {:.0}% of the variance{direction}", 100.0 * ranked.share.value),
            (false, _) => format!("{name} {:.0}%{direction}", 100.0 * ranked.share.value),
        }
    };
    let names: Vec<String> = ranking.drivers().take(NAMED).enumerate().map(name).collect();
    let rest = rest(plan, ranking);
    if !names.is_empty() {
        let measure = if is_total { "total Sobol indices: " } else { "" };
        let rest = rest.map_or_else(String::new, |rest| format!("; {rest}"));
        return format!("{measure}{}{rest}", names.join(", "));
    }
    let most = ranking.inputs.iter().map(|ranked| ranked.share.value).fold(0.0, f64::max);
    let rest = rest.map_or_else(String::new, |rest| format!("; {rest}"));
    format!("no single input was found to explain more than {:.0}% of the variance{rest}", (100.0 * most).ceil())
}

/// What the rest of the variance is, where the drivers explain less than half of it.
fn rest(plan: &Plan, ranking: &Ranking<'_>) -> Option<String> {
    let share: f64 = ranking.drivers().map(|ranked| ranked.share.value).sum();
    let first = ranking.inputs.first()?.input;
    if share >= 0.5 || first.total.is_some() {
        return None;
    }
    let together = first.r_squared.map_or(0.0, |of| of.value);
    Some(match (together >= 0.5, plan.law.is_some()) {
        (true, _) => format!("a regression on all inputs together explains {:.0}%", (100.0 * together).floor()),
        (false, true) => "the rest is noise in the loop or interactions of inputs".to_owned(),
        (false, false) => "the rest is interactions of inputs, or effects too small for so few runs to show".to_owned(),
    })
}

/// The rankings of an outcome in words; empty where no influence was estimated.
pub fn driven_by(plan: &Plan, all: &[InputSensitivity], outcome: &str) -> Vec<String> {
    ranked(plan, all, outcome).iter().map(|ranking| sentence(plan, outcome, ranking)).collect()
}

/// Lines of `width` characters for each outcome; nothing where no influence was estimated.
pub fn text(plan: &Plan, all: &[InputSensitivity], width: usize) -> String {
    let mut table = TextTable::new([("", Align::Left), ("", Align::Sentence)]);
    let mut has_rest = false;
    for outcome in outcomes(plan, all) {
        for ranking in &ranked(plan, all, outcome) {
            table.row([outcome.to_owned(), sentence(plan, outcome, ranking)]);
            has_rest |= ranking.question == Question::Spread && rest(plan, ranking).is_some();
        }
    }
    let mut text = table.text(width);
    if has_rest && !matches!(plan.design, Design::Saltelli(_)) {
        text += &format!("  shares of the variance: {SEE_INTERACTIONS}\n");
    }
    if text.is_empty() { text } else { format!("\n  drivers\n{text}") }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::effects::OnEvent;
    use crate::campaign::Overrides;
    use crate::statistics::contingency::Occurrence;
    use crate::statistics::correlation::Estimate;

    /// Law: each kind of dependence is said as it is: on which side the runs with the event are, their median before that of the others, the level that differs most
    /// first, each with its counts.
    #[test]
    fn dependences_are_said_as_they_are() {
        let text = include_str!("../../campaigns/spin_sweep.toml");
        let plan = Plan::from_text("spin_sweep", text, Overrides::default()).expect("valid");
        let level = |value: f64, events, runs| Level { value: Some(value), of: Occurrence { events, runs } };
        let levels = vec![level(0.0, 1, 95), level(1.0, 4, 5)];
        let ratio = Estimate { value: 76.0, lower: 10.0, upper: 300.0 };
        for (dependence, said) in [
            (
                Dependence::Shift { chance: 0.9, medians: [3.0, 1.0] },
                "x is larger in the runs that miss the limit (median 3, others 1)",
            ),
            (
                Dependence::Shift { chance: 0.1, medians: [-3.0, 1.5] },
                "x is smaller in the runs that miss the limit (median -3, others 1.500)",
            ),
            (Dependence::Distance { chance: 0.9 }, "x is farther from its median in the runs that miss the limit"),
            (Dependence::Distance { chance: 0.1 }, "x is nearer to its median in the runs that miss the limit"),
            (
                Dependence::Levels { levels, most: 1, ratio },
                "x = 1: 4 of 5 miss the limit; = 0: 1 of 95 misses the limit (risk ratio 76 [10, 300])",
            ),
        ] {
            let of = Occurrence { events: 5, runs: 100 };
            let event = Event { occurs: Occurs::Missed, of, has_few_values: false };
            let share = Estimate { value: 0.5, lower: 0.4, upper: 0.6 };
            let on_event = Some(OnEvent { event, share, p_value: 1e-6, dependence });
            let input = InputSensitivity { input: "x".to_owned(), on_event, ..InputSensitivity::default() };
            let inputs = vec![Ranked { input: &input, share, is_driver: true }];
            let ranking = Ranking { question: Question::Event(event), inputs };
            assert_eq!(sentence(&plan, "y", &ranking), said);
        }
    }
}
