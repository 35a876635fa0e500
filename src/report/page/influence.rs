//! Figures of what drives the outcome: sensitivities with intervals, scatter plots of the strongest inputs.

use crate::analysis::survey::{SCATTER, Survey, SurveyedOutcome, chosen};
use crate::campaign::Plan;
use crate::findings::names;
use crate::findings::names::sentence;
use crate::report::drivers_text::SEE_INTERACTIONS;
use crate::report::escaped::escaped;
use crate::report::figure::{Axis, Dash, Figure, FigureSection, Hue, Mark, PointShape};
use crate::report::page::errors::{having, magnitude, shown_rows};
use crate::report::page::fates::{self, Fate};
use crate::run::Quantity;
use crate::sampling::Design;

/// Inputs of a chart, at most; and at least, where there are so many: the strongest of those that are no drivers stand beside them.
const MOST_INPUTS: usize = 12;
const FEWEST_INPUTS: usize = 6;
/// Drivers against which an outcome is plotted.
const PLOTTED: usize = 2;

/// How strongly inputs act on an outcome.
#[derive(Clone, Debug, PartialEq)]
pub struct Influence {
    pub outcome: String,
    /// Of a ranking for an event: what the runs do in which it occurs, and what its figures are called beside those of
    /// the spread; `None` of the spread.
    pub event: Option<(String, String)>,
    /// What the numbers are, as an axis says it.
    pub measure: String,
    /// What they mean, in a sentence or two.
    pub meaning: String,
    /// Input column, share, lower and upper end of its interval (NaN if there is none), in the order of the ranking:
    /// its drivers come first.
    pub inputs: Vec<(String, [f64; 3])>,
    /// How many of them are drivers.
    pub shown: usize,
    /// The strongest inputs in words.
    pub drivers: String,
}

/// For each ranking with a driver a tornado, and the outcome against its strongest drivers, each once. Runs that miss several requirements are ranked once.
pub fn figures(plan: &Plan, survey: &Survey, influences: &[Influence]) -> Vec<Figure> {
    let mut figures: Vec<Figure> = Vec::new();
    let is_same =
        |one: &Influence, other: &Influence| one.event.is_some() && other.event.is_some() && one.inputs == other.inputs;
    for (place, influence) in influences.iter().enumerate().filter(|(_, influence)| influence.shown > 0) {
        let Some((index, outcome)) = survey.outcome(&influence.outcome) else { continue };
        if influences[..place].iter().any(|other| is_same(other, influence)) {
            continue;
        }
        let same = influences[place + 1..].iter().filter(|other| is_same(other, influence));
        let same: Vec<String> =
            same.filter_map(|other| Some(names::of_quantity(&survey.outcome(&other.outcome)?.1.quantity))).collect();
        let drivers = influence.inputs.iter().take(influence.shown.min(PLOTTED));
        let strongest: Vec<usize> = drivers.filter_map(|(name, _)| names::place_of(plan, name)).collect();
        let mut inputs = influence.inputs.clone();
        inputs.truncate((influence.shown + 2).clamp(FEWEST_INPUTS, MOST_INPUTS));
        // too few runs have no shares
        if inputs.iter().any(|(_, share)| share[0].is_finite()) {
            figures.push(tornado(plan, influence, (outcome, &same), &inputs, survey.thinned.inputs.len()));
        }
        // yes or no against a number says less than the counts in the sentence
        let is_plotted = !outcome.is_yes_or_no(&survey.thinned.outcomes[index]);
        for input in strongest.into_iter().filter(|_| is_plotted) {
            let figure = scatter(plan, survey, input, index, outcome);
            if !figures.iter().any(|other| other.name == figure.name) && is_spread(&figure) {
                figures.push(figure);
            }
        }
    }
    figures.retain(Figure::is_visible);
    figures
}

