//! Where the values of a dispersed number come from, in words.

use crate::campaign::Plan;
use crate::findings::names::unit_of_input;
use crate::findings::number::trimmed;
use crate::sampling::NumberWords;

/// The distribution of the dispersed number `column` of `plan`, in the unit in which it is shown; or what gives its
/// values.
pub fn origin(plan: &Plan, column: usize) -> String {
    let shown = unit_of_input(plan, column);
    let number = |value: f64| trimmed(value, 4);
    let amount = |value: f64| format!("{} {}", number(shown.value(value)), shown.unit).trim_end().to_owned();
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::Overrides;

    /// Law: a number in the unit of the parameter is shown in the unit in which it was written; a shape has no unit.
    #[test]
    fn amounts_have_the_unit_that_was_written() {
        let text = include_str!("../../campaigns/pyramid.toml").replace(
            "distribution = \"normal\"\nstd = \"0.1 deg\"",
            "distribution = \"gamma\"\nshape = 2.0\nscale = \"0.1 deg\"",
        );
        let plan = Plan::from_text("pyramid", &text, Overrides::default()).expect("valid");
        let names = |column: usize| plan.dispersions.columns()[column].parameter.name();
        let of =
            |name: &str| (0..plan.dispersions.columns().len()).find(|column| names(*column) == name).expect("a column");
        assert_eq!(origin(&plan, of("wheels.w1.tilt_rad")), "gamma, shape 2, scale 0.1 deg, from 0 deg");
        let spin = origin(&plan, of("initial.angular_velocity_rad_s"));
        assert!(spin.ends_with("magnitude uniform, 1 deg/s to 6 deg/s"), "{spin}");
    }
}
