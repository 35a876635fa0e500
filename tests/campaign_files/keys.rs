//! Each key of a file changes the plan, reads back, and changes the hash of the rows exactly where it changes rows. A
//! key that no file here has fails the tests.

use crate::prelude::*;

use spindrift::campaign::parameter::lacking;
use spindrift::scene::parameter::Shape;
use toml::Value;

use crate::support::every_key::every_loop;

const NOTHING: &str = "qqzzqqzz";

/// For any key that takes text: the first that is accepted is the change.
const TEXTS: [&str; 35] = [
    "s3",
    "fast",
    "max",
    "taylor",
    "gauss_legendre_6",
    "numerics",
    "lz4",
    "none",
    "W",
    "3 * energy_error_max",
    "steps",
    "angular_momentum_error_max",
    "all",
    "free",
    "wheels.w1.length_m",
    "body.parts.tank.mass_kg",
    "wheels.w1.radius_m / 3",
    "body.parts.tank.radius_m",
    "What else?",
    "other.csv",
    "b",
    "linear",
    "initial.velocity_m_s.y",
    "initial.velocity_m_s.z",
    "initial.velocity_m_s",
    "initial.debris_attitude",
    "thrusters.p2.direction",
    "energy_w1_j",
    "initial.position_m.y",
    "2 * wheels.w1.radius_m - 0.5",
    "sample:3",
    "body.parts.fuselage.length_m",
    "3 * angular_rate_rad_s",
    "rising",
    "first",
];

fn folder(name: &str) -> ScratchFolder {
    let scratch = ScratchFolder::new(name);
    scratch.file("data.csv", "a,b\n0.21,0.11\n0.24,0.12\n0.27,0.14\n");
    scratch.file("other.csv", "a,b\n0.21,0.11\n0.24,0.12\n0.28,0.14\n");
    scratch
}

fn read(folder: &Path, text: &str) -> Result<Plan, CampaignError> {
    Plan::from_text_in(folder, "keys.toml", text, Overrides::default())
}

fn reads_back(folder: &Path, plan: &Plan, what: &str) {
    let again = read(folder, &plan.text()).unwrap_or_else(|error| panic!("{what}: {error}"));
    assert!(again == *plan && again.text() == plan.text(), "{what} does not read back:\n{}", plan.text());
}

fn others(value: &Value) -> Vec<Value> {
    match value {
        Value::Integer(x) => [x + 1, x - 1, x + 2, x + 8].map(Value::Integer).to_vec(),
        Value::Float(x) if *x == 0.0 => vec![Value::Float(0.015625)],
        Value::Float(x) => [1.0625 * x, 0.9375 * x].map(Value::Float).to_vec(),
        Value::Boolean(x) => vec![Value::Boolean(!x)],
        Value::String(text) => {
            TEXTS.iter().filter(|other| *other != text).map(|text| Value::String((*text).to_owned())).collect()
        }
        Value::Array(list) => {
            let with = |index: usize, other: Value| {
                let mut list = list.clone();
                list[index] = other;
                Value::Array(list)
            };
            let with = &with;
            let changed =
                (0..list.len()).flat_map(|index| others(&list[index]).into_iter().map(move |other| with(index, other)));
            let longer = TEXTS
                .iter()
                .filter(|_| list.iter().all(Value::is_str))
                .map(|text| Value::Array(list.iter().cloned().chain([Value::String((*text).to_owned())]).collect()));
            changed.chain(longer).collect()
        }
        Value::Table(table) => {
            let with = |key: &String, other: Value| {
                let mut table = table.clone();
                table.insert(key.clone(), other);
                Value::Table(table)
            };
            let keys = table.iter().filter(|(key, _)| *key != "distribution");
            keys.flat_map(|(key, value)| others(value).into_iter().map(move |other| with(key, other))).collect()
        }
        Value::Datetime(_) => Vec::new(),
    }
}

/// A key of a file: the header and kind of its table, its name, and files with other values of it.
struct Change {
    header: String,
    kind: String,
    key: String,
    texts: Vec<String>,
}

/// The distribution or design of the table that starts `text`; empty for one without kinds.
fn kind(text: &str) -> String {
    let mut lines = text.lines().skip(1).take_while(|line| !line.starts_with('['));
    let line = lines.find(|line| line.starts_with("distribution = ") || line.starts_with("kind = "));
    line.unwrap_or_default().to_owned()
}

