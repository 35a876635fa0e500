//! Figures of outcomes: histograms and cumulative distributions, with limits, quantiles and intervals.

use crate::analysis::bins::counts;
use crate::analysis::order_statistics::share_interval;
use crate::analysis::outcomes::unique;
use crate::analysis::statistics::ColumnStatistics;
use crate::analysis::survey::{Survey, SurveyedOutcome};
use crate::campaign::{Plan, Requirement, Statement};
use crate::findings::names;
use crate::findings::names::sentence;
use crate::findings::number::typeset;
use crate::findings::requirement::limit_text;
use crate::report::figure::{Axis, Dash, Figure, FigureSection, Hue, Mark, PointShape, Scale};
use crate::report::page::errors::{Curve, NO_INTERVAL, all_having, curve, histogram, magnitude, shown_rows, with_band};
use crate::report::page::fates::{self, Fate};
use crate::report::page::readable::number;
use crate::statistics::gate::GateLimit;

const MOST_POINTS: u64 = 400;
const MOST_STEPS: usize = 100;
const FEWEST_RUNS: u64 = 8;
/// Up to this many outcomes have curves next to their histograms.
const BESIDE: usize = 2;

pub fn figures(plan: &Plan, survey: &Survey, statistics: &[ColumnStatistics], has_intervals: bool) -> Vec<Figure> {
    let outcomes = survey.outcomes.iter().enumerate().filter(|(_, outcome)| outcome.is_outcome);
    let shown = outcomes.filter(|(_, outcome)| outcome.sketch.count() >= FEWEST_RUNS);
    let (mut distributions, mut curves) = (Vec::new(), Vec::new());
    for (index, outcome) in shown {
        if outcome.is_yes_or_no(&survey.thinned.outcomes[index]) {
            distributions.push(share(plan, outcome, has_intervals));
            continue;
        }
        let row = statistics.iter().find(|row| row.quantity.name() == outcome.quantity.name());
        let limits = limits(plan, outcome);
        let at = |mark: &Mark| if let Mark::Limit { at, .. } = mark { Some(*at) } else { None };
        let edges: Vec<f64> = limits.iter().filter_map(at).collect();
        let mut distribution = histogram(survey, (index, outcome), FigureSection::Outcome, &edges);
        let missed = missed(plan, survey, index, outcome, &distribution.marks);
        distribution.marks.extend(missed);
        distribution.marks.extend(limits);
        let mut curve = cumulative(plan, survey, outcome, row, has_intervals);
        // use the same scale if the values allow it
        if distribution.x.scale == Scale::Log && outcome.sketch.min().is_some_and(|min| min > 0.0) {
            curve.x.scale = Scale::Log;
        }
        distributions.push(near_limits(distribution));
        curves.push(near_limits(curve));
    }
    laid_out(distributions, curves)
}

const CUMULATIVE: &str = "cumulative_";

/// A folded place for the cumulative curves of many outcomes; empty if they stand next to their histograms.
pub fn folded_curves(drawn: &[Figure]) -> String {
    let names: Vec<&str> =
        drawn.iter().map(|figure| figure.name.as_str()).filter(|name| name.starts_with(CUMULATIVE)).collect();
    match names.len() > BESIDE {
        true => format!(
            "<details class=\"fold\"><summary>Cumulative distributions</summary><div class=\"figures\" \
            data-figure=\"{}\"></div></details>",
            names.join(" ")
        ),
        false => String::new(),
    }
}

/// Few outcomes: rows of histogram and curve. Many: rows of three, curves last.
fn laid_out(distributions: Vec<Figure>, curves: Vec<Figure>) -> Vec<Figure> {
    let is_pairs = curves.len() == distributions.len() && curves.len() <= BESIDE;
    let columns = if is_pairs { 6 } else { 4 };
    let all: Vec<Figure> = match is_pairs {
        true => distributions.into_iter().zip(curves).flat_map(|(one, other)| [one, other]).collect(),
        false => distributions.into_iter().chain(curves).collect(),
    };
    all.into_iter().map(|figure| Figure { columns, ..figure }).collect()
}

/// The violating runs as bars in front of the others, if any; with several limits each row of the answers has its own.
fn missed(plan: &Plan, survey: &Survey, index: usize, outcome: &SurveyedOutcome, marks: &[Mark]) -> Option<Mark> {
    let fates = fates::of_one(survey, Some(fates::only_limit(plan, outcome.quantity.name())?));
    let edges = marks.iter().find_map(|mark| if let Mark::Bars { edges, .. } = mark { Some(edges) } else { None })?;
    let rows = shown_rows(survey).into_iter().filter(|row| fates[*row] == Fate::Missed);
    let values = rows.map(|row| survey.thinned.outcomes[index][row]);
    let values: Vec<f64> = values.map(|value| if outcome.is_error { value.abs() } else { value }).collect();
    let heights = counts(&values, edges);
    let label = "of these, miss its limit".to_owned();
    let any = heights.iter().any(|height| *height > 0.0);
    any.then(|| Mark::Bars { label, hue: Hue::Failed, heights, edges: edges.clone() })
}

