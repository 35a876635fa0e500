//! [`DrawnInputs`]: figures of the inputs: what was applied against what was asked for, and correlations.

use core::f64::consts::PI;

use crate::campaign::Plan;
use crate::findings::names;
use crate::findings::origin::origin;
use crate::report::expected::Expected;
use crate::report::figure::{Axis, Figure, FigureSection, Mark};
use crate::report::histogram;
use crate::sampling::correlation::{Measure, Numbers};
use crate::statistics::correlation::{matrix, mid_ranks, standardised};

/// Inputs with figures of their own.
const MOST_INPUTS: usize = 36;
/// Inputs in a matrix of correlations.
const MOST_CORRELATED: usize = 24;

/// Dispersed samples: the values of each dispersed number, and of how many samples they are some.
#[derive(Clone, Debug)]
pub struct DrawnInputs {
    pub columns: Vec<Vec<f64>>,
    pub all: u64,
}

impl DrawnInputs {
    /// Histograms of the inputs, and their correlations as asked and as achieved.
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
        let unit = if column.parameter.unit() == "1" { "" } else { column.parameter.unit() };
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
        let histogram = histogram::of_input(&name, unit, &values, column.nominal, expected.as_ref());
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

/// The rank correlations that the file asks for, of the inputs `shown`.
fn asked(plan: &Plan, shown: &[usize]) -> Vec<Vec<f64>> {
    let all = plan.dispersions.columns();
    let mut found: Vec<Vec<f64>> =
        (0..shown.len()).map(|i| (0..shown.len()).map(|j| f64::from(u8::from(i == j))).collect()).collect();
    for correlation in &plan.correlated {
        let places = |(parameter, component): &(crate::scene::Parameter, Option<usize>)| -> Vec<Option<usize>> {
            let of = |component: usize| {
                shown.iter().position(|index| (all[*index].parameter, all[*index].component) == (*parameter, component))
            };
            match component {
                Some(component) => vec![of(*component)],
                None => (0..parameter.width()).map(of).collect(),
            }
        };
        let parameters: Vec<Vec<Option<usize>>> = correlation.parameters.iter().map(places).collect();
        let together: Vec<Option<usize>> = parameters.iter().flatten().copied().collect();
        let mut set = |a: Option<usize>, b: Option<usize>, value: f64| {
            if let (Some(a), Some(b)) = (a, b) {
                (found[a][b], found[b][a]) = (value, value);
            }
        };
        let ranks = |r: f64| {
            if correlation.measure == Measure::Ranks { r } else { 6.0 / PI * libm::asin(0.5 * r.clamp(-1.0, 1.0)) }
        };
        match &correlation.numbers {
            Numbers::One(r) => set(together[0], together.get(1).copied().flatten(), ranks(*r)),
            Numbers::Rows(rows) if rows.len() == together.len() => {
                for (i, row) in rows.iter().enumerate() {
                    for (j, value) in row.iter().enumerate().filter(|(j, _)| *j != i) {
                        let scale = if correlation.measure == Measure::Covariance {
                            libm::sqrt(rows[i][i] * rows[j][j])
                        } else {
                            1.0
                        };
                        set(together[i], together[j], ranks(value / scale));
                    }
                }
            }
            Numbers::Rows(rows) => {
                for (row, a) in rows.iter().zip(&parameters[0]) {
                    for (value, b) in row.iter().zip(parameters.iter().skip(1).flatten()) {
                        set(*a, *b, ranks(*value));
                    }
                }
            }
        }
    }
    found
}
