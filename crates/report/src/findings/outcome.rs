//! Distributions of outcomes: a finding for each, with quantiles, mean and extremes.

use crate::analysis::analysed::Analysed;
use crate::analysis::order_statistics::share_interval;
use crate::analysis::outcomes::{OF_MOTION, named, outcomes};
use crate::analysis::population::Population;
use crate::analysis::statistics::{ColumnStatistics, Statistics, is_yes_or_no};
use crate::campaign::{Plan, Requirement, Statement};
use crate::findings::finding::{Finding, Kind, Number};
use crate::findings::names;
use crate::findings::number::apart;
use crate::observables::Group;
use crate::observables::headlines::headlines;
use crate::statistics::quantile::percent;

const MOST_MAIN: usize = 7;
/// Shown after the observables of the motion.
const MAIN: [&str; 4] =
    ["angular_momentum_error_max", "linear_momentum_error_max", "state_error_estimate", "dcm_orthonormality_max"];
/// Maximum digits that separate the median from the extremes; differences beyond are rounding.
const MOST_DIGITS: usize = 8;
const SPREAD: [f64; 2] = [0.05, 0.95];

/// The observables shown to people: required, named or derived in the file, then the main ones.
pub(super) fn shown(plan: &Plan) -> Vec<String> {
    let columns = plan.request().columns();
    let has = |name: &&&str| columns.iter().any(|column| column.quantity.name() == **name);
    let main = OF_MOTION.iter().chain(&MAIN).filter(has).map(|name| (*name).to_owned());
    let mut names = named(plan);
    let main: Vec<String> = main.filter(|name| !names.contains(name)).take(MOST_MAIN).collect();
    names.extend(main);
    names
}

/// The observables of a summary: those shown to people, then the headlines of the plan and the final state.
pub fn summarised<'s>(plan: &Plan, statistics: &'s Statistics) -> Vec<&'s ColumnStatistics> {
    let columns = plan.request().columns();
    let main = headlines(&plan.request()).into_iter().map(|index| &columns[index]);
    let last = columns.iter().filter(|column| column.group == Group::FinalState);
    let others = main.chain(last).map(|column| column.quantity.name().to_owned());
    let of_motion = OF_MOTION.iter().map(|name| (*name).to_owned());
    let mut found: Vec<&ColumnStatistics> = Vec::new();
    for name in shown(plan).into_iter().chain(others).chain(of_motion) {
        let column = statistics.column(&name);
        found.extend(column.filter(|_| !found.iter().any(|one| one.quantity.name() == name)));
    }
    found
}

/// A finding for each outcome with a value, then the remarks on all of them.
pub(super) fn findings(plan: &Plan, analysed: &Analysed) -> Vec<Finding> {
    let statistics = &analysed.statistics;
    let (shown, first) = (shown(plan), outcomes(plan));
    let has_named = !named(plan).is_empty();
    let rank = |name: &str| match () {
        () if first.iter().any(|one| one == name) => 0,
        () if shown.iter().any(|one| one == name) => u8::from(has_named),
        () => 2,
    };
    let all = summarised(plan, statistics);
    let of = |column: &&ColumnStatistics| Finding {
        rank: rank(column.quantity.name()),
        ..finding(plan, statistics, column, analysed.tally.without_nominal)
    };
    let mut found: Vec<Finding> = all.iter().filter(|column| says_something(column)).map(of).collect();
    // the verdict already gives this share
    let is_stated = |one: &Finding| {
        let of_it = |requirement: &Requirement| requirement.observable() == Some(one.id.as_str());
        one.number("yes").is_some() && plan.analysis.requirements.iter().any(of_it)
    };
    found.iter_mut().filter(|one| is_stated(one)).for_each(|one| one.rank = one.rank.max(1));
    let about = |id: &str, rank: u8, said: String| Finding { rank, ..Finding::new(Kind::Outcome, id, "", said) };
    if found.is_empty() {
        let said = match analysed.tally.statuses.ok() {
            0 => "no run was computed: no statistics",
            _ => "no dispersed run was computed: no statistics",
        };
        return vec![about("none", u8::from(statistics.loss().is_big()), said.to_owned())];
    }
    if statistics.samples() > statistics.ok() {
        found.push(about("treatment", u8::from(statistics.loss().is_big()), statistics.treatment()));
    }
    if !statistics.population.has_intervals() {
        found.push(about("intervals", 1, statistics.population.about_intervals()));
    }
    found
}

/// True if a run has it, or failed runs determine its quantiles.
fn says_something(column: &ColumnStatistics) -> bool {
    column.moments.count() > 0
        || column.without_value > 0
        || column.quantiles.iter().any(|one| one.value.is_some() || one.interval != [None; 2])
}

