//! Figures of drivers: shares of the variance, outcomes against drivers, conditional probabilities of events.

use crate::analysis::drivers::{Question, Ranking};
use crate::analysis::event::{Event, Occurs, distinct};
use crate::analysis::input_sensitivity::InputSensitivity;
use crate::analysis::order_statistics::share_interval;
use crate::analysis::survey::{SCATTER, Survey, SurveyedOutcome, chosen};
use crate::campaign::{Plan, Requirement};
use crate::findings::driver_sentence::verb;
use crate::findings::drivers::{outcomes, part, ranked, row};
use crate::findings::names;
use crate::findings::names::{sentence, unit_of_input};
use crate::findings::number::{significant, typeset};
use crate::findings::requirement::limit_text;
use crate::report::figure::{Axis, Dash, Figure, FigureSection, Hue, Mark, PointShape};
use crate::report::page::errors::{computed, having, interval_label, magnitude, of_runs, shown_rows};
use crate::report::page::fates::{self, Fate};
use crate::run::Quantity;
use crate::statistics::correlation::ascending_order;

/// Maximum and minimum number of inputs in a chart; the strongest others fill it up.
const MOST_INPUTS: usize = 12;
const FEWEST_INPUTS: usize = 6;
const PLOTTED: usize = 2;
/// Classes of equally many runs for an input with more values.
const CLASSES: usize = 6;
const MOST_DIGITS: usize = 8;

/// For each ranking with drivers: the outcome against the strongest ones, and the shares of all inputs. Identical
/// rankings of several requirements appear once.
pub fn figures(plan: &Plan, survey: &Survey, all: &[InputSensitivity], has_intervals: bool) -> Vec<Figure> {
    let mut figures: Vec<Figure> = Vec::new();
    let mut seen: Vec<Vec<(String, [u64; 3])>> = Vec::new();
    for name in outcomes(plan, all) {
        let Some((index, outcome)) = survey.outcome(&name) else { continue };
        for ranking in ranked(plan, all, &name).iter().filter(|ranking| ranking.drivers().next().is_some()) {
            let shares = shares(ranking);
            if let Question::Event(_) = ranking.question {
                let ranks: Vec<(String, [u64; 3])> =
                    shares.iter().map(|(input, share)| (input.clone(), share.map(f64::to_bits))).collect();
                if seen.contains(&ranks) {
                    continue;
                }
                seen.push(ranks);
            }
            let drivers = ranking.drivers().take(PLOTTED);
            for input in drivers.filter_map(|driver| names::place_of(plan, &driver.input.input)) {
                let (against, row) = match &ranking.question {
                    Question::Event(event) => {
                        (conditional(plan, survey, input, (index, outcome), event, has_intervals), row(event))
                    }
                    Question::Spread => (None, String::new()),
                };
                let judge = match &ranking.question {
                    Question::Event(Event { occurs: Occurs::Missed { requirement, .. }, .. }) => {
                        plan.analysis.requirements.get(*requirement)
                    }
                    _ => fates::only_limit(plan, &name),
                };
                // a scatter plot of yes or no adds nothing
                let is_plotted = !outcome.is_yes_or_no(&survey.thinned.outcomes[index]);
                let scatter = || scatter(plan, survey, input, (index, outcome), (judge, &row));
                let scatter = is_plotted.then(scatter).filter(is_spread);
                for figure in against.into_iter().chain(scatter) {
                    if !figures.iter().any(|other| other.name == figure.name) {
                        figures.push(figure);
                    }
                }
            }
            // skip uninformative shares
            let is_known =
                |(_, share): &(String, [f64; 3])| share[0].is_finite() && !(share[1] <= 0.0 && share[2] >= 1.0);
            if shares.iter().any(is_known) {
                figures.push(tornado(plan, (&name, ranking), outcome, &shares));
            }
        }
    }
    figures.retain(Figure::is_visible);
    figures
}

/// The share of each input with its interval, NaN if unknown, in ranking order.
fn shares(ranking: &Ranking<'_>) -> Vec<(String, [f64; 3])> {
    let of = |share: Option<crate::statistics::correlation::Estimate>| {
        share.map_or([f64::NAN; 3], |share| [share.value, share.lower, share.upper])
    };
    ranking.inputs.iter().map(|one| (one.input.input.clone(), of(one.share))).collect()
}

