//! [`drawn_figure`]: histograms of the dispersed parameters and the rank correlation of each pair.

use crate::report::drawn_columns::DrawnColumns;
use crate::report::figure::{Axis, Figure, Mark};
use crate::report::figure_files::FigureSheet;
use crate::report::histogram;

/// With fewer samples than this, correlations of independent parameters beyond 0.14 are common.
const FEW: usize = 200;

/// The picture of drawn samples.
pub fn drawn_figure(title: String, columns: &DrawnColumns<'_>) -> FigureSheet {
    let inputs = columns.names.iter().zip(&columns.drawn.columns).zip(columns.nominal.iter().zip(&columns.asked));
    let inputs = inputs.zip(&columns.parameters);
    let histograms = inputs.map(|(((name, values), (nominal, asked)), (parameter, unit))| {
        let figure = histogram::of_input(name, unit, values, *nominal, asked.as_ref());
        Figure { x: figure.x.clone().showing(parameter), ..figure }
    });
    let title_of_matrix = format!("Rank correlation{}", caution(columns.drawn.count()));
    let matrix = correlations(&title_of_matrix, &columns.names, columns.drawn.rank_correlations());
    let panels = histograms.chain([Figure { columns: 12, ..matrix }]).collect();
    FigureSheet { title, figures: panels }
}

/// The figure of a matrix of correlations.
pub fn correlations(title: &str, names: &[String], values: Vec<Vec<f64>>) -> Figure {
    let axis = || Axis::names(names.to_vec());
    Figure::new(title, axis(), axis(), vec![Mark::Matrix { values: values.into_iter().flatten().collect() }])
}

/// What a correlation of `samples` samples says: that of independent parameters has the standard deviation 1/sqrt(n -
/// 1).
fn caution(samples: usize) -> String {
    let Some(others) = samples.checked_sub(1).filter(|others| *others > 0) else {
        return ": too few samples".to_owned();
    };
    let bound = (1.96 / (others as f64).sqrt()).min(1.0);
    let word = if samples < FEW { "; caution, few samples" } else { "" };
    format!(", {samples} samples: up to \u{b1}{bound:.2} by chance (95%){word}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_samples_are_said_to_be_few() {
        assert_eq!(caution(1000), ", 1000 samples: up to \u{b1}0.06 by chance (95%)");
        assert!(caution(50).ends_with("few samples") && caution(1).contains("too few"));
    }
}