/// The running share of runs in which an outcome is 1, with its interval.
fn share(plan: &Plan, outcome: &SurveyedOutcome, has_intervals: bool) -> Figure {
    let growth = &outcome.growth;
    let x: Vec<f64> = growth.iter().map(|row| row[0]).collect();
    let y: Vec<f64> = growth.iter().map(|row| row[5] / row[0]).collect();
    let of = |row: &[f64; 7]| [row[5], row[0], row[6]].map(|count| count as u64);
    let ends = growth.iter().map(of);
    let ends = ends.map(|[above, count, lost]| share_interval(above, [count, lost], outcome.confidence));
    let (low, high): (Vec<f64>, Vec<f64>) = ends.map(|[low, high]| (low, high)).unzip();
    let mut marks = with_band(outcome, "share of runs", (x, y, low, high), has_intervals);
    let asked = plan.analysis.requirements.iter().filter(|one| one.observable() == Some(outcome.quantity.name()));
    marks.extend(asked.filter_map(|one| match (one.statement, one.limit) {
        (Statement::Fraction(at), GateLimit::AtLeast(least)) if 0.0 < least && least <= 1.0 => {
            Some(Mark::Limit { label: format!("at least {}%", number(100.0 * at)), at, vertical: false })
        }
        _ => None,
    }));
    let lowest = marks.iter().map(lowest).fold(1.0, f64::min);
    // shares near 1 are shown from the tenth below
    let from = if lowest > 0.5 { (libm::floor(10.0 * lowest - 0.2) / 10.0).max(0.0) } else { 0.0 };
    let name = names::of_quantity(&outcome.quantity);
    Figure::of(
        FigureSection::Outcome,
        [
            format!("share_{}", outcome.quantity.name()),
            format!("{}: share of runs", sentence(&name)),
            format!(
                "Of the first N dispersed runs that were computed. {}",
                if has_intervals { "Band: Clopper-Pearson." } else { NO_INTERVAL }
            ),
        ],
        [Axis::log("runs N", ""), Axis::linear("share of runs", "").within(from, 1.0)],
        marks,
    )
    .wide(4)
}

fn lowest(mark: &Mark) -> f64 {
    match mark {
        Mark::Line { y: values, .. } | Mark::Band { low: values, .. } => values.iter().copied().fold(1.0, f64::min),
        Mark::Limit { at, .. } => *at,
        _ => 1.0,
    }
}

fn limits(plan: &Plan, outcome: &SurveyedOutcome) -> Vec<Mark> {
    let of = |requirement: &&Requirement| requirement.observable() == Some(outcome.quantity.name());
    let shown = plan.analysis.display.of(outcome.quantity.name(), outcome.quantity.unit());
    let mark = |requirement: &Requirement| {
        let (label, at) = (typeset(&limit_text(requirement.limit, &shown)), requirement.limit.value());
        Mark::Limit { label, at, vertical: true }
    };
    unique(plan.analysis.requirements.iter().filter(of).map(mark))
}

/// Excludes far limits from the axis; they are named at its edge, and the runs keep a third of it.
fn near_limits(mut figure: Figure) -> Figure {
    const REACH: f64 = 2.0;
    const MARGIN: f64 = 0.04;
    if figure.x.scale != Scale::Linear {
        return figure;
    }
    let (mut values, mut limits) = (Vec::new(), Vec::new());
    for mark in &figure.marks {
        match mark {
            Mark::Bars { edges, .. } => values.extend(edges),
            Mark::Line { x, .. } => values.extend(x),
            Mark::Limit { at, .. } => limits.push(*at),
            _ => {}
        }
    }
    let ends =
        |values: &[f64]| values.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| [a.min(*x), b.max(*x)]);
    let [low, high] = ends(&values);
    let reach = REACH * (high - low);
    let (near, far): (Vec<f64>, Vec<f64>) = limits.iter().partition(|at| low - **at <= reach && **at - high <= reach);
    if reach > 0.0 && !far.is_empty() {
        values.extend(near);
        let [low, high] = ends(&values);
        // keep an axis of non-negative values at or above 0
        let floor = if low >= 0.0 { 0.0 } else { f64::NEG_INFINITY };
        figure.x = figure.x.within((low - MARGIN * (high - low)).max(floor), high + MARGIN * (high - low));
    }
    figure
}