fn changes(text: &str, start: usize) -> Vec<Change> {
    let (mut header, mut of_kind, mut at, mut found) = (String::new(), String::new(), 0, Vec::new());
    for line in text.split_inclusive('\n') {
        let range = at..at + line.len();
        at = range.end;
        if line.starts_with('[') {
            (header, of_kind) = (line.trim().to_owned(), kind(&text[range.start..]));
        }
        let (false, Some((key, written))) = (line.starts_with('['), line.split_once(" = ")) else { continue };
        // one table for each of their values: `distribution_tables`, DESIGNS and SHAPES
        let is_shape = key == "shape" && header == "[[body.parts]]";
        if range.start < start || is_shape || ["distribution", "kind", "sha256"].contains(&key) {
            continue;
        }
        let table: toml::Table = line.parse().unwrap_or_else(|error| panic!("{line}: {error}"));
        let texts = match key {
            "name" => {
                let name = written.trim().trim_matches('"');
                vec![text.replace(name, &format!("{name}x"))]
            }
            _ => {
                let with = |other: Value| format!("{}{key} = {other}\n{}", &text[..range.start], &text[range.end..]);
                others(&table[key]).into_iter().map(with).collect()
            }
        };
        found.push(Change { header: header.clone(), kind: of_kind.clone(), key: key.to_owned(), texts });
    }
    found
}

/// As [`Plan::OUTSIDE_ROWS`] has it.
fn path(header: &str, key: &str) -> String {
    let table = header.trim_matches(['[', ']']);
    if header.starts_with("[[") { format!("{table}[0].{key}") } else { format!("{table}.{key}") }
}

fn listed(folder: &Path, text: &str) -> Vec<String> {
    let error = read(folder, &format!("{text}{NOTHING} = 1\n")).expect_err("a key that no table has");
    let problem = error.problems.iter().find(|problem| problem.key.ends_with(NOTHING));
    let problem = problem.unwrap_or_else(|| panic!("{text}: {error}"));
    let names = problem.allowed.split_once(" (").and_then(|(_, rest)| rest.split(')').next()).unwrap_or_default();
    names.split(", ").map(str::to_owned).collect()
}

const DESIGNS: [&str; 11] = [
    "kind = \"random\"\n",
    "kind = \"latin_hypercube\"\n",
    "kind = \"latin_hypercube\"\nreplicates = 3\n",
    "kind = \"sobol\"\nreplicates = 3\n",
    "kind = \"halton\"\nreplicates = 3\n",
    "kind = \"saltelli\"\n",
    "kind = \"grid\"\nlevels = 3\n",
    "kind = \"grid\"\nquantiles = [0.25, 0.75]\n",
    "kind = \"one_at_a_time\"\nlevels = [2]\n",
    "kind = \"one_at_a_time\"\nquantiles = [0.25, 0.75]\n",
    "kind = \"table\"\nfile = \"data.csv\"\nparameters = [\"wheels.w1.length_m\"]\ncolumns = [\"a\"]\n",
];

const SHAPES: [(&str, &str); 4] = [
    ("shape = \"sphere\"\nradius_m = 0.1", "shape = \"point_mass\""),
    (
        "shape = \"hollow_cylinder\"\nwall_thickness_m = 0.03\nouter_radius_m = 1.0",
        "shape = \"solid_cylinder\"\nradius_m = 1.0",
    ),
    ("tolerance = 1e-10", "relative_tolerance = 1e-10\nabsolute_tolerance = 1e-11"),
    ("method = \"auto\"", "method = \"runge_kutta_4\"\nstep_s = 0.01"),
];

const STOP: &str =
    "[stop]\nobservable = \"energy_error_max\"\nquantile = 0.95\nhalf_width = 1e-12\nmax_samples = 5000\n";
const GATES: &str = "[[require]]\nobservable = \"steps\"\nmean = true\nat_least = 1.0\nconfidence = 0.9\n\
    [[require]]\nband = \"angular_rate_rad_s\"\nfraction = 0.9\nat_most = 1e6\nfrom_s = 1.0\nto_s = 9.0\n";

