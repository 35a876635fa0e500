//! What drives an outcome, in words: on the screen, on the cards and at the charts of the page.

use crate::analysis::drivers::{Question, Ranked, Ranking, rankings};
use crate::analysis::effects::{Dependence, Direction, Level};
use crate::analysis::event::{Event, Occurs};
use crate::analysis::input_sensitivity::{COMPUTED, InputSensitivity};
use crate::campaign::{Plan, ShownUnit};
use crate::report::names;
use crate::report::number::{brief, counted, outward, short};
use crate::report::origin_text::unit_of;
use crate::sampling::Design;
use crate::statistics::quantile::percent;
use crate::table::Table;
use crate::table::text::Align;

const NAMED: usize = 2;
/// Runs from which on a share of the variance is said, and more than one driver of it is named: of 30 runs a share of 50% is known to within 26%, of 6 not at all.
const RUNS_OF_SHARES: u64 = 30;

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
    let runs = counted(first.input.rows, "run");
    let name = |ranked: &Ranked<'_>| names::of_input_column(plan, &ranked.input.input);
    let direction = |ranked: &Ranked<'_>| match ranked.input.direction {
        Some(Direction::Rises) => " (rises with it)",
        Some(Direction::Falls) => " (falls with it)",
        Some(Direction::NotMonotonic) => " (not monotonic)",
        None => "",
    };
    let drivers: Vec<&Ranked<'_>> = ranking.drivers().take(NAMED).collect();
    if !is_total && first.input.rows < RUNS_OF_SHARES {
        return match drivers.first() {
            Some(driver) => format!(
                "{}{}; {runs} are too few to say how much of the variance it explains",
                name(driver),
                direction(driver)
            ),
            None => format!("no input was found to drive it in {runs}"),
        };
    }
    let said: Vec<String> = if is_total {
        let of = |driver: &&Ranked<'_>| format!("{} {:.2}{}", name(driver), driver.share.value, direction(driver));
        drivers.iter().map(of).collect()
    } else {
        let shares = said_shares(&drivers.iter().map(|driver| driver.share.value).collect::<Vec<f64>>());
        let of = |(driver, share): (&&Ranked<'_>, String)| format!("{} {share}{}", name(driver), direction(driver));
        drivers.iter().zip(shares).map(of).collect()
    };
    let rest = rest(plan, ranking).map_or_else(String::new, |rest| format!("; {rest}"));
    if !said.is_empty() {
        let measure = if is_total { "total Sobol indices: " } else { "" };
        return format!("{measure}{}{rest}", said.join(", "));
    }
    let most = ranking.inputs.iter().map(|ranked| ranked.share.value).fold(0.0, f64::max);
    format!("no single input was found to explain more than {:.0}% of the variance{rest}", (100.0 * most).ceil())
}

/// What is said of drivers with these shares of the variance, the largest first. Each share is that of one input alone, some by index and some by rank, so that
/// they may overlap: of one that does not fit beside those before it only the order is said, and that of estimates near one is no more than "over 99%".
fn said_shares(shares: &[f64]) -> Vec<String> {
    let mut sum = 0.0;
    let say = |(place, share): (usize, &f64)| {
        let percent = libm::round(100.0 * share);
        let fits = place == 0 || sum + percent <= 100.0;
        sum = if fits { sum + percent } else { f64::INFINITY };
        match (place, fits) {
            (0, _) if percent >= 100.0 => "explains over 99% of the variance".to_owned(),
            (0, _) => format!("explains {percent:.0}% of the variance"),
            (_, true) => format!("{percent:.0}%"),
            (_, false) => "less".to_owned(),
        }
    };
    shares.iter().enumerate().map(say).collect()
}

