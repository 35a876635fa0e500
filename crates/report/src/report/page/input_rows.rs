//! One line per input: histogram of the draws, distribution, nominal value.

use crate::campaign::Plan;
use crate::findings::names::{self, sentence, unit_of_input};
use crate::findings::origin::origin;
use crate::report::figure::Figure;
use crate::report::page::pictures::histogram;
use crate::report::page::readable::with_unit;
use crate::table::html::escaped;

/// A line, which opens its figure, for each input with a figure among `figures`.
pub fn rows(plan: &Plan, figures: &[Figure]) -> String {
    let row = |index: usize| {
        let column = &plan.dispersions.columns()[index];
        let technical = column.parameter.column_name(column.component);
        let figure = figures.iter().find(|figure| figure.name == format!("input_{technical}"))?;
        let shown = unit_of_input(plan, index);
        Some(format!(
            "<details class=\"input\"><summary title=\"{}\"><span>{}</span>{}<span>{}</span><span \
            class=\"quiet\">{}</span></summary><div class=\"place\" \
            data-figure=\"{}\"></div></details>\n",
            escaped(&column.parameter.component_name(column.component)),
            escaped(&sentence(&names::of_input(plan, index))),
            histogram(figure, None, Some("nominal")),
            escaped(&with_unit(shown.value(column.nominal), &shown.unit)),
            escaped(&origin(plan, index)),
            escaped(&figure.name),
        ))
    };
    let rows: String = (0..plan.dispersions.columns().len()).filter_map(row).collect();
    if rows.is_empty() {
        return rows;
    }
    format!(
        "<div class=\"inputs\"><p class=\"input head\"><span>input</span><span>drawn and \
        expected</span><span>nominal</span><span>distribution</span></p>\n{rows}</div><p \
        class=\"caption\">Click a line for its histogram.</p>\n"
    )
}
