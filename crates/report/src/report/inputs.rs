//! [`DrawnInputs`]: figures of the applied inputs against the requested distributions and correlations.

use core::f64::consts::PI;

use crate::analysis::bins::{bins, counts, ends, linear_bins};
use crate::analysis::expected::Expected;
use crate::campaign::Plan;
use crate::findings::names;
use crate::findings::number::short;
use crate::findings::origin::origin;
use crate::report::figure::{Axis, Dash, Figure, FigureSection, Hue, Mark, PointShape, Scale};
use crate::sampling::Values;
use crate::sampling::correlation::Measure;
use crate::statistics::correlation::{matrix, mid_ranks, standardised};

const MOST_INPUTS: usize = 36;
const MOST_CORRELATED: usize = 24;
/// If the nominal value is farther from the samples than this fraction of their span, it is named at the edge: the
/// samples keep two thirds of the axis.
const FAR: f64 = 0.5;
/// If the median is below this fraction of the largest value, the axis is logarithmic.
const OVER_DECADES: f64 = 0.05;

/// Values of each dispersed number, for all or some of `all` samples.
#[derive(Clone, Debug)]
pub struct DrawnInputs {
    pub columns: Vec<Vec<f64>>,
    pub all: u64,
}

impl DrawnInputs {
    pub fn figures(&self, plan: &Plan) -> Vec<Figure> {
        let shown = self.columns.len().min(MOST_INPUTS);
        let mut figures: Vec<Figure> = (0..shown).map(|column| self.histogram(plan, column)).collect();
        figures.extend(self.correlations(plan));
        figures.retain(Figure::is_visible);
        figures
    }

    fn histogram(&self, plan: &Plan, index: usize) -> Figure {
        let column = &plan.dispersions.columns()[index];
        let name = names::of_input(plan, index);
        let values: Vec<f64> = self.columns[index].iter().copied().filter(|x| x.is_finite()).collect();
        let expected = Expected::of_column(plan, index);
        let line = match expected.as_ref().map(|expected| expected.values().is_some()) {
            None => "",
            Some(false) => " Line: expected counts of the requested distribution.",
            Some(true) => " Dots: expected counts of each value.",
        };
        let shown = match values.len() as u64 {
            shown if shown == self.all => shown.to_string(),
            shown => format!("{shown} of {}", self.all),
        };
        let histogram = of_input(&name, names::own_unit(column.parameter), &values, column.nominal, expected.as_ref());
        Figure {
            name: format!("input_{}", column.parameter.column_name(column.component)),
            section: FigureSection::Inputs,
            title: names::sentence(&name),
            caption: format!("{shown} dispersed samples; {}.{line}", origin(plan, index)),
            columns: 4,
            x: Axis { quantity: name, column: column.parameter.name(), ..histogram.x },
            ..histogram
        }
    }

    fn correlations(&self, plan: &Plan) -> Vec<Figure> {
        let rows = self.columns.first().map_or(0, Vec::len);
        let varies = |index: &usize| self.columns[*index].windows(2).any(|pair| pair[0] != pair[1]);
        let shown: Vec<usize> = (0..self.columns.len()).filter(varies).take(MOST_CORRELATED).collect();
        if shown.len() < 2 || rows < 3 {
            return Vec::new();
        }
        let names: Vec<String> = shown.iter().map(|index| names::of_input(plan, *index)).collect();
        let scores = |index: &usize| standardised(&mid_ranks(&self.columns[*index]));
        let achieved = matrix(&shown.iter().map(scores).collect::<Vec<_>>());
        let figure = |name: &str, title: &str, caption: String, values: Vec<Vec<f64>>| {
            let axis = || Axis::names(names.clone());
            let marks = vec![Mark::Matrix { values: values.into_iter().flatten().collect() }];
            let figure = Figure::new(title, axis(), axis(), marks);
            Figure { name: name.to_owned(), section: FigureSection::Inputs, caption, ..figure }
        };
        let mut figures = Vec::new();
        if !plan.correlated.is_empty() {
            let caption = "Rank correlation that the campaign file asks for; other pairs are drawn independently.";
            let values = asked(plan, &shown);
            figures.push(figure("correlation_asked", "Rank correlation, asked for", caption.to_owned(), values));
        }
        let chance = (1.96 / libm::sqrt((rows - 1) as f64)).min(1.0);
        let note = match self.columns.len() {
            all if shown.len() < all => format!(" The first {} of {all} inputs.", shown.len()),
            _ => String::new(),
        };
        let caption = format!(
            "Spearman's coefficient of {rows} dispersed samples; of independent inputs up to \u{b1}{chance:.2} by \
             chance (95%).{note}"
        );
        figures.push(figure("correlation_achieved", "Rank correlation, achieved", caption, achieved));
        figures
    }
}

