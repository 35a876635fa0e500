use crate::prelude::*;
use spindrift::campaign::Problem;

use crate::{loops::LOOP, spacecraft::NEWCOMER, support::campaigns::DEBRIS};

const CASES: &str = include_str!("refusals.txt");

const HEAD: &str = r#"[campaign]
name = "bad"
samples = 10
seed = 1
duration_s = 10.0
[integrator]
method = "dormand_prince"
tolerance = 1e-10
[observe]
points = 11
"#;

const REST: &str = r#"[initial]
attitude = [1, 0, 0, 0]
angular_velocity_rad_s = [0, 3, 31]
[[thrusters]]
name = "p1"
position_m = [0, 0, 0]
direction = [0, 0, 1]
[[actuation]]
start_s = 0.0
end_s = 3.0
thrust_n = { p1 = 100 }
[[disperse]]
parameter = "body.parts.fuselage.density_kg_m3"
distribution = "truncated_normal"
relative_std = 0.02
sigmas = 3
"#;

pub fn good() -> String {
    [HEAD, FUSELAGE, WHEEL1, DEBRIS, REST].concat()
}

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

const ORBIT: &str = r#"[campaign]
name = "bad"
samples = 10
seed = 1
duration_s = 10.0
[integrator]
method = "dop853"
[body]
mass_kg = 10
inertia_kg_m2 = [[3, 0, 0], [0, 3, 0], [0, 0, 2]]
[initial]
angular_velocity_rad_s = [0, 0, 1]
[environment]
gravity_gradient = true
[orbit]
semi_major_axis_m = 7e6
"#;

fn plain() -> String {
    let head = &HEAD[..HEAD.find("[integrator]").unwrap()];
    [head, FUSELAGE, WHEEL1_AT_REST, "[initial]\nangular_velocity_rad_s = [0, 3, 31]\n"].concat()
}

fn folder() -> std::path::PathBuf {
    let folder = std::env::temp_dir().join(format!("spindrift-bad-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    for (name, text) in [
        (
            "data.csv",
            "density,name,wheels.w1.radius_m,wheels.w2.radius_m,infinite\n2600,a,0.25,0.25,1\n2700,b,0.26,0.26,inf\n",
        ),
        ("data.txt", "density\n2600\n"),
        ("empty.csv", "density\n"),
        ("ragged.csv", "density,name\n1,2,3\n"),
    ] {
        std::fs::write(folder.join(name), text).unwrap();
    }
    folder
}

#[test]
fn each_kind_of_refusal_gives_line_key_value_range_and_remedy() {
    let folder = folder();
    let read = |text: &str| Plan::from_text_in(&folder, "bad.toml", text, Overrides::default());
    let (mut base, mut count, mut wrong) = (String::new(), 0, Vec::new());
    for line in CASES.lines().filter(|line| !line.is_empty() && !line.starts_with('#')) {
        if let Some(name) = line.strip_prefix("== ") {
            let (name, more) = name.split_once(" + ").unwrap_or((name, ""));
            base = match name {
                "campaign" => good() + &more.replace("\\n", "\n"),
                "launch" => NET_LAUNCH.to_owned(),
                "direct" => DIRECT.to_owned(),
                "parts" => PARTS.to_owned(),
                "orbit" => ORBIT.to_owned(),
                "loop" => LOOP.to_owned(),
                "rods" => include_str!("rods.toml").to_owned(),
                "newcomer" => NEWCOMER.to_owned(),
                _ => plain(),
            };
            read(&base).unwrap_or_else(|error| panic!("{name}: {error}"));
            continue;
        }
        let fields: Vec<String> =
            line.split(" =>").map(|field| field.strip_prefix(' ').unwrap_or(field).replace("\\n", "\n")).collect();
        let [from, to, at, allowed, remedy] = &fields[..] else { panic!("five fields: {line}") };
        assert!(base.contains(from.as_str()), "{from}");
        let text = if from.is_empty() { format!("{base}{to}") } else { base.replacen(from.as_str(), to, 1) };
        count += 1;
        let Err(error) = read(&text) else {
            wrong.push(format!("accepted: {line}"));
            continue;
        };
        let said = error.to_string().replace(&format!("{}/", folder.display()), "");
        let at = if at.is_empty() { String::new() } else { format!("bad.toml:{at}") };
        let Problem { file, line: place, key, allowed: range, remedy: what, .. } = &error.problems[0];
        let is_told = file == "bad.toml" && place.is_some() && !key.is_empty() && !range.is_empty() && !what.is_empty();
        let fits = said.starts_with(&at) && said.contains(allowed.as_str()) && said.contains(remedy.as_str());
        if error.problems.len() != 1 || !is_told || !fits || range.starts_with("must") {
            wrong.push(format!("{line}\n  said {said}"));
        }
    }
    std::fs::remove_dir_all(&folder).unwrap();
    assert!(wrong.is_empty() && count > 150, "{} of {count} wrong:\n{}", wrong.len(), wrong.join("\n"));
}

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

#[test]
fn a_spacecraft_without_a_body_is_refused() {
    let start = PARTS.find("[[body.parts]]").unwrap();
    let end = PARTS.find("[initial]").unwrap();
    let mut text = PARTS.to_owned();
    text.replace_range(start..end, "");
    let error = refused(&text);
    assert_eq!(error.problems.len(), 1, "{error}");
    assert_eq!(
        error.to_string(),
        "bad.toml: body is missing: must be a table with the mass properties of the body, or its parts; add a [body] \
        table, or [[body.parts]] tables"
    );
}

/// Law: every list of tables that the documents show has a limit.
#[test]
fn every_list_of_tables_has_a_limit() {
    let documents = [include_str!("../../docs/campaign-files.md"), include_str!("../../docs/control.md")];
    let names = documents.iter().flat_map(|text| text.split("[[").skip(1)).filter_map(|rest| rest.split_once("]]"));
    let is_name = |name: &&str| name.chars().all(|letter| letter.is_ascii_lowercase() || letter == '.');
    let lists: std::collections::BTreeSet<&str> = names.map(|(name, _)| name).filter(is_name).collect();
    assert!(lists.len() >= 11 && lists.contains("sensors") && lists.contains("body.parts"), "{lists:?}");
    for list in lists {
        let tables = format!("[[{list}]]\n").repeat(20_000);
        let text = match list {
            "body.parts" => PARTS.replacen("[initial]", &format!("{tables}[initial]"), 1),
            "sensors" | "guidance" => format!("{DIRECT}\n[control]\nperiod_s = 0.1\n{tables}"),
            _ => format!("{DIRECT}\n{tables}"),
        };
        let error = refused(&text);
        let is_limit = |problem: &spindrift::campaign::Problem| {
            let count = problem.value.as_deref().and_then(|value| value.strip_suffix(" tables")?.parse::<usize>().ok());
            problem.key == list && count.is_some_and(|count| count >= 20_000) && problem.allowed.starts_with("at most ")
        };
        assert_eq!(error.problems.iter().any(is_limit), list != "actuation", "{list}: {error}");
        let read = error.problems.len() + error.more;
        assert!(list == "actuation" || read < 20_000, "{list}: {read} problems, so all tables were read");
    }
}
