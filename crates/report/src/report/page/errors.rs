//! Figures of numerical errors: histograms, exceedance, estimates against audits, steps.

use crate::analysis::bins::{bins, counts};
use crate::analysis::order_statistics::share_interval;
use crate::analysis::survey::{Survey, SurveyedOutcome};
use crate::findings::names;
use crate::report::figure::{Axis, Dash, Figure, FigureSection, Hue, Mark, PointShape};
use crate::run::Status;
use crate::statistics::quantile::percent;
use crate::statistics::sketch::{Sketch, middle};

/// Replaces the interval's description if there is none.
pub const NO_INTERVAL: &str = "No interval: these runs are no random part of all.";
const FEWEST_RUNS: u64 = 8;
const MOST_ERRORS: usize = 8;
const RANKS_PER_DECADE: f64 = 12.0;

/// Dynamic range of an exceedance plot: exact runs would add three hundred decades.
const TAIL_RANGE: f64 = 1e12;

/// Histogram and exceedance of each error, estimates against audits, steps. `has_intervals`: the runs are independent.
pub fn figures(survey: &Survey, has_intervals: bool) -> Vec<Figure> {
    let mut figures: Vec<Figure> = Vec::new();
    if survey.statuses.ok() < FEWEST_RUNS {
        return figures;
    }
    let errors = survey.outcomes.iter().enumerate();
    let errors = errors.filter(|(_, outcome)| {
        outcome.is_error && !outcome.is_outcome && outcome.sketch.max().is_some_and(|max| max > 0.0)
    });
    for (index, outcome) in errors.take(MOST_ERRORS) {
        figures.push(histogram(survey, (index, outcome), FigureSection::Numerics, &[]));
        figures.push(exceedance(outcome, has_intervals));
    }
    figures.extend(audits(survey));
    // a constant number of steps has no distribution
    let steps = survey.outcome("steps").filter(|(_, steps)| steps.sketch.min() != steps.sketch.max());
    figures.extend(steps.map(|steps| histogram(survey, steps, FigureSection::Numerics, &[])));
    figures.retain(Figure::is_visible);
    figures
}

/// "100 runs", "50 of 100 runs, chosen by sample number".
pub fn of_runs(shown: usize, all: u64) -> String {
    if shown as u64 == all {
        format!("{} runs", all)
    } else {
        format!("{} of {} runs, chosen by sample number", shown as u64, all)
    }
}

/// The number of dispersed runs with a value, of computed runs if others lack it, and of runs shown.
pub fn having(survey: &Survey, values: &Sketch, shown: usize) -> String {
    let computed = computed(survey);
    match values.count() {
        count if count < computed => {
            let of = format!("{} of {} runs have this value", count, computed);
            if shown as u64 == count { of } else { format!("{of}, {} are shown", shown as u64) }
        }
        count => of_runs(shown, count),
    }
}

/// As [`having`], in words that follow "of".
pub fn all_having(survey: &Survey, values: &Sketch) -> String {
    let (count, computed) = (values.count(), computed(survey));
    match count < computed {
        true => format!("the {} of {} runs that have this value,", count, computed),
        false => format!("{} runs", count),
    }
}

/// Number of computed runs that count: the dispersed ones, or the only one.
pub fn computed(survey: &Survey) -> u64 {
    let is_alone = survey.statuses.runs() == 1;
    survey.statuses.ok() - u64::from(survey.statuses.has_nominal() && !is_alone)
}

/// Rows of the thinned table: dispersed and ok.
pub fn shown_rows(survey: &Survey) -> Vec<usize> {
    let thinned = &survey.thinned;
    let is_alone = survey.statuses.runs() == 1;
    (0..thinned.samples.len())
        .filter(|row| thinned.statuses[*row] == Status::Done && (is_alone || thinned.samples[*row] != 0))
        .collect()
}

/// The histogram of an outcome over the thinned table; of the magnitude of an error. Its axis includes `limits`.
pub fn histogram(
    survey: &Survey,
    (index, outcome): (usize, &SurveyedOutcome),
    section: FigureSection,
    limits: &[f64],
) -> Figure {
    let rows = shown_rows(survey);
    let column = &survey.thinned.outcomes[index];
    let values: Vec<f64> = rows.iter().map(|row| column[*row]).filter(|value| value.is_finite()).collect();
    let values: Vec<f64> = if outcome.is_error { values.into_iter().map(f64::abs).collect() } else { values };
    let title = names::title(&outcome.quantity);
    let (bins, is_log) = bins(&values, limits);
    let mut marks = vec![Mark::Bars {
        label: "runs".to_owned(),
        hue: Hue::Total,
        heights: counts(&values, &bins),
        edges: bins.clone(),
    }];
    let nominal = if outcome.is_error { outcome.nominal.abs() } else { outcome.nominal };
    if survey.statuses.runs() > 1
        && bins.first().is_some_and(|low| nominal >= *low)
        && bins.last().is_some_and(|high| nominal <= *high)
    {
        marks.push(Mark::Limit { label: "nominal".to_owned(), at: nominal, vertical: true });
    }
    let axis = if is_log { Axis::log } else { Axis::linear };
    let what = magnitude(outcome);
    // derived columns are described by other column names, which only the glossary explains
    let meaning = outcome.quantity.meaning();
    let is_name = |word: &str| word.contains('_') && word.len() > "(F_e).".len();
    let meaning = if meaning.split_whitespace().any(is_name) { "" } else { meaning };
    // the caption counts the missing values
    let meaning = meaning.split_once("; null if").map_or(meaning.to_owned(), |(meaning, _)| format!("{meaning}."));
    let caption = format!("{}. {meaning}", having(survey, &outcome.sketch, values.len())).trim_end().to_owned();
    Figure::of(
        section,
        [format!("histogram_{}", outcome.quantity.name()), title, caption],
        [axis(what, outcome.quantity.unit()).showing(outcome.quantity.name()), Axis::linear("runs", "")],
        marks,
    )
}

