//! [`draw_alike`]: whether two plans share random numbers.

use super::plan::Plan;

/// Whether equal samples of two plans share random numbers: seed and design are equal, and so is a dispersed dimension,
/// or nothing is dispersed. Distributions may differ: larger values still mostly go with larger ones.
pub fn draw_alike(first: &Plan, second: &Plan) -> bool {
    let [one, other] = [first, second].map(|plan| plan.dispersions.dimensions());
    first.seed == second.seed
        && first.design == second.design
        && (first.samples == second.samples || first.design.facts().depends_on_samples.is_none())
        && (one == other || one.iter().any(|name| other.contains(name)))
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
initial = { angular_velocity_rad_s = [0.0, 0.1, 0.5] }

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
"#;

    /// Law: plans draw alike if seed, design and one dimension are equal, whatever the distributions; another seed or
    /// design, or number of samples on which the design depends, is another draw.
    #[test]
    fn plans_of_one_seed_draw_alike() {
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
            vec![("samples = 9", "samples = 90")],
            vec![("500.0", "700.0"), ("duration_s = 1.0", "duration_s = 2.0")],
            vec![("std = 0.05", "std = 0.06")],
            vec![("\"normal\"\nstd = 0.05", "\"uniform\"\nhalf_width = 0.05")],
            vec![("velocity_rad_s.x", "velocity_rad_s.z")],
        ] {
            assert!(draw_alike(&first, &plan(&alike)), "{alike:?}");
        }
        for other in [vec![("seed = 1", "seed = 2")], vec![latin]] {
            assert!(!draw_alike(&first, &plan(&other)), "{other:?}");
        }
        let more = ("samples = 9", "samples = 90");
        assert!(draw_alike(&plan(&[latin]), &plan(&[latin])) && !draw_alike(&plan(&[latin]), &plan(&[latin, more])));
        let none = |change: (&str, &str)| {
            let text = TEXT[..TEXT.find("[[disperse]]").expect("a table")].replace(change.0, change.1);
            Plan::from_text("small.toml", &text, Overrides::default()).expect("a plan")
        };
        assert!(
            draw_alike(&none(("500.0", "500.0")), &none(("500.0", "700.0"))) && !draw_alike(&none(("", "")), &first)
        );
    }
}