/// Files, each with the place from which on keys are changed, and whether that part is a table of its own kind.
fn files() -> Vec<(String, usize)> {
    let every = EVERY_TABLE.to_owned();
    let second_arc = "[[actuation]]\nname = \"later\"\nstart_s = 4.0\nend_s = 6.0\nthrust_n = { p1 = 3.0 }\ntorque_n_m \
        = { w1 = -0.5 }\n\
        thrust_scale = 1.25\ntorque_scale = 0.5\nswitch_on_delay_s = 0.125\nswitch_off_delay_s = 0.25\n";
    let mut files = vec![(every.clone(), 0)];
    files.push((format!("{every}{second_arc}{GATES}"), every.len()));
    files.extend(SHAPES.map(|(from, to)| (every.replace(from, to), 0)));
    files.push((every.replace(STOP, "").replace("seed = 1\n", "seed = 1\nonly = [0, 3]\n"), 0));
    files.push((every.replace(STOP, &format!("{STOP}confidence = 0.9\n")), 0));
    let plain = without_draws();
    let alone = |table: &str| {
        let text = format!("{plain}{table}");
        let start = plain.len();
        (text, start)
    };
    files.extend(distribution_tables().iter().map(|(_, table)| alone(table)));
    let rate = "[[disperse]]\nparameter = \"wheels.w1.radius_m\"\ndistribution = \"uniform\"\nhalf_width = 0.02\n";
    for design in DESIGNS {
        let has_size = ["grid", "one_at_a_time", "table"].iter().any(|kind| design.contains(kind));
        let base = plain.replace(STOP, "").replace("samples = 10\n", if has_size { "" } else { "samples = 16\n" });
        let (base, table) = (format!("{base}{rate}"), format!("[design]\n{design}"));
        files.push((format!("{base}{table}"), base.len()));
    }
    let three = "[[disperse]]\nparameter = \"initial.velocity_m_s\"\ndistribution = \"normal\"\nstd = 0.1\n";
    for (components, correlation) in [
        ("xyz", "correlation = [[1.0, 0.9, 0.9], [0.9, 1.0, -0.9], [0.9, -0.9, 1.0]]\nnearest_psd = true\n"),
        ("xy", "correlation = 0.5\nnearest_psd = true\n"),
        ("xy", "rank_correlation = 0.5\n"),
        ("xy", "covariance = 0.001\n"),
    ] {
        let base = format!("{plain}{three}");
        let list: Vec<String> = components.chars().map(|c| format!("initial.velocity_m_s.{c}")).collect();
        files.push((format!("{base}[[correlate]]\nparameters = {list:?}\n{correlation}"), base.len()));
    }
    let base = format!("{plain}{rate}");
    let derived = "parameter = \"initial.position_m.x\"\nexpression = \"wheels.w1.radius_m - 0.25\"\n";
    files.push((format!("{base}[[derive]]\n{derived}"), base.len()));
    files
}

