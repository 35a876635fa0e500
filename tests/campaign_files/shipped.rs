//! Campaign files: the shipped ones, defaults, and the plan as text.

use spindrift::campaign::{Compression, Overrides, Plan, Retention};
use spindrift::observables::Group;
use spindrift::ode::Integrator;
use spindrift::propagation::Method;
use spindrift::scene::{Scene, WheelMode};
use std::path::Path;

fn shipped() -> Vec<std::path::PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("campaigns");
    let mut files: Vec<_> = std::fs::read_dir(folder)
        .expect("a folder of campaigns")
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "toml"))
        .collect();
    files.sort();
    files
}

#[test]
fn shipped_campaigns_are_valid_and_say_what_they_ask() {
    let files = shipped();
    assert!(files.len() >= 5);
    for file in files {
        let plan = Plan::load(&file, Overrides::default()).unwrap_or_else(|e| panic!("{e}"));
        assert!(Scene::resolve(&plan.nominal).is_ok());
        assert_eq!(file.file_stem().and_then(|stem| stem.to_str()), Some(plan.name.as_str()));
        let text = std::fs::read_to_string(&file).expect("readable");
        for word in ["# Question: ", "\n# Source: ", "\n# Expect: "] {
            assert!(text.contains(word), "{} says {word}", file.display());
        }
    }
}

/// Law: each property of the launch that the header of `net_launch.toml` promises is a requirement, with the limit of the header.
#[test]
fn a_launch_is_judged_by_what_its_file_promises() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("campaigns/net_launch.toml");
    let text = std::fs::read_to_string(&file).expect("readable");
    let header = text.split("\n\n").next().expect("a header").replace("\n#  ", "");
    let plan = Plan::load(&file, Overrides::default()).unwrap_or_else(|error| panic!("{error}"));
    let degree = std::f64::consts::PI / 180.0;
    for (said, column, limit) in [
        ("a lateral velocity below 5 cm/s", "relative_speed_launch_m_s", 0.05),
        ("pointing within 2 deg", "pointing_error_launch_rad", 2.0 * degree),
        ("a rate below 0.2 deg/s", "body_rate_launch_rad_s", 0.2 * degree),
        ("an offset from the line below 1.5 m", "axis_offset_launch_m", 1.5),
    ] {
        assert!(header.contains(said), "{said}: {header}");
        let observed = format!("observable = \"{column}\"\n");
        let text = plan.text();
        let of_column = text.split("[[require]]\n").filter(|one| one.starts_with(&observed));
        let limits: Vec<f64> = of_column.map(at_most).collect();
        assert!(matches!(limits[..], [found] if (found - limit).abs() < 1e-12 * limit), "{column}: {limits:?}");
    }
}

/// The upper limit of a requirement as the plan writes it.
fn at_most(requirement: &str) -> f64 {
    let line = requirement.lines().find_map(|line| line.strip_prefix("at_most = ")).expect("an upper limit");
    line.trim_matches('"').parse().expect("a number")
}

#[test]
fn a_plan_reads_back_from_its_text() {
    for file in shipped() {
        let plan =
            Plan::load(&file, Overrides { samples: Some(17), seed: Some(5), ..Overrides::default() }).expect("valid");
        let folder = file.parent().expect("a folder");
        let again = Plan::from_text_in(folder, "plan.toml", &plan.text(), Overrides::default());
        let again = again.unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(again, plan);
        assert_eq!((again.text(), again.hash()), (plan.text(), plan.hash()));
    }
}