fn finding(plan: &Plan, statistics: &Statistics, column: &ColumnStatistics, is_dispersed: bool) -> Finding {
    let (name, unit) = (column.quantity.name(), column.quantity.unit());
    let count = column.moments.count();
    let known = |value: Option<f64>| value.unwrap_or(f64::NAN);
    let [min, max] = [column.moments.min(), column.moments.max()].map(known);
    let shown = plan.analysis.display.of(name, unit).of_time(max.abs(), None);
    let number = |what: &str, value: f64, interval: [f64; 2]| Number::new(what, (value, interval), count, unit, &shown);
    let all = count + column.without_value;
    let of = if column.without_value > 0 { format!(" (in {count} of {all} runs)") } else { String::new() };
    let title = format!("{}{of}", names::of_quantity(&column.quantity));
    let found = Finding::new(Kind::Outcome, name, title, "");
    if !is_dispersed {
        return Finding { numbers: vec![number("value", max, [f64::NAN; 2])], ..found };
    }
    if is_yes_or_no(&column.moments) || name == "launched" {
        let yes = libm::round(known(column.moments.mean()) * count as f64) as u64;
        let missing = statistics.loss().missing;
        let interval = match statistics.population {
            Population::Independent if column.without_value == 0 => {
                share_interval(yes, [count, missing], statistics.confidence)
            }
            _ => [f64::NAN; 2],
        };
        let share = Number::share("yes", yes as f64 / count.max(1) as f64, interval, count);
        let sentence = format!("yes in {}", share.text());
        return Finding { numbers: vec![share], sentence, ..found };
    }
    let what = names::of_quantity(&column.quantity);
    if count == 0 && column.quantiles.iter().all(|one| one.interval == [None; 2]) {
        return Finding { sentence: without_values(&what), ..found };
    }
    let quantiles = column.quantiles.iter().map(|one| {
        let what = if one.p == 0.5 { "median".to_owned() } else { format!("p{}", percent(one.p)) };
        (one.p, number(&what, known(one.value), one.interval.map(known)))
    });
    let mut quantiles: Vec<(f64, Number)> = quantiles.collect();
    // the median, required quantiles, the spread, the tails
    for (p, number) in &mut quantiles {
        let is_of_it = |one: &&Requirement| one.observable() == Some(name) && one.statement == Statement::Quantile(*p);
        number.limit = plan.analysis.requirements.iter().find(is_of_it).map(|one| one.limit);
    }
    quantiles.sort_by_key(|(p, number)| [*p != 0.5, number.limit.is_none(), !SPREAD.contains(p)]);
    let mut numbers: Vec<Number> = quantiles.into_iter().map(|(_, number)| number).collect();
    let [low, high] = column.mean_interval;
    numbers.push(number("mean", known(column.moments.mean()), [low, high].map(known)));
    numbers.extend([number("min", min, [f64::NAN; 2]), number("max", max, [f64::NAN; 2])]);
    let texts = apart([known(numbers.first().map(|one| one.value)), min, max].map(|one| shown.value(one)));
    let digits = texts
        .iter()
        .map(|text| text.trim_start_matches(['0', '.', '-']))
        .map(digits)
        .max()
        .unwrap_or(3)
        .min(MOST_DIGITS);
    numbers.iter_mut().for_each(|one| one.digits = one.digits.max(digits));
    let of_mean = column.note.as_ref().map(|note| format!("mean of {what}: {note}"));
    // far fewer runs than the others have
    let whose = if column.without_value > column.moments.count() { format!("{what}: ") } else { String::new() };
    let of_quantiles = column.quantiles.iter().filter_map(|one| Some(format!("{whose}{}", one.note.as_ref()?)));
    let notes = of_quantiles.chain(of_mean).collect();
    let sentence = sentence(&what, &numbers, count);
    Finding { numbers, notes, sentence, ..found }
}

fn digits(text: &str) -> usize {
    text.split('e').next().map_or(0, |text| text.chars().filter(char::is_ascii_digit).count())
}

fn without_values(name: &str) -> String {
    format!("no run has a value of {name}")
}

/// The spread, then the extremes, for readers without a table.
fn sentence(name: &str, numbers: &[Number], runs: u64) -> String {
    let number = |what: &str| numbers.iter().find(|one| one.name == what).filter(|one| one.value.is_finite());
    let text = |one: &Number| Number { interval: [f64::NAN; 2], ..one.clone() }.text();
    let (Some(min), Some(max)) = (number("min"), number("max")) else { return without_values(name) };
    if runs == 1 {
        return format!("the only run has {name} {}", text(max));
    }
    let spread = match (number("p5"), number("p95")) {
        (Some(low), Some(high)) => format!("in 90% of the runs {name} is from {} to {}; ", text(low), text(high)),
        _ => number("median").map_or(String::new(), |one| format!("{name} has the median {}; ", text(one))),
    };
    format!("{spread}the extremes are {} and {}", text(min), text(max))
}

/// Median time of an event over the runs in which it occurs: "detumbled, median of 240 runs".
pub fn event_time(plan: &Plan, column: &ColumnStatistics) -> Option<(String, f64)> {
    let event = plan.events.iter().find(|event| column.quantity.name() == format!("{}_time_s", event.name))?;
    let at = column.quantiles.iter().find(|one| one.p == 0.5)?.value.filter(|at| at.is_finite())?;
    let (count, all) = (column.moments.count(), column.moments.count() + column.without_value);
    let of = if count < all { format!("the {count} of {all} runs that do") } else { format!("{count} runs") };
    Some((format!("{}, median of {of}", event.name.replace('_', " ")), at))
}
