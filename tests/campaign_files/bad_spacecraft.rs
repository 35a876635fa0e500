//! Spacecraft that cannot be: each bad file is refused once, with line, key, value, what is allowed and a remedy.

use spindrift::campaign::{CampaignError, Overrides, Plan};

/// Given by mass and tensor, with two wheels and two thrusters; each case changes some of its lines.
const DIRECT: &str = r#"[campaign]
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
const PARTS: &str = r#"[campaign]
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
type Case = (&'static str, &'static str, usize, &'static str, Option<&'static str>, &'static str, &'static str);

const OF_DIRECT: &[Case] = &[
    // axes and directions
    (
        "axis = [0, 1, 0]",
        "axis = [0, 0, 0]",
        13,
        "wheels.w1.axis",
        Some("[0.0, 0.0, 0.0]"),
        "a direction",
        "write an axis such as [0, 0, 1]",
    ),
    (
        "axis = [0, 1, 0]",
        "axis = [0, 1e-200, 0]",
        13,
        "wheels.w1.axis",
        Some("[0.0, 1e-200, 0.0]"),
        "between 1e-150 and 1e150",
        "write an axis",
    ),
    (
        "axis = [0, 1, 0]",
        "axis = [0, 1e200, 0]",
        13,
        "wheels.w1.axis",
        Some("[0.0, 1e200, 0.0]"),
        "between 1e-150 and 1e150",
        "write an axis",
    ),
    (
        "axis = [0, 1, 0]",
        "axis = [0, 1]",
        13,
        "wheels.w1.axis",
        Some("[0, 1]"),
        "an array of 3 finite numbers",
        "write it like [0, 0, 0]",
    ),
    (
        "axis = [0, 1, 0]\n",
        "",
        11,
        "wheels.w1.axis",
        None,
        "an array of 3 finite numbers",
        "add axis = [0, 0, 1] to the table [[wheels]] with name = \"w1\"",
    ),
    ("axis = [0, 1, 0]", "axis = \"s2\"", 13, "wheels.w1.axis", Some("\"s2\""), "a finite number", "write a number"),
    (
        "direction = [0, 0, 1]",
        "direction = [0, 0, 0]",
        28,
        "thrusters.p1.direction",
        Some("[0.0, 0.0, 0.0]"),
        "not all zero",
        "write an axis",
    ),
    (
        "direction = [0, 0, 1]\n",
        "",
        25,
        "thrusters.p1.direction",
        None,
        "an array of 3 finite numbers",
        "add direction = [0, 0, 1] to the table [[thrusters]] with name = \"p1\"",
    ),
    (
        "position_m = [0, 0, -1]\n",
        "",
        25,
        "thrusters.p1.position_m",
        None,
        "an array of 3 finite numbers",
        "add position_m = [0, 0, 0]",
    ),
    (
        "position_m = [0, 0, -1]",
        "position_m = [0, 0, inf]",
        27,
        "thrusters.p1.position_m",
        Some("[0, 0, inf]"),
        "finite",
        "write it like",
    ),
    // names
    (
        "name = \"w2\"",
        "name = \"w1\"",
        20,
        "wheels[1].name",
        Some("\"w1\""),
        "another name than that of the other [[wheels]] tables",
        "give each its own name",
    ),
    (
        "name = \"p2\"",
        "name = \"p1\"",
        30,
        "thrusters[1].name",
        Some("\"p1\""),
        "another name than that of the other [[thrusters]] tables",
        "give each its own name",
    ),
    (
        "name = \"w2\"\n",
        "",
        19,
        "wheels[1].name",
        None,
        "a name of at most 23 small letters",
        "add name = \"a1\" to this table",
    ),
    (
        "name = \"w2\"",
        "name = \"Wheel 2\"",
        20,
        "wheels[1].name",
        Some("\"Wheel 2\""),
        "small letters, digits and underscores",
        "write a name such as \"w1\"",
    ),
    ("name = \"w2\"", "name = 2", 20, "wheels[1].name", Some("2"), "text", "write it in quotes"),
    // mass and inertia of a wheel
    (
        "mass_kg = 5.0\n",
        "",
        11,
        "wheels.w1.mass_kg",
        None,
        "a finite number",
        "add mass_kg = 5.0 to the table [[wheels]] with name = \"w1\"",
    ),
    (
        "axial_inertia_kg_m2 = 0.02\n",
        "",
        11,
        "wheels.w1.axial_inertia_kg_m2",
        None,
        "a finite number",
        "add axial_inertia_kg_m2",
    ),
    (
        "transverse_inertia_kg_m2 = 0.0125\n",
        "",
        11,
        "wheels.w1.transverse_inertia_kg_m2",
        None,
        "a finite number",
        "add transverse_inertia_kg_m2",
    ),
    (
        "mass_kg = 5.0",
        "mass_kg = 5.0\nradius_m = 0.1",
        16,
        "wheels.w1.radius_m",
        Some("0.1"),
        "left out where the wheel is given by mass and inertias",
        "delete this line",
    ),
    (
        "mass_kg = 5.0",
        "mass_kg = 5.0\ndensity_kg_m3 = 2700",
        16,
        "wheels.w1.density_kg_m3",
        Some("2700"),
        "left out where the wheel is given by mass",
        "delete this line",
    ),
    ("mass_kg = 5.0", "mass_kg = -5.0", 15, "wheels.w1.mass_kg", Some("-5.0"), "above zero", "write a positive number"),
    (
        "axial_inertia_kg_m2 = 0.02",
        "axial_inertia_kg_m2 = 0.03",
        16,
        "wheels.w1.axial_inertia_kg_m2",
        Some("0.03"),
        "at most twice transverse_inertia_kg_m2 = 0.0125",
        "a thin disk has twice",
    ),
    (
        "transverse_inertia_kg_m2 = 0.0125",
        "transverse_inertia_kg_m2 = 0",
        17,
        "wheels.w1.transverse_inertia_kg_m2",
        Some("0.0"),
        "above zero",
        "write a positive number",
    ),
    (
        "radius_m = 0.2\n",
        "",
        19,
        "wheels.w2.radius_m",
        None,
        "a finite number",
        "add radius_m = 0.25 to the table [[wheels]] with name = \"w2\"",
    ),
    (
        "density_kg_m3 = 2700.0\n",
        "",
        19,
        "wheels.w2.density_kg_m3",
        None,
        "a finite number",
        "add density_kg_m3 = 2700.0",
    ),
    ("length_m = 0.05", "length_m = 0", 23, "wheels.w2.length_m", Some("0.0"), "above zero", "write a positive number"),
    (
        "length_m = 0.05",
        "lenght_m = 0.05\nlength_m = 0.05",
        23,
        "wheels.w2.lenght_m",
        Some("0.05"),
        "a key of [[wheels]] with name = \"w2\"",
        "did you mean length_m?",
    ),
    (
        "length_m = 0.05",
        "station_m = 1.0\nlength_m = 0.05",
        23,
        "wheels.w2.station_m",
        Some("1.0"),
        "a key of [[wheels]] with name = \"w2\"",
        "delete it",
    ),
    // mode
    (
        "rate_rad_s = 300.0",
        "mode = \"held\"",
        18,
        "wheels.w1.mode",
        Some("\"held\""),
        "one of free, speed_held, locked",
        "did you mean \"speed_held\"?",
    ),
    (
        "density_kg_m3 = 2700.0",
        "density_kg_m3 = 2700.0\nmode = \"locked\"\nrate_rad_s = 1.0",
        26,
        "wheels.w2.rate_rad_s",
        Some("1.0"),
        "left out (or 0) where mode is \"locked\"",
        "delete it, or choose another mode",
    ),
    (
        "rate_rad_s = 300.0",
        "mode = \"locked\"",
        39,
        "actuation[0].torque_n_m.w1",
        Some("0.1"),
        "zero for w1, which is locked",
        "set the wheel's mode to \"free\"",
    ),
    (
        "rate_rad_s = 300.0",
        "mode = \"speed_held\"",
        39,
        "actuation[0].torque_n_m.w1",
        Some("0.1"),
        "zero for w1, whose speed its motor holds",
        "leave that torque out",
    ),
    (
        "rate_rad_s = 300.0",
        "rate_rad_s = nan",
        18,
        "wheels.w1.rate_rad_s",
        Some("nan"),
        "a finite number",
        "write a number",
    ),
    (
        "rate_rad_s = 300.0",
        "rate_rad_s = [300, 0]",
        18,
        "wheels.w1.rate_rad_s",
        Some("[300, 0]"),
        "a finite number",
        "write one number, without brackets",
    ),
    (
        "rate_rad_s = 300.0",
        "tilt_rad = 0.1",
        18,
        "wheels.w1.tilt_rad",
        Some("0.1"),
        "an array of 2 finite numbers",
        "write it like [0, 0]",
    ),
    // schedules by name
    (
        "p1 = 10.0",
        "p1 = -10.0",
        38,
        "actuation[0].thrust_n.p1",
        Some("-10.0"),
        "zero or above: a thruster does not pull",
        "use the opposite thruster",
    ),
    (
        "p1 = 10.0",
        "p3 = 10.0",
        38,
        "actuation[0].thrust_n.p3",
        Some("10.0"),
        "a key of [actuation[0].thrust_n] (p1, p2)",
        "did you mean p1?",
    ),
    (
        "p1 = 10.0",
        "w1 = 10.0",
        38,
        "actuation[0].thrust_n.w1",
        Some("10.0"),
        "a key of [actuation[0].thrust_n] (p1, p2)",
        "did you mean p1?",
    ),
    (
        "w1 = 0.1",
        "w3 = 0.1",
        39,
        "actuation[0].torque_n_m.w3",
        Some("0.1"),
        "a key of [actuation[0].torque_n_m] (w1, w2)",
        "did you mean w1?",
    ),
    (
        "{ p1 = 10.0 }",
        "[10.0, 0.0]",
        38,
        "actuation[0].thrust_n",
        Some("[10.0, 0.0]"),
        "a table of numbers by the names of [[thrusters]]",
        "write thrust_n = { p1 = 0.0, p2 = 0.0 }",
    ),
    (
        "{ w1 = 0.1 }",
        "0.1",
        39,
        "actuation[0].torque_n_m",
        Some("0.1"),
        "a table of numbers by the names of [[wheels]]",
        "write torque_n_m = { w1 = 0.0, w2 = 0.0 }",
    ),
    (
        "p1 = 10.0",
        "p1 = \"10 kg\"",
        38,
        "actuation[0].thrust_n.p1",
        Some("\"10 kg\""),
        "N, mN, kN",
        "kg is the unit of other quantities",
    ),
    ("w1 = 0.1", "w1 = inf", 39, "actuation[0].torque_n_m.w1", Some("inf"), "a finite number", "write a number"),
    (
        "direction = [0, 0, 1]",
        "direction = [0, 0, 1]\nthrust_scale = -1",
        29,
        "thrusters.p1.thrust_scale",
        Some("-1.0"),
        "does not pull",
        "write zero for a thruster that does not work",
    ),
    // the body as a whole
    (
        "includes_wheels = true\n",
        "",
        6,
        "body.includes_wheels",
        None,
        "true or false: whether mass, centre and inertia of the body are those with the wheels",
        "add includes_wheels = false to [body]",
    ),
    (
        "includes_wheels = true",
        "includes_wheels = \"yes\"",
        10,
        "body.includes_wheels",
        Some("\"yes\""),
        "true or false",
        "write it without quotes",
    ),
    (
        "mass_kg = 500.0\n",
        "",
        6,
        "body.mass_kg",
        None,
        "or describe the body by [[body.parts]]",
        "add mass_kg = 500.0 to [body]",
    ),
    (
        "inertia_kg_m2 = [[120, -3, 1], [-3, 150, 2], [1, 2, 90]]\n",
        "",
        6,
        "body.inertia_kg_m2",
        None,
        "given (or principal_moments_kg_m2",
        "add inertia_kg_m2 = [[100, 0, 0], [0, 120, 0], [0, 0, 80]] to [body]",
    ),
    (
        "inertia_kg_m2 = [[120, -3, 1]",
        "inertia_kg_m2 = [[120, -4, 1]",
        9,
        "body.inertia_kg_m2",
        Some("[[120.0, -4.0, 1.0], [-3.0, 150.0, 2.0], [1.0, 2.0, 90.0]]"),
        "symmetric",
        "equal on both sides of the diagonal",
    ),
    (
        "inertia_kg_m2 = [[120, ",
        "inertia_kg_m2 = [[20, ",
        9,
        "body.inertia_kg_m2",
        Some("[[20.0, -3.0, 1.0], [-3.0, 150.0, 2.0], [1.0, 2.0, 90.0]]"),
        "no principal moment exceeds the sum of the other two",
        "check units and the point they refer to",
    ),
    (
        "[1, 2, 90]]",
        "[1, 2, 90]]\nprincipal_moments_kg_m2 = [100, 120, 90]",
        9,
        "body.inertia_kg_m2",
        Some("[[120, -3, 1], [-3, 150, 2], [1, 2, 90]]"),
        "left out where principal_moments_kg_m2 is given",
        "delete one of the two",
    ),
    (
        "[1, 2, 90]]",
        "[1, 2, 90]]\nprincipal_axes = [1, 0, 0, 0]",
        10,
        "body.principal_axes",
        Some("[1, 0, 0, 0]"),
        "left out where there are no principal moments",
        "add principal_moments_kg_m2",
    ),
    (
        "mass_kg = 500.0",
        "mass_kg = 10.0",
        7,
        "body.mass_kg",
        None,
        "the body without its wheels has a mass above zero",
        "or set body.includes_wheels = false",
    ),
    (
        "axial_inertia_kg_m2 = 0.02\ntransverse_inertia_kg_m2 = 0.0125",
        "axial_inertia_kg_m2 = 200\ntransverse_inertia_kg_m2 = 125",
        9,
        "body.inertia_kg_m2",
        None,
        "what is left without the wheels is the inertia of a body",
        "or set body.includes_wheels = false",
    ),
    (
        "mass_kg = 500.0",
        "density_kg_m3 = 2700.0\nmass_kg = 500.0",
        7,
        "body.density_kg_m3",
        Some("2700.0"),
        "a key of [body]",
        "delete it",
    ),
    (
        "mass_kg = 500.0",
        "mass_kg = \"500 lb\"",
        7,
        "body.mass_kg",
        Some("\"500 lb\""),
        "kg, g, t",
        "is no unit that is known here",
    ),
];

