//! The inputs, one line each: what was drawn as a small histogram, what was asked for, the nominal value, and how well
//! both fit.

use crate::campaign::Plan;
use crate::findings::names::{self, sentence, unit_of_input};
use crate::findings::origin::origin;
use crate::math::incomplete_gamma::incomplete_gamma;
use crate::report::escaped::escaped;
use crate::report::figure::{Figure, Mark};
use crate::report::page::pictures::histogram;
use crate::report::page::readable::with_unit;

/// Fewest samples that are expected in a class of the test.
const FEWEST: f64 = 5.0;

/// A line for each input that has a figure among `figures`; it opens to the figure.
pub fn rows(plan: &Plan, figures: &[Figure]) -> String {
    let row = |index: usize| {
        let column = &plan.dispersions.columns()[index];
        let technical = column.parameter.column_name(column.component);
        let figure = figures.iter().find(|figure| figure.name == format!("input_{technical}"))?;
        let shown = unit_of_input(plan, index);
        let fit = match fit(figure) {
            Some(p) if p < 1e-3 => "p < 0.001".to_owned(),
            Some(p) => format!("p = {p:.3}"),
            None => "-".to_owned(),
        };
        Some(format!(
            "<details class=\"input\"><summary title=\"{}\"><span>{}</span>{}<span>{}</span><span \
            class=\"quiet\">{}</span><span>{}</span></summary><div class=\"place\" \
            data-figure=\"{}\"></div></details>\n",
            escaped(&column.parameter.component_name(column.component)),
            escaped(&sentence(&names::of_input(plan, index))),
            histogram(figure, Some("nominal")),
            escaped(&with_unit(shown.value(column.nominal), &shown.unit)),
            escaped(&origin(plan, index)),
            escaped(&fit),
            escaped(&figure.name),
        ))
    };
    let rows: String = (0..plan.dispersions.columns().len()).filter_map(row).collect();
    if rows.is_empty() {
        return rows;
    }
    format!(
        "<div class=\"inputs\"><p class=\"input head\"><span>input</span><span>drawn and \
        expected</span><span>nominal</span><span>distribution</span><span>fit</span></p>\n{rows}</div><p \
        class=\"caption\">Fit: chi-squared test of the drawn values against the distribution in the file. A small p \
        speaks against it, though among many inputs some are small by chance; evenly spread designs fit better than \
        chance. Click a line for its histogram.</p>\n"
    )
}

/// Observed and expected counts of a histogram, class by class; empty where nothing is expected.
fn counts(figure: &Figure) -> (Vec<f64>, Vec<f64>) {
    let (mut observed, mut expected) = (Vec::new(), Vec::new());
    let mut edges: &[f64] = &[];
    for mark in &figure.marks {
        match mark {
            Mark::Bars { heights, edges: of, .. } => (observed, edges) = (heights.clone(), of),
            Mark::Line { y, .. } => expected.clone_from(y),
            // of a discrete distribution: each value is in one bar
            Mark::Points { x, y, .. } => {
                expected = vec![0.0; observed.len()];
                for (value, count) in x.iter().zip(y) {
                    let bar = edges.partition_point(|edge| edge <= value).clamp(1, observed.len().max(1)) - 1;
                    if let Some(sum) = expected.get_mut(bar) {
                        *sum += count;
                    }
                }
            }
            _ => {}
        }
    }
    (observed, expected)
}

/// The probability of a distance from the expected counts at least as large by chance (K. Pearson, *Phil. Mag.* 50
/// (1900) 157), where classes are joined until five samples are expected in each; `None` where fewer than two are left.
fn fit(figure: &Figure) -> Option<f64> {
    let (observed, expected) = counts(figure);
    if expected.len() != observed.len() {
        return None;
    }
    let mut classes: Vec<[f64; 2]> = Vec::new();
    let mut open = [0.0; 2];
    for (observed, expected) in observed.iter().zip(&expected) {
        open = [open[0] + observed, open[1] + expected];
        if open[1] >= FEWEST {
            classes.push(core::mem::take(&mut open));
        }
    }
    // what is left over belongs to the last class, and what is expected beyond the bars to those at the ends
    let last = classes.last_mut()?;
    *last = [last[0] + open[0], last[1] + open[1]];
    let [all, inside] = [0, 1].map(|place| classes.iter().map(|class| class[place]).sum::<f64>());
    let half = 0.5 * (all - inside);
    let end = classes.len() - 1;
    classes[0][1] += half;
    classes[end][1] += half;
    if end == 0 {
        return None;
    }
    let distance: f64 = classes.iter().map(|[seen, asked]| (seen - asked) * (seen - asked) / asked).sum();
    Some(incomplete_gamma(0.5 * end as f64, 0.5 * distance).upper)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::expected::Expected;
    use crate::report::histogram::of_input;
    use crate::sampling::distribution::Quantile;
    use crate::sampling::distribution::normal::NormalQuantile;

    /// Even numbers in (0, 1) by the multiplier of M. Park and S. Miller (1988).
    fn even(count: usize, seed: u64) -> Vec<f64> {
        let mut state = seed * 7919 + 17;
        let next = |_| {
            state = state * 48_271 % 2_147_483_647;
            state as f64 / 2_147_483_647.0
        };
        (0..count + 20).map(next).skip(20).collect()
    }

    /// Law: where the draws are those of the distribution, one p in twenty is below 0.05, or fewer; a standard
    /// deviation that is a fifth larger, or a mean that is three tenths of one off, has a small p; what has no
    /// distribution has none.
    #[test]
    fn fits_are_judged() {
        let asked = NormalQuantile { mean: 1.0, std: 2.0 };
        let asked = Expected::of_quantile(|u| asked.quantile(u));
        let p = |other: NormalQuantile, seed: u64| {
            let drawn: Vec<f64> = even(1000, seed).into_iter().map(|u| other.quantile(u)).collect();
            fit(&of_input("x", "", &drawn, 1.0, Some(&asked))).expect("a fit")
        };
        let right: Vec<f64> = (0..200).map(|seed| p(NormalQuantile { mean: 1.0, std: 2.0 }, seed)).collect();
        let small = right.iter().filter(|p| **p < 0.05).count();
        let half = right.iter().filter(|p| **p < 0.5).count();
        assert!(small <= 24 && (60..=140).contains(&half), "{small} and {half} of 200");
        for wrong in [NormalQuantile { mean: 1.0, std: 2.4 }, NormalQuantile { mean: 1.6, std: 2.0 }] {
            let small = (0..50).filter(|seed| p(wrong, *seed) < 1e-2).count();
            assert!(small >= 48, "{small} of 50");
        }
        assert_eq!(fit(&of_input("x", "", &[1.0, 2.0, 3.0], 1.0, None)), None);
    }
}