/// The marked quantiles: the required ones, else the median and the highest up to 99%.
fn marked(plan: &Plan, outcome: &SurveyedOutcome, row: Option<&ColumnStatistics>) -> Vec<[f64; 4]> {
    let all = row.map_or(Vec::new(), ColumnStatistics::quantile_numbers);
    let required = plan.analysis.requirements.iter().filter(|one| one.observable() == Some(outcome.quantity.name()));
    let required: Vec<f64> =
        required.filter_map(|one| if let Statement::Quantile(p) = one.statement { Some(p) } else { None }).collect();
    let asked: Vec<[f64; 4]> = all.iter().filter(|quantile| required.contains(&quantile[0])).copied().collect();
    if !asked.is_empty() {
        return asked;
    }
    let median = all.iter().find(|quantile| quantile[0] == 0.5);
    let high = all.iter().rfind(|quantile| quantile[0] <= 0.99 && quantile[0] > 0.5);
    median.into_iter().chain(high).copied().collect()
}

fn cumulative(
    plan: &Plan,
    survey: &Survey,
    outcome: &SurveyedOutcome,
    row: Option<&ColumnStatistics>,
    has_intervals: bool,
) -> Figure {
    let count = outcome.sketch.count();
    let steps = count.min(MOST_POINTS);
    let ranks = (1..=steps).map(|step| (step * count).div_ceil(steps));
    let curve = stepped(curve(outcome, ranks, false, f64::NEG_INFINITY));
    let mut marks = with_band(outcome, "fraction of runs", curve, has_intervals);
    for (place, [p, value, from, to]) in marked(plan, outcome, row).into_iter().enumerate() {
        let hue = Hue::Curve(place + 2);
        let label = if p == 0.5 { "median".to_owned() } else { format!("{}% quantile", number(100.0 * p)) };
        if has_intervals && from.is_finite() && to.is_finite() {
            marks.push(Mark::line(label.clone(), hue, Dash::Solid, vec![from, to], vec![p, p]));
        }
        marks.push(Mark::points(label, (hue, PointShape::Disc), vec![value], vec![p]));
    }
    marks.extend(limits(plan, outcome));
    let what = magnitude(outcome);
    let is_log = outcome.is_error && outcome.sketch.min().is_some_and(|min| min > 0.0);
    let axis = if is_log { Axis::log } else { Axis::linear };
    let interval = if has_intervals { "Band: Clopper-Pearson." } else { NO_INTERVAL };
    Figure::of(
        FigureSection::Outcome,
        [
            format!("{CUMULATIVE}{}", outcome.quantity.name()),
            format!("{}: cumulative distribution", names::title(&outcome.quantity)),
            format!("Fraction of {} with at most this value. {interval}", all_having(survey, &outcome.sketch)),
        ],
        [
            axis(what, outcome.quantity.unit()).showing(outcome.quantity.name()),
            Axis::linear("fraction of runs", "").within(0.0, 1.0),
        ],
        marks,
    )
}

/// A stepped curve if there are few distinct values.
fn stepped(curve: Curve) -> Curve {
    let (x, y, low, high) = &curve;
    if 1 + x.windows(2).filter(|pair| pair[0] < pair[1]).count() > MOST_STEPS {
        return curve;
    }
    let places = 0..x.len();
    // repeat the last fraction before a higher value
    let rows = places.flat_map(|k| (k > 0 && x[k - 1] < x[k]).then(|| (k, k - 1)).into_iter().chain([(k, k)]));
    let rows: Vec<(usize, usize)> = rows.collect();
    let of = |values: &[f64]| rows.iter().map(|(_, k)| values[*k]).collect();
    (rows.iter().map(|(k, _)| x[*k]).collect(), of(y), of(low), of(high))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: an axis includes near limits and excludes far ones.
    #[test]
    fn far_limits_are_outside_of_the_axis() {
        let figure = |limits: &[f64]| {
            let mut marks = vec![Mark::line("runs", Hue::Total, Dash::Solid, vec![10.0, 11.0], vec![0.0, 1.0])];
            let limit = |at: &f64| Mark::Limit { label: String::new(), at: *at, vertical: true };
            marks.extend(limits.iter().map(limit));
            near_limits(Figure::new("", Axis::linear("x", ""), Axis::linear("y", ""), marks)).x.range
        };
        assert_eq!([figure(&[]), figure(&[12.9]), figure(&[8.1])], [None; 3]);
        assert_eq!(figure(&[1000.0]), Some([9.96, 11.04]));
        let [low, high] = figure(&[-5.0, 12.0]).expect("a range");
        assert!((low - 9.92).abs() < 1e-12 && (high - 12.08).abs() < 1e-12, "{low} {high}");
    }
}
