//! [`draw_alike`]: whether two plans share random numbers.

use super::plan::Plan;

/// True if equal samples of two plans share random numbers: seed and design are equal, and so is a dispersed dimension,
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

    const DRAWN: &str = include_str!("../../../../campaigns/single_wheel.toml");
    const NOMINAL: &str = include_str!("../../../../campaigns/published_rigid_body.toml");

    /// Law: plans draw alike if seed, design and one dimension are equal, whatever the distributions; another seed or
    /// design, or number of samples on which the design depends, is another draw.
    #[test]
    fn plans_of_one_seed_draw_alike() {
        let plan = |text: &str, settings: &[(&str, &str)]| {
            let settings = settings.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect();
            Plan::from_text("small.toml", text, Overrides::<()> { settings, ..Overrides::default() }).expect("a plan")
        };
        let drawn = |settings: &[(&str, &str)]| plan(DRAWN, settings);
        let (first, more, latin) = (drawn(&[]), ("campaign.samples", "9"), ("design.kind", "latin_hypercube"));
        for alike in [
            vec![],
            vec![("wheels.bias.radius_m", "0.2")],
            vec![more],
            vec![("body.mass_kg", "700.0"), ("campaign.duration_s", "2.0")],
            vec![("disperse[0].std", "0.06")],
            vec![("disperse[1].distribution", "truncated_normal"), ("disperse[1].sigmas", "3")],
            vec![("disperse[0].parameter", "initial.angular_velocity_rad_s.z")],
        ] {
            assert!(draw_alike(&first, &drawn(&alike)), "{alike:?}");
        }
        for other in [("campaign.seed", "2"), latin] {
            assert!(!draw_alike(&first, &drawn(&[other])), "{other:?}");
        }
        assert!(draw_alike(&drawn(&[latin]), &drawn(&[latin])));
        assert!(!draw_alike(&drawn(&[latin]), &drawn(&[latin, more])));
        let none = plan(NOMINAL, &[("campaign.seed", "20260108")]);
        let heavier = plan(NOMINAL, &[("campaign.seed", "20260108"), ("body.mass_kg", "2.0")]);
        assert!(draw_alike(&none, &heavier) && !draw_alike(&none, &first));
    }
}
