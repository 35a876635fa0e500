//! [`draw_alike`]: whether two plans draw the same samples, though about other nominal values.

use super::plan::Plan;
use crate::sampling::distribution::{Distribution, Quantile};
use crate::sampling::transform::{Assigned, Transform};

/// Fractions at which quantile functions are compared.
const FRACTIONS: [f64; 7] = [1e-3, 0.1, 0.3, 0.5, 0.7, 0.9, 1.0 - 1e-3];
/// Part of a distribution's width, and of the magnitude of its numbers, by which rounding may move one quantile against another.
const ROUNDING: [f64; 2] = [1e-9, 8.0 * f64::EPSILON];

/// Whether a sample of `first` and the one of `second` with its number are drawn from the same random numbers, by the same distributions as far as these
/// do not follow the nominal values: seed and design are the same, and every distribution is written alike, or differs from that of the
/// other plan by its location alone.
pub fn draw_alike(first: &Plan, second: &Plan) -> bool {
    let (a, b) = (&first.dispersions, &second.dispersions);
    let has_same_points = first.seed == second.seed
        && first.design == second.design
        && (first.samples == second.samples || first.design.depends_on_samples().is_none())
        && a.dimensions() == b.dimensions();
    let names = |plan: &Plan| -> Vec<String> {
        let columns = plan.dispersions.columns().iter();
        columns.map(|column| column.parameter.column_name(column.component)).collect()
    };
    let is_alike = |one: &Assigned, other: &Assigned| {
        (one.first, &one.columns) == (other.first, &other.columns)
            && (first.dispersed[one.table] == second.dispersed[other.table] || is_moved(&one.map, &other.map))
    };
    has_same_points
        && (&first.correlated, &first.derived) == (&second.correlated, &second.derived)
        && names(first) == names(second)
        && a.assigned().len() == b.assigned().len()
        && a.assigned().iter().zip(b.assigned()).all(|(one, other)| is_alike(one, other))
}

/// Whether all quantiles of one distribution differ from those of the other by the same number.
fn is_moved(one: &Transform, other: &Transform) -> bool {
    let (Transform::Scalar(one), Transform::Scalar(other)) = (one, other) else { return false };
    let quantiles = |of: &Distribution| FRACTIONS.map(|u| of.quantile(u));
    let (a, b) = (quantiles(one), quantiles(other));
    let largest = a.iter().chain(&b).fold(0.0_f64, |largest, value| largest.max(value.abs()));
    let slack = ROUNDING[0] * (a[FRACTIONS.len() - 1] - a[0]) + ROUNDING[1] * largest;
    let shift = b[0] - a[0];
    a.iter().zip(&b).all(|(a, b)| (b - a - shift).abs() <= slack)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::Overrides;

    const TEXT: &str = r#"
integrator = { method = "auto", tolerance = 1e-10 }
observe = { points = 11 }
campaign = { name = "small", seed = 1, duration_s = 1.0, samples = 9 }
design = { kind = "random" }

[initial]
angular_velocity_rad_s = [0.0, 0.1, 0.5]

[body]
mass_kg = 500.0
center_of_mass_m = [0.0, 0.0, 0.0]
inertia_kg_m2 = [[120.0, 0.0, 0.0], [0.0, 150.0, 0.0], [0.0, 0.0, 90.0]]
includes_wheels = false

[[disperse]]
parameter = "initial.angular_velocity_rad_s.x"
distribution = "normal"
std = 0.05

[[disperse]]
parameter = "initial.angular_velocity_rad_s.y"
distribution = "uniform"
min = 0.05
max = 0.15

[[disperse]]
parameter = "initial.attitude"
distribution = "attitude_error"
std_rad = 0.01
"#;

    const CORRELATED: &str = r#"std_rad = 0.01
[[correlate]]
parameters = ["initial.angular_velocity_rad_s.x", "initial.angular_velocity_rad_s.y"]
rank_correlation = 0.5
"#;
    const DERIVED: &str = r#"std_rad = 0.01
[[derive]]
parameter = "initial.angular_velocity_rad_s.z"
expression = "0.5 + 2 * initial.angular_velocity_rad_s.x"
"#;

    /// Law: plans draw alike where seed, design and distributions are the same but for their location; another seed, design, width, kind,
    /// parameter, correlation or derived value, or another number of samples where the design depends on it, is another draw.
    #[test]
    fn plans_that_differ_in_location_draw_alike() {
        let plan = |changes: &[(&str, &str)]| {
            let text = changes.iter().fold(TEXT.to_owned(), |text, (was, is)| {
                assert!(text.contains(was), "{was}");
                text.replace(was, is)
            });
            Plan::from_text("small.toml", &text, Overrides::default()).expect("a plan")
        };
        let latin = ("\"random\"", "\"latin_hypercube\"");
        let first = plan(&[]);
        for alike in [
            vec![],
            vec![("[0.0, 0.1, 0.5]", "[0.3, 0.1, 0.5]")],
            vec![("min = 0.05", "min = 1.05"), ("max = 0.15", "max = 1.15")],
            vec![("samples = 9", "samples = 90")],
            vec![("500.0", "700.0"), ("duration_s = 1.0", "duration_s = 2.0")],
        ] {
            assert!(draw_alike(&first, &plan(&alike)), "{alike:?}");
        }
        for other in [
            vec![("seed = 1", "seed = 2")],
            vec![latin],
            vec![("std = 0.05", "std = 0.0500001")],
            vec![("max = 0.15", "max = 0.16")],
            vec![("std_rad = 0.01", "std_rad = 0.02")],
            vec![("velocity_rad_s.x", "velocity_rad_s.z")],
            vec![("\"normal\"\nstd = 0.05", "\"uniform\"\nhalf_width = 0.05")],
            vec![("std_rad = 0.01", CORRELATED)],
            vec![("std_rad = 0.01", DERIVED)],
        ] {
            assert!(!draw_alike(&first, &plan(&other)), "{other:?}");
        }
        for (written, is) in [(CORRELATED, ("0.5\n", "0.6\n")), (DERIVED, ("2 *", "3 *"))] {
            let one = ("std_rad = 0.01", written);
            assert!(
                draw_alike(&plan(&[one]), &plan(&[one])) && !draw_alike(&plan(&[one]), &plan(&[one, is])),
                "{is:?}"
            );
        }
        let more = ("samples = 9", "samples = 90");
        assert!(draw_alike(&plan(&[latin]), &plan(&[latin])) && !draw_alike(&plan(&[latin]), &plan(&[latin, more])));
    }
}
