//! The distribution or source of a dispersed number, in words.

use crate::campaign::Plan;
use crate::findings::names::unit_of_input;
use crate::findings::number::{trimmed, with_unit};
use crate::sampling::NumberWords;

/// The distribution of the dispersed number `column` in its shown unit, or the source of its values.
pub fn origin(plan: &Plan, column: usize) -> String {
    let shown = unit_of_input(plan, column);
    let number = |value: f64| trimmed(value, 4);
    let amount = |value: f64| with_unit(number(shown.value(value)), &shown.unit);
    let of_angles = plan.analysis.display.of(&plan.dispersions.columns()[column].parameter.name(), "rad");
    let angle = |value: f64| format!("{} {}", number(of_angles.value(value)), of_angles.unit);
    if let Some(distribution) = plan.dispersions.distribution_of(column) {
        distribution.text(NumberWords { amount: &amount, angle: &angle, number: &number })
    } else if let Some(expression) = plan.dispersions.expression_of(column) {
        format!("= {expression}")
    } else if plan.dispersions.is_tabled(column) {
        "rows of a file".to_owned()
    } else {
        "follows the other components".to_owned()
    }
}
