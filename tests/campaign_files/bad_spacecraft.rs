//! Spacecraft that cannot be: each bad file is refused once, with line, key, value, what is allowed and a remedy.
//!
//! The cases are in `bad_actuators.rs` and `bad_bodies.rs`.

use spindrift::campaign::{CampaignError, Overrides, Plan};

/// Given by mass and tensor, with two wheels and two thrusters; each case changes some of its lines.
pub const DIRECT: &str = r#"[campaign]
name = "bad"
samples = 10
seed = 1
duration_s = 10.0
[body]
mass_kg = 500.0
center_of_mass_m = [0, 0, 0.5]
inertia_kg_m2 = [[120, -3, 1], [-3, 150, 2], [1, 2, 90]]
includes_wheels = true
[[wheels]]
name = "w1"
axis = [0, 1, 0]
position_m = [0, 0, 1]
mass_kg = 5.0
axial_inertia_kg_m2 = 0.02
transverse_inertia_kg_m2 = 0.0125
rate_rad_s = 300.0
[[wheels]]
name = "w2"
axis = [1, 1, 1]
radius_m = 0.2
length_m = 0.05
density_kg_m3 = 2700.0
[[thrusters]]
name = "p1"
position_m = [0, 0, -1]
direction = [0, 0, 1]
[[thrusters]]
name = "p2"
position_m = [0, 0, 1]
direction = [0, 0, -1]
[initial]
angular_velocity_rad_s = [0, 0, 1]
[[actuation]]
start_s = 0.0
end_s = 3.0
thrust_n = { p1 = 10.0 }
torque_n_m = { w1 = 0.1 }
"#;

/// Given by parts.
pub const PARTS: &str = r#"[campaign]
name = "bad"
samples = 10
seed = 1
duration_s = 10.0
[[body.parts]]
name = "tank"
shape = "hollow_cylinder"
outer_radius_m = 1.0
wall_thickness_m = 0.03
length_m = 3.0
density_kg_m3 = 2700.0
[[body.parts]]
name = "panel"
shape = "box"
size_m = [2, 1, 0.01]
mass_kg = 9.0
position_m = [0, 2, 0]
[[body.parts]]
name = "tip"
shape = "point_mass"
mass_kg = 1.0
[initial]
angular_velocity_rad_s = [0, 0, 1]
"#;

fn wheels(count: usize) -> String {
    let wheel = |k| {
        format!(
            "[[wheels]]\nname = \"a{k}\"\naxis = [0, 0, 1]\nradius_m = 0.01\nlength_m = 0.01\ndensity_kg_m3 = 100\n"
        )
    };
    (0..count).map(wheel).collect()
}

fn thrusters(count: usize) -> String {
    let thruster = |k| format!("[[thrusters]]\nname = \"a{k}\"\nposition_m = [0, 0, 0]\ndirection = [0, 0, 1]\n");
    (0..count).map(thruster).collect()
}

fn points(count: usize) -> String {
    let point = |k| format!("[[body.parts]]\nname = \"a{k}\"\nshape = \"point_mass\"\nmass_kg = 1\n");
    (0..count).map(point).collect()
}

fn refused(text: &str) -> CampaignError {
    match Plan::from_text("bad.toml", text, Overrides::default()) {
        Ok(_) => panic!("accepted:\n{text}"),
        Err(error) => error,
    }
}

/// What is changed, to what; line, key and value of the one problem (no value: the key is missing), and parts of "must be" and remedy.
pub type Case = (&'static str, &'static str, usize, &'static str, Option<&'static str>, &'static str, &'static str);

/// Law: every bad file, made of `base` by a case, is refused with one problem, at its line, with its key, its value, what is allowed and a
/// remedy.
pub fn assert_each_refused(base: &str, cases: &[Case]) {
    let mut wrong = Vec::new();
    if let Err(error) = Plan::from_text("bad.toml", base, Overrides::default()) {
        panic!("the file that is changed is good: {error}");
    }
    for &(from, to, line, key, value, allowed, remedy) in cases {
        assert!(base.contains(from), "{from}");
        let error = refused(&base.replacen(from, to, 1));
        let problem = &error.problems[0];
        // a value that follows from others is not quoted from the file
        let is_value = value.is_none_or(|value| problem.value.as_deref() == Some(value));
        let is_missing = !to.is_empty() || problem.value.is_none();
        let passed = error.problems.len() == 1
            && problem.line == Some(line)
            && problem.key == key
            && is_value
            && is_missing
            && problem.allowed.contains(allowed)
            && problem.remedy.contains(remedy);
        if !passed {
            wrong.push(format!(
                "{to:?}\n  expected line {line}: {key} = {value:?}: {allowed}; {remedy}\n  said     {error}"
            ));
        }
    }
    assert!(wrong.is_empty(), "{} wrong:\n{}", wrong.len(), wrong.join("\n"));
}

/// Law: a spacecraft has at most 8 wheels, 16 thrusters and 32 parts; the largest number of each is accepted.
#[test]
fn too_many_wheels_thrusters_and_parts_are_refused() {
    let with_wheels = |count| DIRECT.replacen("[initial]", &format!("{}[initial]", wheels(count)), 1);
    let with_thrusters = |count| DIRECT.replacen("[initial]", &format!("{}[initial]", thrusters(count)), 1);
    let with_parts = |count| PARTS.replacen("[initial]", &format!("{}[initial]", points(count)), 1);
    for (good, bad, key, value, allowed) in [
        (with_wheels(6), with_wheels(7), "wheels", "9 tables", "at most 8 tables"),
        (with_thrusters(14), with_thrusters(15), "thrusters", "17 tables", "at most 16 tables"),
        (with_parts(29), with_parts(30), "body.parts", "33 tables", "at most 32 tables"),
    ] {
        if let Err(error) = Plan::from_text("bad.toml", &good, Overrides::default()) {
            panic!("{key}: {error}");
        }
        let error = refused(&bad);
        assert_eq!(error.problems.len(), 1, "{error}");
        let problem = &error.problems[0];
        assert_eq!(
            (problem.key.as_str(), problem.value.as_deref(), problem.allowed.as_str()),
            (key, Some(value), allowed)
        );
        assert!(problem.line.is_some() && problem.remedy == "delete some of them", "{problem}");
    }
}

/// A file without a body asks for one.
#[test]
fn a_spacecraft_without_a_body_is_refused() {
    let start = PARTS.find("[[body.parts]]").expect("parts");
    let end = PARTS.find("[initial]").expect("the state");
    let mut text = PARTS.to_owned();
    text.replace_range(start..end, "");
    let error = refused(&text);
    assert_eq!(error.problems.len(), 1, "{error}");
    assert_eq!(
        error.to_string(),
        "bad.toml: body is missing: must be a table with the mass properties of the body, or its parts; add a [body] table, or [[body.parts]] tables"
    );
}