/// Axis label of an outcome; signed errors are shown as magnitudes.
pub fn magnitude(outcome: &SurveyedOutcome) -> String {
    let (column, name) = (outcome.quantity.name(), names::of_quantity(&outcome.quantity));
    let has_sign = outcome.is_error && !["_max", "_estimate"].iter().any(|end| column.ends_with(end));
    if has_sign { format!("|{name}|") } else { name }
}

pub fn interval_label(confidence: f64) -> String {
    format!("{}% interval", percent(confidence))
}

/// Values, fractions, and the ends of their intervals.
pub type Curve = (Vec<f64>, Vec<f64>, Vec<f64>, Vec<f64>);

/// The fraction of runs with at most (or `is_from_largest`, at least) the value at each rank, with intervals that allow
/// for lost runs. Only values above `least`, ascending.
pub fn curve(outcome: &SurveyedOutcome, ranks: impl Iterator<Item = u64>, is_from_largest: bool, least: f64) -> Curve {
    let (count, sketched) = (outcome.sketch.count(), outcome.sketch.ranks());
    let mut found = Curve::default();
    for rank in ranks {
        let place = if is_from_largest { count + 1 - rank } else { rank };
        let Some(value) = sketched.bounds(place).map(middle).filter(|value| *value > least) else { continue };
        let [low, high] = share_interval(rank, [count, outcome.lost], outcome.confidence);
        found.0.push(value);
        found.1.push(rank as f64 / count as f64);
        found.2.push(low);
        found.3.push(high);
    }
    found
}

/// A curve of fractions, with a band if `has_intervals`.
pub fn with_band(outcome: &SurveyedOutcome, label: &str, (x, y, low, high): Curve, has_intervals: bool) -> Vec<Mark> {
    let interval = interval_label(outcome.confidence);
    let band = has_intervals.then(|| Mark::area(interval, (Hue::Total, 0.15), x.clone(), [low, high]));
    band.into_iter().chain([Mark::line(label, Hue::Total, Dash::Solid, x, y)]).collect()
}

/// The fraction of runs above a value on logarithmic axes, at logarithmically spaced ranks.
fn exceedance(outcome: &SurveyedOutcome, has_intervals: bool) -> Figure {
    let count = outcome.sketch.count();
    let rank = |k: u32| libm::pow(10.0, f64::from(k) / RANKS_PER_DECADE) as u64;
    let mut ranks: Vec<u64> = (0..).map(rank).take_while(|rank| *rank < count).chain([count]).collect();
    ranks.dedup();
    let smallest = outcome.sketch.max().unwrap_or(0.0) / TAIL_RANGE;
    let found = curve(outcome, ranks.into_iter().rev(), true, smallest);
    let [x, y] = [&found.0, &found.1].map(|values| values.last().copied().into_iter().collect());
    let samples = outcome.worst.runs.first().map(|(sample, _)| sample.0 as f64).into_iter().collect();
    let mut marks = with_band(outcome, "fraction of runs above", found, has_intervals);
    marks.push(Mark::Points { label: "largest".to_owned(), hue: Hue::Total, shape: PointShape::Disc, x, y, samples });
    let interval = match has_intervals {
        true => format!("Band: Clopper-Pearson, {}.", interval_label(outcome.confidence)),
        false => NO_INTERVAL.to_owned(),
    };
    let (column, name) = (outcome.quantity.name(), names::of_quantity(&outcome.quantity));
    let caption = format!("Fraction of {count} runs with at least this value, at ranks spaced by decades. {interval}");
    let x = Axis::log(magnitude(outcome), outcome.quantity.unit()).showing(column);
    let said = [format!("tail_{column}"), format!("Tail of {name}"), caption];
    Figure::of(FigureSection::Numerics, said, [x, Axis::log("fraction of runs", "")], marks)
}

fn audits(survey: &Survey) -> Option<Figure> {
    let shown: Vec<&[f64; 3]> = survey.audits.iter().filter(|audit| audit[1] > 0.0 && audit[2] > 0.0).collect();
    let ends = shown
        .iter()
        .flat_map(|audit| [audit[1], audit[2]])
        .fold([f64::INFINITY, 0.0f64], |[low, high], x| [low.min(x), high.max(x)]);
    if shown.is_empty() {
        return None;
    }
    let below = shown.iter().filter(|audit| audit[2] > audit[1]).count();
    let caption = format!(
        "{} of {} audited runs, each compared with a reference solution. Above the diagonal the estimate is too small: \
         {below} of those shown.",
        shown.len(),
        survey.audited
    );
    let said = ["audits".to_owned(), "Estimated error against the true one".to_owned(), caption];
    let [low, high] = [0.5 * ends[0], 2.0 * ends[1]];
    let axes = ["state error estimate", "audited state error"].map(|name| Axis::log(name, "").within(low, high));
    let [samples, x, y] = [0, 1, 2].map(|place| shown.iter().map(|audit| audit[place]).collect());
    let (label, hue, shape) = ("audited runs".to_owned(), Hue::Total, PointShape::Disc);
    let diagonal = Mark::line("estimate = truth", Hue::Reference, Dash::Dashed, vec![low, high], vec![low, high]);
    let marks = vec![diagonal, Mark::Points { label, hue, shape, x, y, samples }];
    Some(Figure::of(FigureSection::Numerics, said, axes, marks))
}