/// The requested rank correlations of the inputs `shown`.
fn asked(plan: &Plan, shown: &[usize]) -> Vec<Vec<f64>> {
    let all = plan.dispersions.columns();
    let mut found: Vec<Vec<f64>> =
        (0..shown.len()).map(|i| (0..shown.len()).map(|j| f64::from(u8::from(i == j))).collect()).collect();
    for correlation in &plan.correlated {
        let place = |of| shown.iter().position(|index| (all[*index].parameter, all[*index].component) == of);
        let together: Vec<Option<usize>> = correlation.components().into_iter().map(place).collect();
        let rows = match &correlation.numbers {
            Values::One(r) => vec![vec![*r]],
            Values::Rows(rows) => rows.clone(),
            Values::Each(_) => continue, // no table of correlations is a list
        };
        // a square matrix of all components, or a block of those of the first parameter with the others
        let first = if rows.len() == together.len() { 0 } else { rows.len() };
        let scale = |i: usize, j: usize| match correlation.measure {
            Measure::Covariance if first == 0 => libm::sqrt(rows[i][i] * rows[j][j]),
            _ => 1.0,
        };
        let ranks = |r: f64| {
            if correlation.measure == Measure::Ranks { r } else { 6.0 / PI * libm::asin(0.5 * r.clamp(-1.0, 1.0)) }
        };
        let pairs = (0..rows.len()).flat_map(|i| (0..rows[i].len()).map(move |j| (i, j)));
        for (i, j) in pairs.filter(|(i, j)| *i != first + j) {
            if let (Some(a), Some(b)) = (together[i], together[first + j]) {
                let value = ranks(rows[i][j] / scale(i, j));
                (found[a][b], found[b][a]) = (value, value);
            }
        }
    }
    found
}

fn of_input(name: &str, unit: &str, samples: &[f64], nominal: f64, asked: Option<&Expected>) -> Figure {
    let values: Vec<f64> = samples.iter().copied().filter(|value| value.is_finite()).collect();
    let count = values.len();
    let discrete = asked.and_then(Expected::values);
    // include discrete values with an expected count of one or more
    let frequent = discrete.iter().flatten().filter(|(_, probability)| count as f64 * probability >= 1.0);
    let shown: Vec<f64> = values.iter().copied().chain(frequent.map(|(value, _)| *value)).collect();
    let mut sorted = shown.clone();
    sorted.sort_by(f64::total_cmp);
    let is_by_decades = sorted.get(sorted.len() / 2).is_some_and(|median| *median < OVER_DECADES * ends(&shown).1);
    let (edges, is_log) = if is_by_decades { bins(&shown, &[]) } else { (linear_bins(&shown, &[]), false) };
    let mut marks = vec![Mark::Bars {
        label: "samples".to_owned(),
        hue: Hue::Body,
        heights: counts(&values, &edges),
        edges: edges.clone(),
    }];
    if let Some(asked) = asked {
        let bars = asked.bars(&edges, count);
        let middle = |ends: &[f64]| if is_log { libm::sqrt(ends[0] * ends[1]) } else { 0.5 * ends[0] + 0.5 * ends[1] };
        marks.push(match discrete {
            // one stem per bar, at the mean of the values that share it
            Some(_) => {
                let (x, y) = bars.iter().filter(|bar| bar[1] > 0.0).map(|[mean, count]| (mean, count)).unzip();
                Mark::points("expected count of a discrete value", (Hue::Nominal, PointShape::Stem), x, y)
            }
            None => {
                let (x, y) = (edges.windows(2).map(middle).collect(), bars.iter().map(|bar| bar[1]).collect());
                Mark::line("expected counts", Hue::Nominal, Dash::Solid, x, y)
            }
        });
    }
    let scale = if is_log { Scale::Log } else { Scale::Linear };
    let mut x = Axis { scale, ..Axis::linear("", unit) };
    let label = match (edges.first(), edges.last()) {
        (Some(low), Some(high)) if is_far(nominal, ends(&shown)) || (is_log && nominal <= 0.0) => {
            x = x.within(*low, *high);
            format!("nominal {}", short(nominal))
        }
        _ => "nominal".to_owned(),
    };
    if nominal.is_finite() {
        marks.push(Mark::Limit { label, at: nominal, vertical: true });
    }
    Figure { columns: 3, ..Figure::new(name, x, Axis::linear("samples", ""), marks) }
}