/// What the rest of the variance is, where the drivers explain less than half of it.
fn rest(plan: &Plan, ranking: &Ranking<'_>) -> Option<String> {
    let share: f64 = ranking.drivers().map(|ranked| ranked.share.value).sum();
    let first = ranking.inputs.first()?.input;
    if share >= 0.5 || first.total.is_some() {
        return None;
    }
    let together = first.r_squared.map_or(0.0, |of| of.value);
    if together >= 0.5 {
        return Some(format!("a linear regression on all inputs together explains {:.0}%", (100.0 * together).floor()));
    }
    let noise = if plan.law.is_some() { "noise in the loop, " } else { "" };
    Some(format!("the rest is {noise}interactions, or effects too small to show"))
}

/// The rankings of an outcome in words; empty where no influence was estimated.
pub fn driven_by(plan: &Plan, all: &[InputSensitivity], outcome: &str) -> Vec<String> {
    ranked(plan, all, outcome).iter().map(|ranking| sentence(plan, outcome, ranking)).collect()
}

/// Lines of `width` characters for each outcome; nothing where no influence was estimated.
pub fn text(plan: &Plan, all: &[InputSensitivity], width: usize) -> String {
    let mut table = Table::with([("", Align::Left), ("", Align::Sentence)]);
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
    /// Law: of any shares, as they are estimated, those that are said add up to no more than 100%, the first is always said, and of none that is said more is said than it is.
    #[test]
    fn shares_that_are_said_fit_in_the_whole() {
        let percents = [0, 10, 20, 32, 33, 40, 49, 50, 51, 60, 76, 80, 99, 100, 103];
        for first in percents {
            for second in percents.into_iter().filter(|second| *second <= first) {
                for third in percents.into_iter().filter(|third| *third <= second) {
                    for shift in [-0.004_9, 0.0, 0.004_9] {
                        let shares = [first, second, third].map(|percent| f64::from(percent) / 100.0 + shift);
                        let said = said_shares(&shares);
                        let known: Vec<f64> = said
                            .iter()
                            .filter_map(|text| {
                                text.split(' ').find_map(|word| word.strip_suffix('%')?.parse::<f64>().ok())
                            })
                            .collect();
                        assert!(known.iter().sum::<f64>() <= 100.0, "{shares:?}: {said:?}");
                        let places = known.iter().zip(shares);
                        let is_near = |(known, share): (&f64, f64)| (known - 100.0 * share).abs() <= 0.501;
                        assert!(
                            places
                                .clone()
                                .all(|(known, share)| *known == 99.0 && share > 0.99 || is_near((known, share))),
                            "{shares:?}: {said:?}"
                        );
                        assert!(!known.is_empty() && said[known.len()..].iter().all(|text| text == "less"), "{said:?}");
                        let fits = shares[0] + shares[1] <= 0.989;
                        assert!(!fits || known.len() >= 2, "{shares:?}: {said:?}");
                    }
                }
            }
        }
    }

    /// Law: of fewer than 30 runs no share is said, and one driver at most, whatever was estimated; of more shares and drivers are said.
    #[test]
    fn few_runs_have_no_shares() {
        let text = include_str!("../../campaigns/spin_sweep.toml");
        let plan = Plan::from_text("spin_sweep", text, Overrides::default()).expect("valid");
        for rows in [4, 6, 12, 29, 30, 300] {
            for is_driver in [true, false] {
                let input = |name: &str| InputSensitivity { input: name.to_owned(), rows, ..Default::default() };
                let inputs = ["first_one", "second_one"].map(input);
                let share = |value: f64| Estimate { value, lower: 0.1, upper: 1.0 };
                let ranked =
                    |place: usize| Ranked { input: &inputs[place], share: share([0.5, 0.3][place]), is_driver };
                let ranking = Ranking { question: Question::Spread, inputs: vec![ranked(0), ranked(1)] };
                let said = sentence(&plan, "y", &ranking);
                let is_few = rows < 30;
                assert_eq!(said.contains('%'), !is_few, "{said}");
                assert_eq!(said.contains("second"), is_driver && !is_few, "{said}");
                assert_eq!(said.contains("first"), is_driver, "{said}");
                assert!(!is_few || said.contains(&format!("{rows} runs")), "{said}");
            }
        }
    }
}