/// Every optional key, and numbers that need all their digits.
const FULL: &str = r#"
[campaign]
name = "full"
samples = 0x10
seed = 9_223_372_036_854_775_807
duration_s = 1e-3
[integrator]
method = "runge_kutta_4"
relative_tolerance = 1e-9
absolute_tolerance = 1e-12
step_s = 0.0001
max_steps = 5
[observe]
points = 2
groups = ["effort", "energy_conservation"]
[body]
mass_kg = 2000
center_of_mass_m = [0.01, -0.02, 1.5]
inertia_kg_m2 = [[3000, 0.1, 0.2], [0.1, 3100, 0.3], [0.2, 0.3, 1700]]
mass_scale = 1.01
center_offset_m = [0.001, 0, 0]
[[body.parts]]
name = "fuselage"
shape = "hollow_cylinder"
wall_thickness_m = 0.030000000000000002
outer_radius_m = 1
length_m = 3
density_kg_m3 = 2.7e3
position_m = [0, 0, 1.5]
[[body.parts]]
name = "rod"
shape = "solid_cylinder"
radius_m = 0.01
length_m = "50 cm"
mass_kg = 2
attitude = [0.6, 0, 0.8, 0]
[[body.parts]]
name = "panel"
shape = "box"
size_m = [2, 1, "3 mm"]
mass_kg = 7
stretch_log = [0.1, 0, 0]
[[body.parts]]
name = "ball"
shape = "sphere"
radius_m = 0.1
density_kg_m3 = 1
[[body.parts]]
name = "tip"
shape = "point_mass"
mass_kg = "250 g"
position_m = [0, 0, 4]
[[wheels]]
name = "parked"
axis = [1, 1, 0]
mass_kg = 5
axial_inertia_kg_m2 = 0.01
transverse_inertia_kg_m2 = 0.006
mode = "locked"
[[wheels]]
name = "w2"
axis = [0, 0, 1]
position_m = [0, 0, -0.0]
radius_m = 0.25
length_m = 0.1
density_kg_m3 = 2700
angle_rad = 0.5
torque_scale = 0.9
torque_bias_n_m = 0.01
[[wheels]]
name = "held"
axis = [0, 2, 0]
radius_m = 0.25
length_m = 0.1
density_kg_m3 = 2700
tilt_rad = ["0.1 deg", 0]
mode = "speed_held"
rate_rad_s = "3000 rpm"
[[thrusters]]
name = "p1"
position_m = [0, 0, 0]
direction = [0, 0, 1]
[[thrusters]]
name = "side"
position_m = [1, 0, 1]
direction = [-1, 0.5, 0]
tilt_rad = [0.01, -0.02]
thrust_scale = 0.98
[[actuation]]
start_s = 0
end_s = "0.5 ms"
thrust_n = { side = 2.5 }
torque_n_m = { w2 = -0.25 }
[actuators]
switch_on_delay_s = 1e-5
[environment]
body_torque_n_m = [0, 1e-3, 0]
[debris]
size_m = [0.1, 0.2, 0.3]
density_kg_m3 = 1e3
[initial]
angular_velocity_rad_s = [0.1, 1e-300, 5e300]
[[disperse]]
parameter = "initial.angular_velocity_rad_s.x"
distribution = "truncated_normal"
std = 0.1
lower = 0
[[disperse]]
parameter = "debris.size_m"
distribution = "uniform"
min = [0.05, 0.1, 0.2]
max = 0.5
[[disperse]]
parameter = "body.inertia_kg_m2"
distribution = "normal"
std = [1, 0.1, 0.1, 1, 0.1, 1]
[[disperse]]
parameter = "body.mass_kg"
distribution = "uniform"
relative_half_width = 0.01
[[disperse]]
parameter = "initial.debris_attitude"
distribution = "normal"
std = 0.1
[[disperse]]
parameter = "body.center_of_mass_m.z"
distribution = "truncated_normal"
relative_std = 0.1
relative_lower = -0.2
upper_sigmas = 1.5
[[disperse]]
parameter = "wheels.w2.radius_m"
distribution = "log_normal"
log_std = 0.1
median = 0.26
[[disperse]]
parameter = "wheels.w2.density_kg_m3"
distribution = "log_uniform"
factor = 1.1
[[disperse]]
parameter = "debris.density_kg_m3"
distribution = "log_uniform"
min = 900
max = 1100
[[disperse]]
parameter = "initial.position_m"
distribution = "triangular"
min = -1
max = [1, 2, 3]
[[disperse]]
parameter = "initial.velocity_m_s.x"
distribution = "beta"
alpha = 2
beta = 3.5
min = 0
max = 1
[[disperse]]
parameter = "initial.velocity_m_s.y"
distribution = "pert"
min = 0
max = 1
mode = 0.25
[[disperse]]
parameter = "initial.velocity_m_s.z"
distribution = "choice"
values = [1, 2, 4]
weights = [1, 1, 2]
[[disperse]]
parameter = "wheels.w2.rate_rad_s"
distribution = "bernoulli"
value = 100
probability = 0.05
[[disperse]]
parameter = "initial.debris_position_m"
distribution = "empirical"
file = "campaigns/table.csv"
column = "wheels.w1.radius_m"
interpolation = "linear"
[[disperse]]
parameter = "initial.debris_velocity_m_s"
distribution = "offset"
offset = [0.1, 0.2, 0.3]
[[disperse]]
parameter = "initial.attitude"
distribution = "uniform_attitude"
[[correlate]]
parameters = ["wheels.w2.radius_m", "wheels.w2.density_kg_m3", "initial.velocity_m_s.y"]
correlation = [[1, 0.9, 0.9], [0.9, 1, -0.9], [0.9, -0.9, 1]]
nearest_psd = true
[[correlate]]
parameters = ["initial.velocity_m_s.x", "initial.velocity_m_s.z"]
rank_correlation = [[1, 0.5], [0.5, 1]]
[[derive]]
parameter = "wheels.w2.length_m"
expression = "0.4 * wheels.w2.radius_m + max(0, if(wheels.w2.radius_m > 0.25, wheels.w2.radius_m - 0.25, 0))"
[output]
compression = "none"
[bands]
points = 2
[retain]
trajectories = "worst:3 by energy_error_max"
"#;