/// What the section says: what the bars are, what a driver is, and which outcomes have none.
pub fn lead(plan: &Plan, survey: &Survey, influences: &[Influence]) -> String {
    let bars = match plan.design {
        Design::Saltelli(_) => {
            "Bars show how much of the variance each input explains together with its interactions.".to_owned()
        }
        _ => format!(
            "Bars show how much of the variance each input explains alone, its first-order index; a bar from 0 to 1 means that the \
             runs do not show it; {SEE_INTERACTIONS}."
        ),
    };
    let noise = match plan.law {
        Some(_) => {
            " Noise in the loop is not an input; <code>spindrift report . --noise 256</code> measures its share."
        }
        None => "",
    };
    let without = without_driver(survey, influences);
    format!(
        "{} A driver is an input whose influence is significant among all inputs (Holm).{noise}{without}",
        escaped(&bars)
    )
}

/// The outcomes of `influences` without any driver, in a sentence; nothing where all have one.
fn without_driver(survey: &Survey, influences: &[Influence]) -> String {
    let mut names: Vec<String> = Vec::new();
    for influence in influences {
        let is_driven = influences.iter().any(|other| other.outcome == influence.outcome && other.shown > 0);
        let Some((_, outcome)) = survey.outcome(&influence.outcome).filter(|_| !is_driven) else { continue };
        let name = names::of_quantity(&outcome.quantity);
        if !names.contains(&name) {
            names.push(name);
        }
    }
    if names.is_empty() {
        return String::new();
    }
    format!(" No significant driver was found for: {}.", names.join(", "))
}

/// Whether the points of a scatter plot differ in their abscissae.
fn is_spread(figure: &Figure) -> bool {
    let points = figure.marks.iter().filter_map(|mark| if let Mark::Points { x, .. } = mark { Some(x) } else { None });
    let mut all = points.flatten();
    all.next().is_some_and(|first| all.any(|other| other != first))
}

fn tornado(
    plan: &Plan,
    influence: &Influence,
    (outcome, same): (&SurveyedOutcome, &[String]),
    inputs: &[(String, [f64; 3])],
    all: usize,
) -> Figure {
    // a share is between 0 and 1, whatever its estimate is; one that is not known stays so
    let column = |place: usize| inputs.iter().map(|(_, value)| value[place].clamp(0.0, 1.0)).collect::<Vec<f64>>();
    let shares = [0, 1, 2].map(column);
    let largest = shares.iter().flatten().copied().fold(0.0, f64::max);
    let end = (1.05 * largest).clamp(0.1, 1.0);
    let mut note =
        if inputs.len() < all { format!(" The strongest {} of {all} inputs.", inputs.len()) } else { String::new() };
    if !same.is_empty() {
        note += &format!(" The same runs miss: {}.", counted_list(same));
    }
    let name = outcome.quantity.name();
    let (name, title) = match &influence.event {
        None => (format!("influence_{name}"), format!("What drives {}", names::of_quantity(&outcome.quantity))),
        Some((verb, part)) => (
            format!("influence_{name}{part}"),
            format!("{}: which runs {verb}", sentence(&names::of_quantity(&outcome.quantity))),
        ),
    };
    Figure {
        name,
        section: FigureSection::Influence,
        title,
        caption: format!("{}{note}", influence.meaning),
        columns: 4,
        is_over_time: false,
        x: Axis::linear(influence.measure.clone(), "").within(0.0, end),
        y: Axis::names(inputs.iter().map(|(name, _)| names::of_input_column(plan, name)).collect()),
        marks: vec![Mark::Whiskers {
            label: crate::report::page::errors::interval_label(outcome.confidence),
            hue: Hue::Total,
            x: shares[0].clone(),
            low: shares[1].clone(),
            high: shares[2].clone(),
        }],
    }
}

/// The first of `names`, and how many others there are.
pub fn counted_list(names: &[String]) -> String {
    match names {
        [] => String::new(),
        [one] => one.clone(),
        [one, other] => format!("{one}, {other}"),
        [one, others @ ..] => format!("{one} and {} others", others.len()),
    }
}