const OF_PARTS: &[Case] = &[
    (
        "density_kg_m3 = 2700.0",
        "density_kg_m3 = 2700.0\nmass_kg = 9.0",
        12,
        "body.parts.tank.density_kg_m3",
        Some("2700.0"),
        "left out where mass_kg is given",
        "delete one of the two",
    ),
    (
        "density_kg_m3 = 2700.0\n",
        "",
        6,
        "body.parts.tank.density_kg_m3",
        None,
        "given (or mass_kg)",
        "add density_kg_m3 = 2700.0 to the table [[body.parts]] with name = \"tank\"",
    ),
    (
        "outer_radius_m = 1.0",
        "radius_m = 1.0\nouter_radius_m = 1.0",
        9,
        "body.parts.tank.radius_m",
        Some("1.0"),
        "left out: a hollow_cylinder has outer_radius_m, wall_thickness_m, length_m",
        "delete this line, or change the shape",
    ),
    (
        "size_m = [2, 1, 0.01]",
        "size_m = [2, 1, 0.01]\nlength_m = 2",
        17,
        "body.parts.panel.length_m",
        Some("2"),
        "left out: a box has size_m",
        "delete this line, or change the shape",
    ),
    (
        "size_m = [2, 1, 0.01]\n",
        "",
        13,
        "body.parts.panel.size_m",
        None,
        "given",
        "add size_m = [1.0, 1.0, 1.0] to the table [[body.parts]] with name = \"panel\"",
    ),
    (
        "size_m = [2, 1, 0.01]",
        "size_m = [2, 1]",
        16,
        "body.parts.panel.size_m",
        Some("[2, 1]"),
        "an array of 3 finite numbers",
        "write it like [0, 0, 0]",
    ),
    (
        "size_m = [2, 1, 0.01]",
        "size_m = [2, 1, 0]",
        16,
        "body.parts.panel.size_m",
        Some("[2.0, 1.0, 0.0]"),
        "above zero, each",
        "write positive numbers",
    ),
    (
        "shape = \"box\"",
        "shape = \"cube\"",
        15,
        "body.parts.panel.shape",
        Some("\"cube\""),
        "one of hollow_cylinder, solid_cylinder, box, sphere, point_mass",
        "choose one of these",
    ),
    (
        "shape = \"box\"\n",
        "",
        13,
        "body.parts.panel.shape",
        None,
        "one of hollow_cylinder, solid_cylinder, box, sphere, point_mass",
        "add shape = \"box\"",
    ),
    (
        "name = \"tip\"",
        "name = \"tank\"",
        20,
        "body.parts[2].name",
        Some("\"tank\""),
        "another name than that of the other [[body.parts]] tables",
        "give each its own name",
    ),
    (
        "shape = \"point_mass\"\nmass_kg = 1.0",
        "shape = \"point_mass\"\nmass_kg = 1.0\ndensity_kg_m3 = 1.0",
        23,
        "body.parts.tip.density_kg_m3",
        Some("1.0"),
        "left out: a point has no volume",
        "write mass_kg",
    ),
    (
        "shape = \"point_mass\"\nmass_kg = 1.0\n",
        "shape = \"point_mass\"\n",
        19,
        "body.parts.tip.mass_kg",
        None,
        "a finite number",
        "add mass_kg = 10.0 to the table [[body.parts]] with name = \"tip\"",
    ),
    (
        "shape = \"point_mass\"\n",
        "shape = \"point_mass\"\nradius_m = 1.0\n",
        22,
        "body.parts.tip.radius_m",
        Some("1.0"),
        "left out: a point_mass has no size",
        "delete this line, or change the shape",
    ),
    (
        "wall_thickness_m = 0.03",
        "wall_thickness_m = 1.0",
        10,
        "body.parts.tank.wall_thickness_m",
        Some("1.0"),
        "below outer_radius_m = 1.0",
        "make the wall thinner or the radius larger",
    ),
    (
        "position_m = [0, 2, 0]",
        "attitude = [1, 1, 0, 0]",
        18,
        "body.parts.panel.attitude",
        Some("[1.0, 1.0, 0.0, 0.0]"),
        "a quaternion of norm 1",
        "divide the four numbers by the norm",
    ),
    (
        "[initial]",
        "[body]\nincludes_wheels = true\n[initial]",
        24,
        "body.includes_wheels",
        Some("true"),
        "false, or left out, where the body has parts",
        "delete this line",
    ),
    (
        "mass_kg = 9.0",
        "mass_kg = 9.0\nmass_scale = 0",
        18,
        "body.parts.panel.mass_scale",
        Some("0.0"),
        "above zero",
        "write a positive number",
    ),
];

/// Law: every bad file is refused with one problem, at its line, with its key, its value, what is allowed and a remedy.
#[test]
fn every_impossible_spacecraft_is_refused_with_line_value_and_remedy() {
    assert!(OF_DIRECT.len() + OF_PARTS.len() >= 60, "{}", OF_DIRECT.len() + OF_PARTS.len());
    let mut wrong = Vec::new();
    for (base, cases) in [(DIRECT, OF_DIRECT), (PARTS, OF_PARTS)] {
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
