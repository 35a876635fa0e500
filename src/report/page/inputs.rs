//! Figures of the inputs: what was applied against what was asked for, and correlations.

use core::f64::consts::PI;

use crate::analysis::survey::Survey;
use crate::campaign::Plan;
use crate::findings::names;
use crate::report::figure::{Axis, Figure, FigureSection};
use crate::report::origin_text::origin;
use crate::report::{drawn_figure, histogram, marginal};
use crate::sampling::correlation::{Measure, Numbers};
use crate::statistics::correlation::{matrix, mid_ranks, standardised};

/// Inputs with figures of their own.
const MOST_INPUTS: usize = 36;
/// Inputs in a matrix of correlations.
const MOST_CORRELATED: usize = 24;

/// Histograms of the inputs, and their correlations as asked and as achieved.
pub fn figures(plan: &Plan, survey: &Survey) -> Vec<Figure> {
    let columns = survey.thinned.inputs.len();
    let mut figures: Vec<Figure> = (0..columns.min(MOST_INPUTS)).map(|column| input(plan, survey, column)).collect();
    figures.extend(correlations(plan, survey));
    figures.retain(Figure::is_visible);
    figures
}

/// The rows of the thinned table that are dispersed.
fn dispersed(survey: &Survey) -> Vec<usize> {
    (0..survey.thinned.samples.len()).filter(|row| survey.thinned.samples[*row] != 0).collect()
}

fn input(plan: &Plan, survey: &Survey, index: usize) -> Figure {
    let column = &plan.dispersions.columns()[index];
    let name = names::of_input(plan, index);
    let unit = if column.parameter.unit() == "1" { "" } else { column.parameter.unit() };
    let values: Vec<f64> =
        dispersed(survey).into_iter().map(|row| survey.thinned.inputs[index][row]).filter(|x| x.is_finite()).collect();
    let asked = marginal::of_column(plan, index);
    let line = match asked.as_ref().map(|asked| asked.values().is_some()) {
        None => "",
        Some(false) => " Line: expected counts of the requested distribution.",
        Some(true) => " Dots: expected counts of each value.",
    };
    let histogram = histogram::of_input(&name, unit, &values, column.nominal, asked.as_ref());
    Figure {
        name: format!("input_{}", column.parameter.column_name(column.component)),
        section: FigureSection::Inputs,
        title: names::sentence(&name),
        caption: format!(
            "{} dispersed samples; {}.{line}",
            shown_of(values.len() as u64, survey.statuses.runs().saturating_sub(1)),
            origin(plan, index)
        ),
        columns: 4,
        x: Axis { quantity: name, column: column.parameter.name(), ..histogram.x },
        y: Axis::linear("samples", ""),
        ..histogram
    }
}

/// A number, of how many where these are more.
fn shown_of(shown: u64, all: u64) -> String {
    if shown == all { all.to_string() } else { format!("{} of {}", shown, all) }
}

fn correlations(plan: &Plan, survey: &Survey) -> Vec<Figure> {
    let all = plan.dispersions.columns();
    let varies = |index: &usize| survey.thinned.inputs[*index].windows(2).any(|pair| pair[0] != pair[1]);
    let shown: Vec<usize> = (0..all.len()).filter(varies).take(MOST_CORRELATED).collect();
    let rows = dispersed(survey);
    if shown.len() < 2 || rows.len() < 3 {
        return Vec::new();
    }
    let names: Vec<String> = shown.iter().map(|index| names::of_input(plan, *index)).collect();
    let scores = |index: &usize| {
        let column = &survey.thinned.inputs[*index];
        standardised(&mid_ranks(&rows.iter().map(|row| column[*row]).collect::<Vec<f64>>()))
    };
    let achieved = matrix(&shown.iter().map(scores).collect::<Vec<_>>());
    let chance = (1.96 / libm::sqrt((rows.len() - 1) as f64)).min(1.0);
    let figure = |name: &str, title: &str, caption: String, values: Vec<Vec<f64>>| Figure {
        name: name.to_owned(),
        section: FigureSection::Inputs,
        caption,
        ..drawn_figure::correlations(title, &names, values)
    };
    let note = if shown.len() < all.len() {
        format!(" The first {} of {} inputs.", shown.len(), all.len())
    } else {
        String::new()
    };
    let mut figures = Vec::new();
    if !plan.correlated.is_empty() {
        let caption = "Rank correlation that the campaign file asks for; other pairs are drawn independently.";
        figures.push(figure(
            "correlation_asked",
            "Rank correlation, asked for",
            caption.to_owned(),
            asked(plan, &shown),
        ));
    }
    let caption = format!(
        "Spearman's coefficient of {} dispersed samples; of independent inputs up to \u{b1}{chance:.2} by chance \
        (95%).{note}",
        rows.len() as u64
    );
    figures.push(figure("correlation_achieved", "Rank correlation, achieved", caption, achieved));
    figures
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