/// An outcome against an input.
fn scatter(plan: &Plan, survey: &Survey, input: usize, index: usize, outcome: &SurveyedOutcome) -> Figure {
    let column = &plan.dispersions.columns()[input];
    let name = names::of_input(plan, input);
    let unit = if column.parameter.unit() == "1" { "" } else { column.parameter.unit() };
    let thinned = &survey.thinned;
    // a run without a value of the outcome is no point
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
    let fates = fates::of_outcome(plan, survey, outcome.quantity.name());
    let (missed, met): (Vec<usize>, Vec<usize>) = kept.iter().partition(|row| fates[**row] == Fate::Missed);
    let value = |rows: &[usize]| rows.iter().map(|row| ordinates[*row]).collect::<Vec<f64>>();
    let limit = fates::limit_word(plan, outcome.quantity.name());
    let all_limits = if limit == "its limit" { limit } else { "all limits" };
    let word = if missed.is_empty() { "computed".to_owned() } else { format!("meets {all_limits}") };
    let mut marks = vec![points(&met, &word, Hue::Total, PointShape::Disc, value(&met))];
    if !missed.is_empty() {
        marks.push(points(&missed, &format!("misses {limit}"), Hue::Failed, PointShape::Cross, value(&missed)));
    }
    let failed: Vec<usize> =
        (0..thinned.samples.len()).filter(|row| fates[*row] == Fate::NotComputed).take(SCATTER).collect();
    if !failed.is_empty() {
        // a run that failed has no outcome: it is marked at the lower edge
        let edge = if lowest.is_finite() { lowest } else { 0.0 };
        let y = vec![edge; failed.len()];
        marks.push(points(&failed, "not computed (at the lower edge)", Hue::Reference, PointShape::Cross, y));
    }
    let label = magnitude(outcome);
    let axis = if is_log { Axis::log } else { Axis::linear };
    Figure {
        name: format!("scatter_{}_{}", outcome.quantity.name(), column.parameter.column_name(column.component)),
        section: FigureSection::Influence,
        title: format!("{} against {name}", sentence(&names::of_quantity(&outcome.quantity))),
        caption: format!("{}.", having(survey, &outcome.sketch, kept.len())),
        columns: 4,
        is_over_time: false,
        x: Axis::linear(name, unit).showing(column.parameter.name()),
        y: axis(label, outcome.quantity.unit()).showing(outcome.quantity.name()),
        marks,
    }
}

/// Convergence of the median and of a high quantile of an outcome with the number of runs.
pub fn convergence(outcome: &SurveyedOutcome, has_intervals: bool) -> Figure {
    let growth = &outcome.growth;
    let column = |place: usize| growth.iter().map(|row| row[place]).collect::<Vec<f64>>();
    let line = |label: &str, hue, place| Mark::Line {
        label: label.to_owned(),
        hue,
        dash: Dash::Solid,
        x: column(0),
        y: column(place),
    };
    let mut marks = Vec::new();
    let bounded: Vec<&[f64; 7]> = growth.iter().filter(|row| row[3].is_finite() && row[4].is_finite()).collect();
    if has_intervals && !bounded.is_empty() {
        let of = |place: usize| bounded.iter().map(|row| row[place]).collect::<Vec<f64>>();
        marks.push(Mark::Band {
            label: crate::report::page::errors::interval_label(outcome.confidence),
            hue: Hue::Wheel(0),
            opacity: 0.15,
            x: of(0),
            low: of(3),
            high: of(4),
            stacked: false,
        });
    }
    let band = if marks.is_empty() { "" } else { "; where the band begins, N bounds the quantile from both sides" };
    marks.push(line("99% quantile", Hue::Wheel(0), 2));
    marks.push(line("median", Hue::Body, 1));
    let (quantity, unit): (&Quantity, &str) = (&outcome.quantity, outcome.quantity.unit());
    Figure {
        name: format!("convergence_{}", quantity.name()),
        section: FigureSection::Statistics,
        title: format!("Convergence of {}", names::of_quantity(quantity)),
        caption: format!(
            "Quantiles of the first N dispersed runs that were computed, in the order of their numbers{band}."
        ),
        columns: 6,
        is_over_time: false,
        x: Axis::log("runs N", ""),
        y: Axis::linear(names::of_quantity(quantity), unit).showing(quantity.name()),
        marks,
    }
}