/// True if the nominal value would leave most of the axis empty; false for a single value.
fn is_far(nominal: f64, (low, high): (f64, f64)) -> bool {
    let reach = FAR * (high - low);
    high > low && (low - nominal > reach || nominal - high > reach)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: each value of a discrete distribution has a stem of its expected height, values that share a bar one of
    /// their sum. A continuous distribution has a curve over the bars' centres on the shown axis, whose sum is the
    /// number of samples.
    #[test]
    fn what_is_expected_is_drawn() {
        let drawn: Vec<f64> = (0..300).map(|k| [0.01, 0.02, 0.05][k % 3]).collect();
        let of = |values: &[f64; 3]| Expected::of_quantile(|u| values[(3.0 * u) as usize]);
        let stems = |values: &[f64; 3]| match of_input("x", "", &drawn, 0.01, Some(&of(values))).marks.swap_remove(1) {
            Mark::Points { shape: PointShape::Stem, x, y, .. } => (x, y),
            other => panic!("{other:?}"),
        };
        let (x, y) = stems(&[0.01, 0.02, 0.05]);
        assert!(x.iter().zip([0.01, 0.02, 0.05]).all(|(x, known)| (x - known).abs() < 1e-12), "{x:?}");
        assert!(y.len() == 3 && y.iter().all(|y| (y - 100.0).abs() < 0.05), "{y:?}");
        let (x, y) = stems(&[0.01, 0.0101, 0.05]);
        assert!(x.len() == 2 && (y[0] - 200.0).abs() < 0.05, "{x:?} {y:?}");
        // a value with an expected count belongs on the axis even if it was not drawn
        assert_eq!(stems(&[0.01, 0.02, 9.0]).0.last(), Some(&9.0));
        let decades: Vec<f64> = (0..300).map(|k| 1e-3 * libm::pow(1e4, f64::from(k) / 299.0)).collect();
        for (samples, scale, [min, max]) in
            [(&drawn, Scale::Linear, [0.01, 0.05]), (&decades, Scale::Log, [1e-3, 10.0])]
        {
            let uniform = Expected::of_quantile(|u| min + u * (max - min));
            let figure = of_input("x", "", samples, min, Some(&uniform));
            let [Mark::Bars { edges, .. }, Mark::Line { x, y, .. }, ..] = &figure.marks[..] else {
                panic!("{figure:?}")
            };
            assert!((y.iter().sum::<f64>() - 300.0).abs() < 1e-6, "{y:?}");
            assert_eq!((&figure.x.scale, x.len()), (&scale, edges.len() - 1));
            let place = |value: f64| if scale == Scale::Log { libm::log(value) } else { value };
            for (x, ends) in x.iter().zip(edges.windows(2)) {
                let part = (place(*x) - place(ends[0])) / (place(ends[1]) - place(ends[0]));
                assert!((part - 0.5).abs() < 1e-9, "{x} in {ends:?}");
            }
        }
    }
}
