//! Campaign files: the shipped ones, defaults, and the plan as text.

use crate::prelude::*;
use spindrift::campaign::Retention;

#[test]
fn shipped_campaigns_are_valid_and_say_what_they_ask() {
    let files = files();
    assert!(files.len() >= 5);
    for file in files {
        let plan = Plan::load(&file, Overrides::default()).unwrap();
        assert!(Scene::resolve(&plan.nominal).is_ok());
        assert_eq!(file.file_stem().and_then(|stem| stem.to_str()), Some(plan.name.as_str()));
        let text = std::fs::read_to_string(&file).unwrap();
        for word in ["# Question: ", "\n# Source: ", "\n# Expect: "] {
            assert!(text.contains(word), "{} says {word}", file.display());
        }
    }
}

/// Law: what the header of `net_launch.toml` promises is a requirement with that limit.
#[test]
fn a_launch_is_judged_by_what_its_file_promises() {
    let text = campaign_text("net_launch");
    let header = text.split("\n\n").next().unwrap().replace("\n#  ", "");
    let plan = planned(&text);
    let degree = std::f64::consts::PI / 180.0;
    for (said, column, limit) in [
        ("a lateral velocity below 5 cm/s", "relative_speed_launch_m_s", 0.05),
        ("pointing within 2 deg", "pointing_error_launch_rad", 2.0 * degree),
        ("a rate below 0.2 deg/s", "body_rate_launch_rad_s", 0.2 * degree),
        ("an offset from the line below 1.5 m", "axis_offset_launch_m", 1.5),
    ] {
        assert_says(&header, [said]);
        let observed = format!("observable = \"{column}\"\n");
        let text = plan.text();
        let of_column = text.split("[[require]]\n").filter(|one| one.starts_with(&observed));
        let limits: Vec<f64> = of_column.map(at_most).collect();
        assert!(matches!(limits[..], [found] if (found - limit).abs() < 1e-12 * limit), "{column}: {limits:?}");
    }
}

fn at_most(requirement: &str) -> f64 {
    let line = requirement.lines().find_map(|line| line.strip_prefix("at_most = ")).unwrap();
    line.trim_matches('"').parse().unwrap()
}

#[test]
fn a_plan_reads_back_from_its_text() {
    for file in files() {
        let plan = Plan::load(&file, Overrides { samples: Some(17), seed: Some(5), ..Overrides::default() }).unwrap();
        let folder = file.parent().unwrap();
        let again = Plan::from_text_in(folder, "plan.toml", &plan.text(), Overrides::default()).unwrap();
        assert_eq!(again, plan);
        assert_eq!((again.text(), again.hash()), (plan.text(), plan.hash()));
    }
}

#[test]
fn numbers_are_what_they_are_and_not_how_they_are_written() {
    let plan = |from: &str, to: &str| {
        assert!(EVERY_TABLE.contains(from), "{from}");
        planned(&EVERY_TABLE.replacen(from, to, 1))
    };
    let hash = plan("[campaign]", "[campaign]").hash();
    let (thickness, position) = ("wall_thickness_m = 0.03", "position_m = [0, 0, 1.5]");
    assert_ne!(plan(thickness, "wall_thickness_m = 0.030000000000000002").hash(), hash);
    assert_ne!(plan(position, "position_m = [0, -0.0, 1.5]").hash(), hash);
    assert_eq!(plan("samples = 10", "samples = 0xa").hash(), hash);
    assert_eq!(plan(position, "position_m = [0.0, 0e7, 15e-1] # the same").hash(), hash);
}

#[test]
fn omitted_keys_have_defaults() {
    let text = "[campaign]\nname = \"small\"\nsamples = 1\nseed = 0\nduration_s = 2\n[body]\nmass_kg = 10\n\
                inertia_kg_m2 = [[3, 0, 0], [0, 3, 0], [0, 0, 2]]\n[initial]\nangular_velocity_rad_s = [0, 0, 1]\n";
    let plan = planned(text);
    assert_eq!((plan.method, plan.grid.points(), plan.grid.duration()), (Method::Auto, 101, 2.0));
    assert_eq!(plan.groups, Group::DEFAULT);
    assert_eq!(plan.nominal.initial.attitude, [1.0, 0.0, 0.0, 0.0]);
    let scene = &plan.nominal;
    assert!(scene.wheels.is_empty() && scene.thrusters.is_empty() && scene.parts.is_empty() && scene.debris.is_none());
    assert_eq!((scene.body.center_of_mass_m, scene.body.includes_wheels), (None, false));
    let mass = resolved(scene).mass;
    assert_eq!((mass.total, mass.center), (10.0, [0.0; 3]));
    assert!(plan.dispersions.columns().is_empty());
    assert_eq!((plan.band_points, &plan.retention), (33, &Retention::None));
    let few = parsed(&format!("{text}[observe]\npoints = 5\n"));
    assert_eq!(few.unwrap().band_points, 5, "no more than the grid has");
}