/// Law: each key changes the plan, which reads back; the hash of the rows changes unless the key is one of
/// [`Plan::OUTSIDE_ROWS`].
#[test]
fn every_key_changes_the_plan_and_the_hash_of_the_rows_where_it_should() {
    let scratch = folder("every-key-changes");
    let folder = scratch.0.as_path();
    let (mut known, mut covered, mut wrong, mut hashes) =
        (BTreeSet::new(), BTreeSet::new(), Vec::new(), BTreeSet::new());
    let files = files();
    for (text, start) in &files {
        let plan = read(folder, text).unwrap_or_else(|error| panic!("{error}\n{text}"));
        reads_back(folder, &plan, text);
        hashes.insert(plan.row_hash());
        for Change { header, kind, key, texts } in changes(text, *start) {
            let path = path(&header, &key);
            let of = (path.clone(), if key == "parameter" { String::new() } else { kind });
            known.insert(of.clone());
            let other = texts.iter().filter_map(|text| read(folder, text).ok()).find(|other| *other != plan);
            let Some(other) = other else { continue };
            covered.insert(of);
            reads_back(folder, &other, &path);
            if other.hash() == plan.hash() {
                wrong.push(format!("{path}: the hash of the plan stays"));
            }
            let is_outside = Plan::OUTSIDE_ROWS.iter().any(|prefix| path.starts_with(prefix));
            if (other.row_hash() == plan.row_hash()) != is_outside {
                wrong.push(format!("{path}: the hash of the rows changes: {is_outside}"));
            }
        }
    }
    assert!(hashes.len() == files.len() - 1, "{} of {}", hashes.len(), files.len());
    for (text, start) in &files {
        let tables: Vec<usize> =
            text.match_indices("\n[").map(|(at, _)| at + 1).filter(|at| at >= start).chain([text.len()]).collect();
        for ends in tables.windows(2) {
            let header = text[ends[0]..].lines().next().unwrap_or_default().to_owned();
            if is_of_scene(&header) {
                continue;
            }
            let moved = format!("{}{}{}", &text[..ends[0]], &text[ends[1]..], &text[ends[0]..ends[1]]);
            let kind = kind(&text[ends[0]..]);
            let of = |key: &String| (path(&header, key), if key == "parameter" { String::new() } else { kind.clone() });
            known.extend(listed(folder, &moved).iter().map(of));
        }
    }
    let by_kind = ["distribution", "kind", "sha256"];
    known.retain(|(path, _)| {
        let is_outside = Plan::OUTSIDE_ROWS.iter().any(|prefix| path.starts_with(prefix));
        !is_outside && !is_of_scene(path) && !by_kind.iter().any(|key| path.ends_with(key))
    });
    let missing: Vec<_> = known.difference(&covered).collect();
    assert!(missing.is_empty(), "no file here changes {missing:?}");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

fn is_of_scene(table: &str) -> bool {
    let tables = [
        "body",
        "wheels",
        "thrusters",
        "torque_rods",
        "debris",
        "initial",
        "orbit",
        "environment",
        "actuat",
        "failure",
    ];
    tables.iter().any(|scene| table.trim_matches('[').starts_with(scene))
}

/// Law: each number of the schema, in the second arc as in the first, is in the plan and in the rows' hash.
#[test]
fn every_number_of_a_scene_is_in_the_plan() {
    let (mut rows, mut seen) = (BTreeSet::new(), BTreeSet::new());
    let folder = Path::new("");
    for text in every_scene().into_iter().chain(every_loop()) {
        let plan = read(folder, &text).unwrap_or_else(|error| panic!("{error}\n{text}"));
        for parameter in Parameter::all(&plan.nominal) {
            rows.insert((std::ptr::from_ref(parameter.facts()) as usize, parameter.facts().key));
            for component in 0..parameter.width() {
                let name = parameter.component_name(component);
                let Some(value) = parameter.value(&plan.nominal, component) else { continue };
                let header = name.split('.').next().unwrap_or_default();
                if lacking(&plan.nominal.environment, header, parameter.facts().key).is_some() {
                    continue;
                }
                let is_inertial = plan.nominal.initial.debris_attitude_inertial.is_some();
                let relative = ["debris_attitude", "debris_relative_angular_velocity_rad_s"];
                if is_inertial && relative.contains(&parameter.facts().key) {
                    continue;
                }
                if plan.nominal.orbit.is_some()
                    && ["initial.position_m", "initial.velocity_m_s"].contains(&&*parameter.name())
                    || plan.nominal.initial.attitude_orbital.is_some()
                        && ["initial.attitude", "initial.angular_velocity_rad_s"].contains(&&*parameter.name())
                {
                    continue;
                }
                if name.starts_with("wheels.w2.") && ["rate_rad_s", "angle_rad"].contains(&parameter.facts().key) {
                    continue;
                }
                let mut other = plan.clone();
                if parameter.shape() == Shape::Quaternion {
                    let turned: [f64; 4] = from_fn(|i| if i / 2 == component / 2 { -0.5 } else { 0.5 });
                    (0..4).for_each(|i| parameter.set(&mut other.nominal, i, turned[i]));
                } else {
                    parameter.set(&mut other.nominal, component, if value == 0.0 { 0.015625 } else { 1.03125 * value });
                }
                let again = read(folder, &other.text()).unwrap_or_else(|error| panic!("{name}: {error}"));
                assert_eq!(again.nominal, other.nominal, "{name}");
                assert!(again.row_hash() == other.row_hash() && again.row_hash() != plan.row_hash(), "{name}");
                seen.insert((std::ptr::from_ref(parameter.facts()) as usize, parameter.facts().key));
            }
        }
    }
    assert_eq!(seen, rows, "every row of the schema is in a scene here");
}

/// Law: of relative and absolute tolerance one that is written leaves the other at the default, or at `tolerance`.
#[test]
fn a_tolerance_changes_no_other() {
    for method in Method::ALL {
        let tolerances = |keys: &str| {
            let step = if method.has_fixed_step() { "step_s = 0.01\n" } else { "" };
            let written = format!("[integrator]\nmethod = {:?}\n{step}{keys}\n", method.name());
            let text = EVERY_TABLE.replace("[integrator]\nmethod = \"auto\"\ntolerance = 1e-10\n", &written);
            let plan = read(Path::new(""), &text).unwrap_or_else(|error| panic!("{}: {error}", method.name()));
            [plan.tolerance.relative, plan.tolerance.absolute]
        };
        let [default, same] = tolerances("");
        let taylor = ["auto", "taylor"].contains(&method.name());
        assert_eq!([default, same], [if taylor { 1e-14 } else { 1e-10 }; 2], "{}", method.name());
        for (keys, expected) in [
            ("tolerance = 3e-9", [3e-9; 2]),
            ("relative_tolerance = 3e-9", [3e-9, default]),
            ("absolute_tolerance = 3e-9", [default, 3e-9]),
            ("tolerance = 4e-8\nrelative_tolerance = 3e-9", [3e-9, 4e-8]),
            ("tolerance = 4e-8\nabsolute_tolerance = 3e-9", [4e-8, 3e-9]),
            ("relative_tolerance = 4e-8\nabsolute_tolerance = 3e-9", [4e-8, 3e-9]),
        ] {
            assert_eq!(tolerances(keys), expected, "{}: {keys}", method.name());
        }
    }
}
