//! One ranking of inputs as a sentence; where there are no drivers, the effect that the runs would have shown.

use crate::analysis::drivers::{LEAST_CHANCE, LEAST_SHARE, Question, Ranked, Ranking, is_known};
use crate::analysis::effects::{Dependence, Direction, Level};
use crate::analysis::event::{Event, Occurs};
use crate::analysis::input_sensitivity::COMPUTED;
use crate::analysis::observed::Observed;
use crate::campaign::{Plan, ShownUnit};
use crate::findings::number::{self, brief, counted, outward, short, with_unit};
use crate::findings::{names, requirement};
use crate::math::normal;
use crate::statistics::binomial::POWER;
use crate::statistics::contingency::Occurrence;
use crate::statistics::correlation::Estimate;
use crate::statistics::quantile::percent;

const NAMED: usize = 2;

pub fn verb(plan: &Plan, outcome: &str, event: &Event, runs: u64) -> String {
    let of = |one: &'static str, several: &'static str| if runs == 1 { one } else { several };
    match event.occurs {
        Occurs::Missed { is_only: true, .. } if ["launched", "failure"].contains(&outcome) => {
            of("fails", "fail").to_owned()
        }
        Occurs::Missed { is_only: true, .. } => format!("{} the limit", of("misses", "miss")),
        Occurs::Missed { requirement, .. } => {
            format!("{} the limit of {}", of("misses", "miss"), limit(plan, requirement))
        }
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

/// The limit of a requirement: "at least 6 s", and whether runs without a value violate it.
fn limit(plan: &Plan, requirement: usize) -> String {
    let one = &plan.analysis.requirements[requirement];
    let observed = Observed::named(plan, one.observable().into_iter());
    let unit = observed.first().map_or("", |observed| observed.quantity.unit());
    let value = one.limit.value();
    let shown = plan.analysis.display.of(one.name(), if unit == "1" { "" } else { unit });
    let never = if one.never_meets { " (no value meets it)" } else { "" };
    requirement::limit_text(one.limit, &shown.of_time(value.abs(), Some(value))) + never
}

/// "the runs that fail", "the worst 5% of runs".
fn such_runs(plan: &Plan, outcome: &str, event: &Event) -> String {
    match event.occurs {
        Occurs::Worst(share) => format!("the worst {}% of runs", short(libm::round(1e9 * share) / 1e7)),
        _ => format!("the runs that {}", verb(plan, outcome, event, u64::MAX)),
    }
}

pub fn sentence(plan: &Plan, outcome: &str, ranking: &Ranking<'_>) -> String {
    let said = match &ranking.question {
        Question::Event(event) => {
            // the title has the limit
            let occurs = match event.occurs {
                Occurs::Missed { requirement, .. } => Occurs::Missed { requirement, is_only: true },
                other => other,
            };
            let event = &Event { occurs, ..*event };
            of_event(plan, [outcome, &such_runs(plan, outcome, event)], event, ranking)
        }
        Question::Spread => of_spread(plan, ranking),
    };
    said + &correlations(plan, ranking)
}

fn correlations(plan: &Plan, ranking: &Ranking<'_>) -> String {
    let mut pairs: Vec<[&str; 2]> = Vec::new();
    let mut said = String::new();
    let has_shares = told(ranking).len() > 1;
    for driver in ranking.drivers().take(NAMED) {
        let one = driver.input.input.as_str();
        let with = driver.input.correlated_with.as_ref();
        let Some(other) = driver.instead().or(with.map(|(other, _)| other.as_str())) else { continue };
        if pairs.contains(&[other, one]) {
            continue;
        }
        pairs.push([one, other]);
        let r = with.filter(|(name, _)| name == other).map_or_else(String::new, |(_, r)| format!(" ({r:.2})"));
        let [one, other] = [one, other].map(|column| names::of_input_column(plan, column));
        let apart = match driver.instead() {
            Some(_) => ", and these runs do not tell which of them acts",
            None if has_shares => ", so their shares overlap",
            None => "",
        };
        said += &format!("; {one} and {other} are correlated{r}{apart}");
    }
    said
}

fn of_event(plan: &Plan, [outcome, runs]: [&str; 2], event: &Event, ranking: &Ranking<'_>) -> String {
    if let Some(together) = at_a_distance(plan, runs, ranking) {
        return together;
    }
    let confidence = percent(plan.analysis.confidence);
    let phrase = |ranked: &Ranked<'_>| {
        let column = &ranked.input.input;
        let name = names::of_input_column(plan, column);
        let shown =
            names::place_of(plan, column).map_or_else(|| ShownUnit::own(""), |place| names::unit_of_input(plan, place));
        let amount = |value: f64| with_unit(short(shown.value(value)), &shown.unit);
        let dependence = ranked.effect.map(|effect| &effect.dependence)?;
        Some(match dependence {
            Dependence::Levels { levels, most, ratio } => {
                let level = |level: &Level| {
                    let value =
                        level.value.map_or("at other values".to_owned(), |value| format!("= {}", amount(value)));
                    format!(
                        "{value}: {} of {} {}",
                        level.of.events,
                        level.of.runs,
                        verb(plan, outcome, event, level.of.events)
                    )
                };
                let mut listed: Vec<&Level> = levels.iter().collect();
                let first = listed.remove(*most);
                listed.insert(0, first);
                let listed: Vec<String> = listed.into_iter().map(level).collect();
                let end = |end: f64| if end.is_finite() { brief(end) } else { "no bound".to_owned() };
                let times = if ratio.lower.is_nan() && ratio.upper.is_nan() {
                    format!("risk ratio {}", brief(ratio.value))
                } else if ratio.value.is_finite() {
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
        let [said, of_one] = [of.events, 1].map(|runs| verb(plan, outcome, event, runs));
        let power = power_on_event(plan, ranking, of, &of_one);
        return format!("{} of {} runs {said}; no input was found that explains which{power}", of.events, of.runs);
    }
    let mut said = named.join("; ");
    if let Some((again, _)) = said.match_indices(runs).nth(1) {
        said.replace_range(again..again + runs.len(), "these runs");
    }
    said
}

/// One phrase for several named drivers that are all farther from, or all nearer to, their medians; else `None`.
fn at_a_distance(plan: &Plan, runs: &str, ranking: &Ranking<'_>) -> Option<String> {
    let is_far = |ranked: &Ranked<'_>| match ranked.effect?.dependence {
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

/// The drivers that are named: next to large shares no negligible ones.
fn named<'r, 'a>(ranking: &'r Ranking<'a>) -> Vec<&'r Ranked<'a>> {
    let is_small = |ranked: &&Ranked<'_>| ranked.share.filter(is_known).is_some_and(|share| share.value < LEAST_SHARE);
    let (small, large): (Vec<_>, Vec<_>) = ranking.drivers().take(NAMED).partition(is_small);
    if large.is_empty() { small } else { large }
}

/// True if the runs leave a share open; those of chosen samples have no interval.
fn is_open(ranked: &Ranked<'_>) -> bool {
    /// Widest interval of a share that may be zero.
    const MOST_WIDTH: f64 = 0.5;
    ranked.share.filter(|share| share.lower.is_nan()).is_none()
        && ranked
            .share
            .filter(is_known)
            .is_none_or(|share| share.value <= 0.0 || share.lower <= 0.0 && share.upper - share.lower > MOST_WIDTH)
}

/// The shares of the first of the named drivers of a spread, up to one that the runs do not show.
fn told(ranking: &Ranking<'_>) -> Vec<String> {
    let share = |driver: &Ranked<'_>| {
        // a negligible estimate contradicts the test that found the input
        let is_told = |share: &Estimate| !share.lower.is_nan() && share.value >= LEAST_SHARE;
        let share = driver.share.filter(|share| is_told(share) && !is_open(driver))?;
        let within = |end: f64| end.clamp(0.0, 1.0);
        Some(number::share([within(share.value); 2], [share.lower, share.upper].map(within)))
    };
    let drivers = named(ranking).into_iter().filter(|_| ranking.question == Question::Spread);
    drivers.map_while(share).collect()
}

fn of_spread(plan: &Plan, ranking: &Ranking<'_>) -> String {
    let Some(first) = ranking.inputs.first() else { return String::new() };
    let runs = counted(first.input.rows, "run");
    let direction = |ranked: &Ranked<'_>| match ranked.input.direction {
        Some(Direction::Rises) => " (rises with it)",
        Some(Direction::Falls) => " (falls with it)",
        Some(Direction::NotMonotonic) => " (not monotonic)",
        None => "",
    };
    let rest = rest(plan, ranking).map_or_else(String::new, |rest| format!("; {rest}"));
    let drivers = named(ranking);
    if drivers.is_empty() {
        let most = ranking.inputs.iter().map(|ranked| ranked.share.filter(is_known).map(|share| share.upper));
        return match most.collect::<Option<Vec<f64>>>() {
            Some(ends) if ends.iter().all(|end| *end < 0.995) => {
                let most = (100.0 * ends.into_iter().fold(0.0, f64::max)).ceil();
                format!("no single input explains more than {most:.0}% of the variance{rest}")
            }
            _ => format!("no input was found in {runs}{}", power_on_spread(plan, ranking)),
        };
    }
    if first.input.total.is_some() {
        let of = |driver: &&Ranked<'_>| {
            let share = driver.share.filter(|share| share.value >= LEAST_SHARE);
            let share = share.map_or_else(|| format!("below {LEAST_SHARE}"), |share| format!("{:.2}", share.value));
            format!("{} {share}{}", names::of_input_column(plan, &driver.input.input), direction(driver))
        };
        return format!("total Sobol indices: {}", drivers.iter().map(of).collect::<Vec<_>>().join(", "));
    }
    let shares = told(ranking);
    let of = |(place, driver): (usize, &&Ranked<'_>)| {
        let share = match (shares.get(place), place) {
            (Some(share), 0) => format!(" explains {share} of the variance"),
            (Some(share), _) => format!(" {share}"),
            (None, _) => String::new(),
        };
        format!("{}{share}{}", names::of_input_column(plan, &driver.input.input), direction(driver))
    };
    let said = drivers.iter().enumerate().map(of).collect::<Vec<_>>().join(", ");
    if shares.is_empty() { said } else { said + &rest }
}

/// The number of runs, if it is too small to estimate the share of the first driver.
pub fn too_few(ranking: &Ranking<'_>) -> Option<u64> {
    let first = named(ranking).into_iter().next().filter(|_| ranking.question == Question::Spread)?;
    (first.input.total.is_none() && is_open(first)).then_some(first.input.rows)
}

/// The source of the remaining variance, if the drivers explain less than half.
fn rest(plan: &Plan, ranking: &Ranking<'_>) -> Option<String> {
    let shares = ranking.drivers().map(|ranked| ranked.share.filter(is_known).map(|share| share.value));
    let share: f64 = shares.collect::<Option<Vec<f64>>>()?.iter().sum();
    if share >= 0.5 || ranking.inputs.first()?.input.total.is_some() {
        return None;
    }
    let noise = if plan.law.is_some() { "noise in the loop, " } else { "" };
    Some(format!("the rest is {noise}interactions, or effects too small to show"))
}

/// Sum of the normal quantiles of level and power for one of `inputs` tests (Bonferroni).
fn reach(plan: &Plan, inputs: usize) -> f64 {
    let level = 0.5 * (1.0 - plan.analysis.confidence) / inputs.max(1) as f64;
    -normal::quantile(level) + normal::quantile(POWER)
}

/// The effect found in nine of ten such campaigns, by Fisher's transformation of a rank correlation.
fn power_on_spread(plan: &Plan, ranking: &Ranking<'_>) -> String {
    let rows = ranking.inputs.first().map_or(0, |first| first.input.rows);
    let tested = ranking.inputs.iter().filter(|ranked| ranked.input.p_value.is_some()).count();
    if rows <= 3 || tested == 0 {
        return String::new();
    }
    let r = libm::tanh(reach(plan, tested) / libm::sqrt(rows as f64 - 3.0));
    let share = (100.0 * f64::max(r * r, LEAST_SHARE)).ceil();
    format!("; one that it rises or falls with, and that explains {share:.0}% of it, is found in 90% of such campaigns")
}

/// As [`power_on_spread`], for the probability that a run with the event has the larger value (H. B. Mann & D. R.
/// Whitney, 1947).
fn power_on_event(plan: &Plan, ranking: &Ranking<'_>, of: Occurrence, verb: &str) -> String {
    let (with, without) = (of.events as f64, (of.runs - of.events) as f64);
    if ranking.inputs.is_empty() || with * without == 0.0 {
        return String::new();
    }
    let error = libm::sqrt((with + without + 1.0) / (12.0 * with * without));
    let chance = 0.5 + f64::max(reach(plan, ranking.inputs.len()) * error, LEAST_CHANCE);
    if chance >= 0.995 {
        return "; so few runs show none".to_owned();
    }
    let chance = (100.0 * chance).ceil();
    format!(
        "; one that is larger in a run that {verb} than in another with a chance of {chance:.0}% is found in 90% of \
         such campaigns"
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::input_sensitivity::InputSensitivity;

    /// The sentence on the spread if these inputs have these shares and are drivers or not.
    fn said<const N: usize>(inputs: &[InputSensitivity; N], shares: [(Option<Estimate>, bool); N]) -> String {
        let of = |(input, (share, is_driver))| Ranked { input, effect: None, share, is_driver };
        let inputs = inputs.iter().zip(shares).map(of).collect();
        sentence(&crate::findings::shipped::plan("spin_sweep"), "y", &Ranking { question: Question::Spread, inputs })
    }

    fn input(name: &str) -> InputSensitivity {
        InputSensitivity { input: name.to_owned(), rows: 77, ..Default::default() }
    }

    /// Law: shares appear with their intervals, none behind a driver without one, and only if that is informative: not
    /// for too few runs, a wide interval, or chosen samples. "No input explains more than" needs the upper ends of all
    /// inputs. Drivers are always named.
    #[test]
    fn shares_are_said_with_intervals_or_not_at_all() {
        let estimate = |value, lower, upper| Some(Estimate { value, lower, upper });
        let known = estimate(0.5, 0.4, 0.625);
        for (share, is_told, most) in [
            (known, true, Some(63)),
            (None, false, None),
            (estimate(0.99, 0.0, 1.0), false, None),
            (estimate(0.5, 0.1, 0.95), false, None),
            (estimate(0.33, -0.1, 0.57), false, Some(57)),
            (estimate(0.5, f64::NAN, f64::NAN), false, None),
        ] {
            for is_driver in [true, false] {
                let inputs = ["first_one", "second_one"].map(input);
                let both = said(&inputs, [share, known].map(|share| (share, is_driver)));
                assert_eq!(both.contains("first"), is_driver, "{both}");
                let is_most = both.contains("more than 63% of the variance");
                assert_eq!(is_most, most.is_some() && !is_driver, "{both}");
                let all = "first one explains 50% [40, 63] of the variance, second one 50% [40, 63]";
                assert_eq!(both.contains(all), is_driver && is_told, "{both}");
                assert_eq!(both.contains('%'), is_told || is_most, "{both}");
                let other = said(&inputs, [(known, is_driver), (share, is_driver)]);
                assert_eq!(other.contains(all.split(',').next().unwrap_or_default()), is_driver, "{other}");
                let alone = said(&[input("first_one")], [(share, is_driver)]);
                let is_most = most.is_some_and(|most| alone.contains(&format!("more than {most}% of")));
                assert!(alone.contains('%') == (is_told || is_most) && is_most == (most.is_some() && !is_driver));
            }
        }
    }

    /// Law: a negligible share is not listed, alone or next to a large one.
    #[test]
    fn negligible_shares_are_not_listed() {
        let estimate = |value: f64| Some(Estimate { value, lower: 0.5 * value, upper: (2.0 * value).min(1.0) });
        for (shares, names) in [([0.4, 1e-4], [true, false]), ([0.4, 0.3], [true; 2]), ([1e-4, 1e-4], [true; 2])] {
            let inputs = ["first_one", "second_one"].map(input);
            let said = said(&inputs, shares.map(|share| (estimate(share), true)));
            assert_eq!(["first", "second"].map(|name| said.contains(name)), names, "{said}");
            assert!(!said.contains("0.0"), "{said}");
        }
    }

    /// Law: the correlation of two inputs appears once, with whether the rows separate them.
    #[test]
    fn correlated_inputs_are_told() {
        let correlated = |name: &str, other: &str, instead: bool| InputSensitivity {
            correlated_with: Some((other.to_owned(), 0.8)),
            instead: instead.then(|| other.to_owned()),
            ..input(name)
        };
        for (instead, told) in [
            (false, "; a and b are correlated (0.80)"),
            (true, "; a and b are correlated (0.80), and these runs do not tell which of them acts"),
        ] {
            let inputs = [correlated("a", "b", instead), correlated("b", "a", false)];
            for is_driver in [true, false] {
                assert!(said(&inputs, [(None, true), (None, is_driver)]).ends_with(told));
            }
        }
    }

    /// Law: an event that no input explains has the effect that its runs would have shown, in words of one run.
    #[test]
    fn unexplained_events_have_a_smallest_effect() {
        let event =
            Event { occurs: Occurs::Worst(0.05), of: Occurrence { events: 20, runs: 400 }, has_few_values: false };
        let named = input("first_one");
        let inputs = vec![Ranked { input: &named, effect: None, share: None, is_driver: false }];
        let ranking = Ranking { question: Question::Event(event), inputs };
        // 0.5 + (1.960 + 1.282) sqrt(401/(12 20 380)) = 0.715
        let told = "20 of 400 runs are among the worst 5%; no input was found that explains which; one that is larger \
                    in a run that is among the worst 5% than in another with a chance of 72% is found in 90% of such \
                    campaigns";
        assert_eq!(sentence(&crate::findings::shipped::plan("spin_sweep"), "y", &ranking), told);
    }
}