#[test]
fn every_key_reads_back() {
    let plan = Plan::from_text("full.toml", FULL, Overrides::default()).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!((plan.samples, plan.seed, plan.max_steps), (16, i64::MAX as u64, 5));
    assert_eq!((plan.method, plan.step_s), (Method::Gyrostat(Integrator::RungeKutta4), Some(1e-4)));
    assert_eq!((plan.tolerance.relative, plan.tolerance.absolute), (1e-9, 1e-12));
    assert_eq!(plan.groups, [Group::EnergyConservation, Group::StepStatistics], "in the order of the columns");
    assert_eq!(plan.compression, Compression::None);
    let retention = Retention::Worst { count: 3, observable: "energy_error_max".to_owned() };
    assert_eq!((plan.band_points, &plan.retention), (2, &retention));
    assert!(plan.nominal.wheels[1].position_m[2].is_sign_negative(), "the sign of zero too");
    let modes = plan.nominal.wheels.iter().map(|wheel| wheel.mode).collect::<Vec<_>>();
    assert_eq!(modes, [WheelMode::Locked, WheelMode::Free, WheelMode::SpeedHeld]);
    assert_eq!((plan.nominal.parts.len(), plan.nominal.thrusters.len()), (5, 2));
    assert_eq!(plan.nominal.actuation[0].thrust_n[..2], [0.0, 2.5]);
    assert_eq!(plan.nominal.actuation[0].torque_n_m[..3], [0.0, -0.25, 0.0]);
    let again = Plan::from_text("plan.toml", &plan.text(), Overrides::default()).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(again, plan);
    // every digit counts in the hash
    let other = FULL.replace("0.030000000000000002", "0.03");
    assert_ne!(Plan::from_text("full.toml", &other, Overrides::default()).expect("valid").hash(), plan.hash());
    // spelling does not
    let spelled = FULL.replace("2.7e3", "2700 # the same").replace("0x10", "16");
    assert_eq!(Plan::from_text("full.toml", &spelled, Overrides::default()).expect("valid").hash(), plan.hash());
}

#[test]
fn every_design_reads_back() {
    let start = &FULL[..FULL.find("[[disperse]]").expect("dispersions")];
    let law = "[[disperse]]\nparameter = \"wheels.w2.radius_m\"\ndistribution = \"uniform\"\nhalf_width = 0.01\n";
    for (design, samples) in [
        ("kind = \"random\"", 16),
        ("kind = \"latin_hypercube\"", 16),
        ("kind = \"sobol\"", 16),
        ("kind = \"halton\"", 16),
        ("kind = \"latin_hypercube\"\nreplicates = 3", 16),
        ("kind = \"sobol\"\nreplicates = 5", 16),
        ("kind = \"halton\"\nreplicates = 15", 16),
        ("kind = \"saltelli\"", 16),
        ("kind = \"grid\"\nlevels = 15", 16),
        ("kind = \"grid\"\nquantiles = [0.25, 0.75]", 3),
        ("kind = \"one_at_a_time\"\nlevels = [2]", 3),
        ("kind = \"table\"\nfile = \"campaigns/table.csv\"\nparameters = [\"initial_angular_velocity_y_rad_s\"]", 28),
    ] {
        let text = format!("{start}{law}[design]\n{design}\n");
        let text = if samples == 16 { text } else { text.replace("samples = 0x10\n", "") };
        let plan = Plan::from_text("design.toml", &text, Overrides::default()).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(plan.samples, samples, "{design}");
        let again = Plan::from_text("plan.toml", &plan.text(), Overrides::default()).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(again, plan);
        assert_eq!(again.text(), plan.text());
    }
}

#[test]
fn omitted_keys_have_defaults() {
    let text = "[campaign]\nname = \"small\"\nsamples = 1\nseed = 0\nduration_s = 2\n[body]\nmass_kg = 10\n\
                inertia_kg_m2 = [[3, 0, 0], [0, 3, 0], [0, 0, 2]]\n[initial]\nangular_velocity_rad_s = [0, 0, 1]\n";
    let plan = Plan::from_text("small.toml", text, Overrides::default()).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!((plan.method, plan.grid.points(), plan.grid.duration()), (Method::Auto, 101, 2.0));
    assert_eq!(plan.groups, Group::DEFAULT);
    assert_eq!(plan.nominal.initial.attitude, [1.0, 0.0, 0.0, 0.0]);
    let scene = &plan.nominal;
    assert!(scene.wheels.is_empty() && scene.thrusters.is_empty() && scene.parts.is_empty() && scene.debris.is_none());
    assert_eq!((scene.body.center_of_mass_m, scene.body.includes_wheels), (None, false));
    let mass = Scene::resolve(scene).expect("physical").mass;
    assert_eq!((mass.total, mass.center), (10.0, [0.0; 3]));
    assert!(plan.dispersions.columns().is_empty());
    assert_eq!((plan.band_points, &plan.retention), (33, &Retention::None));
    let few = Plan::from_text("small.toml", &format!("{text}[observe]\npoints = 5\n"), Overrides::default());
    assert_eq!(few.unwrap_or_else(|e| panic!("{e}")).band_points, 5, "no more than the grid has");
}