/// True if a scatter plot has different abscissae.
fn is_spread(figure: &Figure) -> bool {
    let points = figure.marks.iter().filter_map(|mark| if let Mark::Points { x, .. } = mark { Some(x) } else { None });
    let mut all = points.flatten();
    all.next().is_some_and(|first| all.any(|other| other != first))
}

fn tornado(
    plan: &Plan,
    (name, ranking): (&str, &Ranking<'_>),
    outcome: &SurveyedOutcome,
    shares: &[(String, [f64; 3])],
) -> Figure {
    let (all, drivers) = (shares.len(), ranking.drivers().count());
    let inputs = &shares[..all.min((drivers + 2).clamp(FEWEST_INPUTS, MOST_INPUTS))];
    // estimates outside [0, 1] are clamped, NaN stays
    let column = |place: usize| inputs.iter().map(|(_, value)| value[place].clamp(0.0, 1.0)).collect::<Vec<f64>>();
    let columns = [0, 1, 2].map(column);
    let largest = columns.iter().flatten().copied().fold(0.0, f64::max);
    let end = (1.05 * largest).clamp(0.1, 1.0);
    let first = ranking.inputs.first().map(|one| one.input);
    let is_total = first.is_some_and(|one| one.total.is_some());
    let (measure, meaning) = match is_total {
        true => ("total Sobol index", "What each input explains together with its interactions"),
        false => (
            "share of the variance",
            "What each input explains alone; an interval from 0 to 1 means that the runs do not show it",
        ),
    };
    let strongest =
        if inputs.len() < all { format!(" The strongest {} of {all} inputs.", inputs.len()) } else { String::new() };
    let quantity = names::of_quantity(&outcome.quantity);
    let (part, title) = match &ranking.question {
        Question::Spread => (String::new(), format!("What drives {quantity}")),
        Question::Event(event) => {
            (part(event), format!("{}: which runs {}", sentence(&quantity), verb(plan, name, event, u64::MAX)))
        }
    };
    Figure::of(
        FigureSection::Influence,
        [
            format!("influence_{name}{part}"),
            title,
            format!("{meaning}. Of {} runs.{strongest}", first.map_or(0, |one| one.rows)),
        ],
        [
            Axis::linear(measure, "").within(0.0, end),
            Axis::names(inputs.iter().map(|(name, _)| names::of_input_column(plan, name)).collect()),
        ],
        vec![Mark::Whiskers {
            label: interval_label(outcome.confidence),
            hue: Hue::Total,
            x: columns[0].clone(),
            low: columns[1].clone(),
            high: columns[2].clone(),
        }],
    )
    .wide(4)
}

/// The share of runs with `event` in classes of an input; `None` if the shown runs lack the event.
fn conditional(
    plan: &Plan,
    survey: &Survey,
    input: usize,
    (index, outcome): (usize, &SurveyedOutcome),
    event: &Event,
    has_intervals: bool,
) -> Option<Figure> {
    let name = outcome.quantity.name();
    let rows = shown_rows(survey);
    let values: Vec<f64> = rows.iter().map(|row| survey.thinned.outcomes[index][*row]).collect();
    let inputs: Vec<f64> = rows.iter().map(|row| survey.thinned.inputs[input][*row]).collect();
    let missed = Event::missed(plan, name, &values, &vec![true; values.len()]);
    let mut all = missed.into_iter().chain(Event::of_values(plan, name, &values));
    let (_, occurs) = all.find(|(other, _)| other.occurs == event.occurs)?;
    let shown = unit_of_input(plan, input);
    let mut classes: Vec<(String, [u64; 2])> = Vec::new();
    let order = ascending_order(&inputs);
    let levels = distinct(&inputs, &order);
    let sizes: Vec<usize> = match levels.len() <= CLASSES {
        true => levels.iter().map(|(_, count)| *count).collect(),
        false => (0..CLASSES).map(|k| (k + 1) * order.len() / CLASSES - k * order.len() / CLASSES).collect(),
    };
    let firsts = sizes.iter().scan(0, |from, size| Some(core::mem::replace(from, *from + size)));
    let ends: Vec<f64> = firsts.filter_map(|first| Some(inputs[*order.get(first)?])).collect();
    // neighbouring classes differ in their digits
    let texts = |digits: usize| ends.iter().map(|end| significant(shown.value(*end), digits)).collect::<Vec<_>>();
    let is_apart = |digits: &usize| texts(*digits).windows(2).all(|pair| pair[0] != pair[1]);
    let digits = (3..MOST_DIGITS).find(is_apart).unwrap_or(3);
    let amount = |value: f64| significant(shown.value(value), digits);
    let mut from = 0;
    for size in sizes.into_iter().filter(|size| *size > 0) {
        let places = &order[from..from + size];
        from += size;
        let events = places.iter().filter(|place| occurs[**place]).count() as u64;
        let [low, high] = [places[0], places[size - 1]].map(|place| inputs[place]);
        let range =
            if low == high { format!("= {}", amount(low)) } else { format!("{} to {}", amount(low), amount(high)) };
        classes.push((typeset(&format!("{range}: {events} of {size}")), [events, size as u64]));
    }
    let ends = classes.iter().map(|(_, [events, runs])| match has_intervals {
        true => share_interval(*events, [*runs, 0], outcome.confidence),
        false => [f64::NAN; 2],
    });
    let (low, high): (Vec<f64>, Vec<f64>) = ends.map(|[low, high]| (low, high)).unzip();
    let x: Vec<f64> = classes.iter().map(|(_, [events, runs])| *events as f64 / *runs as f64).collect();
    let largest = x.iter().chain(&high).copied().filter(|x| x.is_finite()).fold(0.0, f64::max);
    let (verb, of_input) = (verb(plan, name, event, u64::MAX), names::of_input(plan, input));
    let column = &plan.dispersions.columns()[input];
    let unit = if shown.unit.is_empty() { String::new() } else { format!(", {}", shown.unit) };
    Some(
        Figure::of(
            FigureSection::Influence,
            [
                format!("shares_{name}{}_{}", row(event), column.parameter.column_name(column.component)),
                format!("{} by {of_input}", names::title(&outcome.quantity)),
                format!("{}, in classes of {of_input}{unit}.", of_runs(rows.len(), computed(survey))),
            ],
            [
                Axis::linear(format!("share of runs that {verb}"), "").within(0.0, (1.05 * largest).clamp(0.01, 1.0)),
                Axis::names(classes.into_iter().map(|(name, _)| name).collect()),
            ],
            vec![Mark::Whiskers { label: interval_label(outcome.confidence), hue: Hue::Failed, x, low, high }],
        )
        .wide(4),
    )
}

/// An outcome against an input; crosses miss the requirement `judge` of the ranking whose figures end with `row`.
fn scatter(
    plan: &Plan,
    survey: &Survey,
    input: usize,
    (index, outcome): (usize, &SurveyedOutcome),
    (judge, row): (Option<&Requirement>, &str),
) -> Figure {
    let column = &plan.dispersions.columns()[input];
    let name = names::of_input(plan, input);
    let unit = names::own_unit(column.parameter);
    let thinned = &survey.thinned;
    let rows: Vec<usize> =
        shown_rows(survey).into_iter().filter(|row| thinned.outcomes[index][*row].is_finite()).collect();
    let samples: Vec<u64> = rows.iter().map(|row| thinned.samples[*row]).collect();
    let kept: Vec<usize> = chosen(&samples, SCATTER).into_iter().map(|place| rows[place]).collect();
    let ordinates: Vec<f64> =
        thinned.outcomes[index].iter().map(|value| if outcome.is_error { value.abs() } else { *value }).collect();
    let shown: Vec<f64> = kept.iter().map(|row| ordinates[*row]).collect();
    let (lowest, highest) = shown.iter().fold((f64::INFINITY, 0.0f64), |(low, high), y| (low.min(*y), high.max(*y)));
    let is_log = lowest > 0.0 && highest > 100.0 * lowest;
    let points = |rows: &[usize], label: &str, hue, shape, y: Vec<f64>| Mark::Points {
        label: label.to_owned(),
        hue,
        shape,
        x: rows.iter().map(|row| thinned.inputs[input][*row]).collect(),
        y,
        samples: rows.iter().map(|row| thinned.samples[*row] as f64).collect(),
    };
    let fates = fates::of_one(survey, judge);
    let (missed, met): (Vec<usize>, Vec<usize>) = kept.iter().partition(|row| fates[**row] == Fate::Missed);
    let value = |rows: &[usize]| rows.iter().map(|row| ordinates[*row]).collect::<Vec<f64>>();
    let shown = plan.analysis.display.of(outcome.quantity.name(), outcome.quantity.unit());
    // of several limits the one that is meant
    let limit = judge.filter(|_| !row.is_empty()).map(|one| typeset(&limit_text(one.limit, &shown)));
    let limit = limit.map_or_else(|| "its limit".to_owned(), |limit| format!("the limit, {limit}"));
    let word = if missed.is_empty() { "computed".to_owned() } else { format!("meets {limit}") };
    let mut marks = vec![points(&met, &word, Hue::Total, PointShape::Disc, value(&met))];
    if !missed.is_empty() {
        let label = format!("misses {limit}");
        marks.push(points(&missed, &label, Hue::Failed, PointShape::Cross, value(&missed)));
    }
    let failed: Vec<usize> =
        (0..thinned.samples.len()).filter(|row| fates[*row] == Fate::NotComputed).take(SCATTER).collect();
    if !failed.is_empty() {
        // failed runs have no outcome: mark them at the lower edge
        let edge = if lowest.is_finite() { lowest } else { 0.0 };
        let y = vec![edge; failed.len()];
        marks.push(points(&failed, "not computed (at the lower edge)", Hue::Reference, PointShape::Cross, y));
    }
    let label = magnitude(outcome);
    let axis = if is_log { Axis::log } else { Axis::linear };
    Figure::of(
        FigureSection::Influence,
        [
            format!("scatter_{}{row}_{}", outcome.quantity.name(), column.parameter.column_name(column.component)),
            format!("{} against {name}", names::title(&outcome.quantity)),
            format!("{}.", having(survey, &outcome.sketch, kept.len())),
        ],
        [
            Axis::linear(name, unit).showing(column.parameter.name()),
            axis(label, outcome.quantity.unit()).showing(outcome.quantity.name()),
        ],
        marks,
    )
    .wide(4)
}

/// Convergence of the median and a high quantile of an outcome with the number of runs.
pub fn convergence(outcome: &SurveyedOutcome, has_intervals: bool) -> Figure {
    let growth = &outcome.growth;
    let column = |place: usize| growth.iter().map(|row| row[place]).collect::<Vec<f64>>();
    let line = |label: &str, hue, place| Mark::line(label, hue, Dash::Solid, column(0), column(place));
    let mut marks = Vec::new();
    let bounded: Vec<&[f64; 7]> = growth.iter().filter(|row| row[3].is_finite() && row[4].is_finite()).collect();
    if has_intervals && !bounded.is_empty() {
        let of = |place: usize| bounded.iter().map(|row| row[place]).collect::<Vec<f64>>();
        marks.push(Mark::area(interval_label(outcome.confidence), (Hue::Wheel(0), 0.15), of(0), [of(3), of(4)]));
    }
    let band = if marks.is_empty() { "" } else { "; where the band begins, N bounds the quantile from both sides" };
    marks.push(line("99% quantile", Hue::Wheel(0), 2));
    marks.push(line("median", Hue::Body, 1));
    let (quantity, unit): (&Quantity, &str) = (&outcome.quantity, outcome.quantity.unit());
    Figure::of(
        FigureSection::Statistics,
        [
            format!("convergence_{}", quantity.name()),
            format!("Convergence of {}", names::of_quantity(quantity)),
            format!("Quantiles of the first N dispersed runs that were computed, in the order of their numbers{band}."),
        ],
        [Axis::log("runs N", ""), Axis::linear(names::of_quantity(quantity), unit).showing(quantity.name())],
        marks,
    )
}
