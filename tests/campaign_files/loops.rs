//! Control loops in campaign files: what is refused, with one problem for one mistake, and how a phase or a sensor is
//! addressed.

use spindrift::campaign::{CampaignError, Overrides, Plan};
use spindrift::control::observes::Observes;

use crate::support::scratch_folder::ScratchFolder;

/// A loop of everything that does not need debris.
pub const LOOP: &str = r#"[campaign]
name = "loop"
samples = 1
seed = 1
duration_s = 300.0
[body]
mass_kg = 100
center_of_mass_m = [0, 0, 0]
inertia_kg_m2 = [[30, 0, 0], [0, 36, 0], [0, 0, 24]]
includes_wheels = true
[[wheels]]
name = "w1"
axis = [1, 0, 0]
mass_kg = 1
axial_inertia_kg_m2 = 0.01
transverse_inertia_kg_m2 = 0.006
rate_rad_s = 10.0
speed_limit_rad_s = 600.0
[[wheels]]
name = "w2"
axis = [0, 1, 0]
mass_kg = 1
axial_inertia_kg_m2 = 0.01
transverse_inertia_kg_m2 = 0.006
[[wheels]]
name = "w3"
axis = [0, 0, 1]
mass_kg = 1
axial_inertia_kg_m2 = 0.01
transverse_inertia_kg_m2 = 0.006
[initial]
angular_velocity_rad_s = [0.01, 0.02, -0.01]
[control]
period_s = 0.25
delay_s = 0.1
estimator = "mekf"
wheels = ["w1", "w2", "w3"]
settling_band_rad = 0.01
initial_attitude_sigma_rad = 0.1
[[sensors]]
name = "gyro"
kind = "rate_gyro"
scale = [1, 1, 1]
[[sensors]]
name = "tracker"
kind = "star_tracker"
period_s = 0.5
latency_s = 0.25
noise_rad = [1e-4, 1e-4, 5e-4]
max_rate_rad_s = "2 deg/s"
[[guidance]]
phase = "damp"
law = "rate_damping"
gain_n_m_s = 5.0
until = "body_rate_rad_s < 0.01"
hold_s = 1.0
timeout_s = 100.0
[[guidance]]
phase = "slew"
law = "eigenaxis"
bandwidth_rad_s = 0.1
damping = 0.8
max_rate_rad_s = "1 deg/s"
target = "attitude"
attitude = [1, 0, 0, 0]
until = "pointing_error_rad < 0.01"
hold_s = 2.0
next = "hold"
[[guidance]]
phase = "hold"
law = "quaternion_feedback"
bandwidth_rad_s = 0.2
damping = 0.7
target = "attitude"
attitude = [1, 0, 0, 0]
"#;

/// What a loop has that depends on it: a dispersion of each table, a requirement, a retained run.
const DEPENDENTS: &str = r#"[[disperse]]
parameter = "control.delay_s"
distribution = "normal"
std = 0.01
[[disperse]]
parameter = "control.settling_band_rad"
distribution = "uniform"
min = 0.1
max = 0.2
[[disperse]]
parameter = "sensors.tracker.noise_rad"
distribution = "normal"
std = 1e-5
[[disperse]]
parameter = "guidance.hold.damping"
distribution = "normal"
std = 0.05
[[require]]
observable = "pointing_error_final_rad"
quantile = 0.95
at_most = 0.1
[[require]]
observable = "speed_peak_w1_rad_s"
quantile = 0.95
at_most = 600
[[require]]
observable = "phase_slew_begin_s"
quantile = 0.95
at_most = 100
[retain]
trajectories = "worst:1 by pointing_error_final_rad"
"#;

/// What sensors of an orbit need, before `[initial]`.
const IN_A_FIELD: &str = "[environment]\nmagnetic_field = \"igrf\"\n[orbit]\nepoch = \
    \"2026-11-24T00:00:00Z\"\nsemi_major_axis_m = 7e6\n[initial]";

pub fn plan(text: &str) -> Plan {
    Plan::from_text("loop.toml", text, Overrides::default()).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

fn refused(text: &str) -> CampaignError {
    Plan::from_text("loop.toml", text, Overrides::default()).expect_err(text)
}

fn set(settings: &[(&str, &str)]) -> Result<Plan, CampaignError> {
    let settings = settings.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect();
    Plan::from_text("loop.toml", LOOP, Overrides { settings, ..Overrides::default() })
}

/// Law: a sensor for which an estimator has no use is refused by its name, over all kinds of both; perfect knowledge,
/// which reads none, has a note instead.
#[test]
fn a_sensor_that_nobody_uses_is_refused() {
    let raw = LOOP.replacen("initial_attitude_sigma_rad = 0.1\n", "", 1);
    let tachometers = "[[sensors]]\nname = \"tach\"\nkind = \"tachometers\"\n";
    let mut refusals = 0;
    for estimator in &spindrift::control::estimators::KINDS {
        for kind in &spindrift::control::sensors::KINDS {
            let is_field = matches!(kind.observes, Observes::Field(_));
            if kind.observes.needs_debris() || kind.observes.at_most_one() && !is_field {
                continue;
            }
            let name = estimator.name;
            let sensor = format!("[[sensors]]\nname = \"unused\"\nkind = \"{}\"\n", kind.name);
            let text = format!("{}{tachometers}{sensor}", raw.replacen("\"mekf\"", &format!("\"{name}\""), 1));
            let text = if kind.needs.is_some() { text.replacen("[initial]", IN_A_FIELD, 1) } else { text };
            if estimator.knows_the_truth || (estimator.uses)(&kind.observes) {
                plan(&text);
            } else {
                let said = refused(&text).to_string();
                assert!(said.contains(&format!("sensors.unused.kind = \"{}\"", kind.name)), "{said}");
                assert!(said.contains(&format!("the estimator \"{name}\" uses")), "{said}");
                refusals += 1;
            }
        }
    }
    assert_eq!(refusals, 3, "Sun sensor, horizon sensor and magnetometer, by raw measurements");
}

/// Law: torque rods are refused without what they need: a field, a magnetometer, a phase, wheels to unload; and a rod
/// that the loop does not drive, which nothing else does.
#[test]
fn torque_rods_need_what_drives_them() {
    let rods = "[[torque_rods]]\nname = \"m1\"\naxis = [0, 0, 1]\nmax_dipole_a_m2 = 5\n";
    let sensor = "[[sensors]]\nname = \"field\"\nkind = \"magnetometer\"\n[[guidance]]\nphase = \"brake\"\nrods = \
        \"b_dot\"\nb_dot_gain_a_m2_s_t = 1e5\n";
    let in_field = LOOP.replacen("[initial]", IN_A_FIELD, 1);
    let right = in_field.replacen("[control]", &format!("{rods}[control]\ntorque_rods = [\"m1\"]"), 1) + sensor;
    let read = plan(&right);
    assert_eq!(read, plan(&read.text()));
    let second = rods.replace("m1", "m2");
    for (from, to, key, allowed) in [
        (
            "magnetic_field = \"igrf\"",
            "gravity_gradient = true",
            "environment.magnetic_field = missing",
            "given where there are [[torque_rods]]",
        ),
        (
            "[[sensors]]\nname = \"field\"\nkind = \"magnetometer\"",
            "",
            "control.torque_rods = [\"m1\"]",
            "without a sensor of kind \"magnetometer\"",
        ),
        (
            "rods = \"b_dot\"\nb_dot_gain_a_m2_s_t = 1e5",
            "",
            "control.torque_rods = [\"m1\"]",
            "without a phase that uses them",
        ),
        ("\ntorque_rods = [\"m1\"]", "", "torque_rods.m1.name = \"m1\"", "the name of one that the loop drives"),
        (
            "[control]\n",
            &format!("{second}[control]\n"),
            "torque_rods.m2.name = \"m2\"",
            "the name of one that the loop drives",
        ),
        ("max_dipole_a_m2 = 5", "max_dipole_a_m2 = 0", "torque_rods.m1.max_dipole_a_m2 = 0", "above zero"),
        ("axis = [0, 0, 1]\nmax", "axis = [0, 0, 0]\nmax", "torque_rods.m1.axis", "not all zero"),
        ("rods = \"b_dot\"\n", "rods = \"bdot\"\n", "guidance.brake.rods = \"bdot\"", "none, b_dot, unloading"),
        ("b_dot_gain_a_m2_s_t = 1e5", "", "guidance.brake.b_dot_gain_a_m2_s_t is missing", "add b_dot_gain_a_m2_s_t"),
        (
            "kind = \"magnetometer\"",
            "kind = \"magnetometer\"\n[[sensors]]\nname = \"other\"\nkind = \"magnetometer\"",
            "sensors.other.kind",
            "at most one sensor of kind \"magnetometer\"",
        ),
    ] {
        assert_eq!(right.matches(from).count(), 1, "{from}");
        let said = refused(&right.replacen(from, to, 1)).to_string();
        assert!(said.contains(key) && said.contains(allowed), "{to}: {said}");
    }
    let idle =
        LOOP.replacen("phase = \"slew\"", "phase = \"slew\"\nrods = \"unloading\"\nrod_unloading_time_s = 100", 1);
    assert!(refused(&idle).to_string().contains("\"none\" in a loop without torque rods"));
}

/// Law: filters, raw measurements and perfect knowledge know gravity: with thrusters and a radar a loop on an orbit is
/// accepted.
#[test]
fn every_estimator_is_accepted_on_an_orbit() {
    let on_orbit = LOOP.replacen("[initial]", "[orbit]\nsemi_major_axis_m = 7e6\n[initial]", 1);
    let radar = "[[sensors]]\nname = \"radar\"\nkind = \"ground_radar\"\nposition_noise_m = 1\nvelocity_noise_m_s = \
        1\n[[guidance]]";
    let with_radar = |text: &str| text.replacen("[[guidance]]", radar, 1);
    plan(&on_orbit);
    plan(&with_radar(LOOP));
    let perfect = with_radar(&on_orbit).replacen("initial_attitude_sigma_rad = 0.1\n", "", 1);
    plan(&perfect.replacen("\"mekf\"", "\"perfect\"", 1));
    plan(&with_radar(&on_orbit));
    let tachometers = "[[sensors]]\nname = \"t\"\nkind = \"tachometers\"\nnoise_rad_s = 0.01\n[[guidance]]";
    plan(&perfect.replacen("\"mekf\"", "\"raw\"", 1).replacen("[[guidance]]", tachometers, 1));
}

/// Law: a sensor fails in one way, that its kind knows, and a device fails once; friction can change in a loop.
#[test]
fn failures_are_of_devices_that_can_fail_so() {
    let failure = |keys: &str| format!("{LOOP}[[failure]]\nname = \"f\"\nat_s = 10\n{keys}\n");
    for right in [
        "sensor = \"gyro\"\nbias_rad_s = [0.1, 0, 0]",
        "sensor = \"tracker\"\nbias_rad = [0, 0, 0.1]",
        "sensor = \"tracker\"\noutput = \"frozen\"",
        "wheel = \"w2\"\ncoulomb_friction_n_m = 0.01",
    ] {
        let plan = plan(&failure(right));
        assert_eq!(plan, self::plan(&plan.text()), "{right}");
    }
    for (wrong, key, allowed) in [
        ("sensor = \"gyro\"\nbias_rad = [0.1, 0, 0]", "bias_rad", "has no such bias; write bias_rad_s"),
        ("sensor = \"gyro\"\noutput = \"dead\"", "output", "one of silent, frozen"),
        (
            "sensor = \"gyro\"\noutput = \"silent\"\nbias_rad_s = [1, 0, 0]",
            "bias_rad_s",
            "the only one of output, bias_rad_s, bias_rad",
        ),
        ("sensor = \"gyros\"\noutput = \"silent\"", "sensor", "did you mean \"gyro\"?"),
        ("wheel = \"w1\"\nsensor = \"gyro\"\noutput = \"silent\"", "sensor", "left out where another device is named"),
        (
            "wheel = \"w1\"\ntorque_scale = 0\n[[failure]]\nname = \"g\"\nat_s = 5\nwheel = \"w1\"\ntorque_scale = 0",
            "wheel",
            "a device that does not fail in another table: it does in f",
        ),
    ] {
        let said = refused(&failure(wrong)).to_string();
        assert!(said.contains(&format!(".{key}")) && said.contains(allowed), "{wrong}: {said}");
    }
}

/// Law: a transfer on an orbit takes less than half a revolution.
#[test]
fn a_transfer_takes_less_than_half_a_revolution() {
    let text = std::fs::read_to_string("campaigns/net_launch.toml").expect("a shipped campaign");
    plan(&text.replacen("transfer_time_s = 300.0", "transfer_time_s = 3000.0", 1));
    let on_orbit = format!("{text}\n[orbit]\nsemi_major_axis_m = 7e6\n");
    let notes = |text: &str| plan(text).notes().join("\n");
    assert!(!notes(&on_orbit).contains("orbit.j2"));
    // allowed about a flattened body too, with a note
    assert!(
        notes(&format!("{on_orbit}j2 = 1.08262668e-3\n")).contains("Clohessy & Wiltshire about a point mass; orbit.j2")
    );
    let error = refused(&on_orbit.replacen("transfer_time_s = 300.0", "transfer_time_s = 3000.0", 1)).to_string();
    // pi sqrt(a^3/mu)
    let (key, allowed) = ("guidance.aim.transfer_time_s = 3000.0", "below half a period of the orbit, 2914 s");
    assert!(error.contains(key) && error.contains(allowed), "{error}");
}

/// Law: one wrong key of a loop is one problem, whatever depends on it: keys of an estimator, of a modulation, of a
/// law; parameters; columns. A loop without phases is one problem too.
#[test]
fn one_mistake_is_one_problem() {
    let text = format!("{LOOP}{DEPENDENTS}").replacen("samples = 1\n", "samples = 10\n", 1);
    plan(&text);
    for (from, to, key) in [
        ("period_s = 0.25\n", "period_s = -1\n", "control.period_s"),
        ("period_s = 0.25\n", "", "control.period_s"),
        ("delay_s = 0.1", "delay_s = \"soon\"", "control.delay_s"),
        ("estimator = \"mekf\"", "estimator = \"ekf2\"", "control.estimator"),
        ("wheels = [\"w1\", \"w2\", \"w3\"]\n", "", "control.wheels"),
        ("wheels = [\"w1\", \"w2\", \"w3\"]", "wheels = [\"w1\", \"w9\"]", "control.wheels"),
        ("kind = \"star_tracker\"", "kind = \"tracker\"", "sensors.tracker.kind"),
        ("noise_rad = [1e-4, 1e-4, 5e-4]", "noise_rad = 3", "sensors.tracker.noise_rad"),
        ("latency_s = 0.25", "latency_s = 0.3", "sensors.tracker.latency_s"),
        ("law = \"eigenaxis\"", "law = \"slew\"", "guidance.slew.law"),
        (
            "target = \"attitude\"\nattitude = [1, 0, 0, 0]\nuntil",
            "target = \"line\"\nattitude = [1, 0, 0, 0]\nuntil",
            "guidance.slew.target",
        ),
        ("phase = \"hold\"", "phase = \"hold it\"", "guidance[2].phase"),
        ("next = \"hold\"", "next = \"held\"", "guidance.slew.next"),
        ("until = \"body_rate_rad_s < 0.01\"", "until = \"body_rate < 0.01\"", "guidance.damp.until"),
    ] {
        assert!(text.contains(from), "{from}");
        let error = refused(&text.replacen(from, to, 1));
        let keys: Vec<&str> = error.problems.iter().map(|problem| problem.key.as_str()).collect();
        assert_eq!(keys, [key], "{to}: {error}");
    }
    let start = text.find("[[guidance]]").expect("phases");
    let end = text.find("[[disperse]]").expect("dispersions");
    let without = format!("{}{}", &text[..start], &text[end..]);
    let error = refused(&without);
    assert_eq!(error.problems.iter().map(|problem| problem.key.as_str()).collect::<Vec<_>>(), ["guidance"], "{error}");
    // beside another mistake it is told too, and so are mistakes that have nothing to do with the loop
    let several = without.replacen("\"mekf\"", "\"ekf2\"", 1).replacen("mass_kg = 100", "mass_kg = \"heavy\"", 1);
    let keys: Vec<String> = refused(&several).problems.into_iter().map(|problem| problem.key).collect();
    assert_eq!(keys, ["body.mass_kg", "control.estimator", "guidance"]);
}

/// Law: what flight software believes of the inertia is that of a body: symmetric, positive definite, no principal
/// moment above the sum of the others, and more than the wheels about their axes; the nearest tensors that are so are
/// accepted.
#[test]
fn a_believed_inertia_is_that_of_a_body() {
    let with = |tensor: &str| {
        LOOP.replacen("[[sensors]]", &format!("[control.model]\ninertia_kg_m2 = {tensor}\n[[sensors]]"), 1)
    };
    for (wrong, says, right) in [
        ("[[-30, 0, 0], [0, 36, 0], [0, 0, 24]]", "positive definite", "[[30, 0, 0], [0, 36, 0], [0, 0, 24]]"),
        ("[[0, 0, 0], [0, 0, 0], [0, 0, 0]]", "positive definite", "[[1, 0, 0], [0, 1, 0], [0, 0, 1]]"),
        ("[[30, 2, 0], [1, 36, 0], [0, 0, 24]]", "symmetric", "[[30, 2, 0], [2, 36, 0], [0, 0, 24]]"),
        ("[[30, 40, 0], [40, 36, 0], [0, 0, 24]]", "positive definite", "[[30, 4, 0], [4, 36, 0], [0, 0, 24]]"),
        ("[[30, 0, 0], [0, 36, 0], [0, 0, 67]]", "exceeds the sum", "[[30, 0, 0], [0, 36, 0], [0, 0, 66]]"),
        (
            "[[0.009, 0, 0], [0, 1, 0], [0, 0, 1]]",
            "more than the axial inertias",
            "[[0.02, 0, 0], [0, 1, 0], [0, 0, 1]]",
        ),
    ] {
        let error = refused(&with(wrong));
        let [problem] = &error.problems[..] else { panic!("{error}") };
        assert!(problem.key == "control.model.inertia_kg_m2" && problem.allowed.contains(says), "{wrong}: {problem}");
        plan(&with(right));
    }
}

/// Law: a loop has one gyro and one set of tachometers; of the other kinds it may have several.
#[test]
fn a_second_sensor_of_a_kind_that_is_used_once_is_refused() {
    let tables = [
        ("rate_gyro", false, "[[sensors]]\nname = \"a\"\nkind = \"rate_gyro\"\n"),
        ("tachometers", false, "[[sensors]]\nname = \"a\"\nkind = \"tachometers\"\n"),
        ("star_tracker", true, "[[sensors]]\nname = \"a\"\nkind = \"star_tracker\"\n"),
        ("ground_radar", true, "[[sensors]]\nname = \"a\"\nkind = \"ground_radar\"\n"),
    ];
    for (kind, may_be_several, table) in tables {
        let two = format!("{LOOP}{table}{}", table.replace("\"a\"", "\"b\""));
        let one = if kind == "rate_gyro" { LOOP.to_owned() } else { format!("{LOOP}{table}") };
        plan(&one);
        match Plan::from_text("loop.toml", &two, Overrides::default()) {
            Ok(_) => assert!(may_be_several, "{kind}"),
            Err(error) => {
                let said = error.to_string();
                assert!(
                    !may_be_several && said.contains("sensors.b.kind") && said.contains("at most one sensor of kind"),
                    "{kind}: {said}"
                );
            }
        }
    }
}

/// Law: a condition compares; a number alone is refused, with what to write.
#[test]
fn a_condition_compares() {
    for wrong in ["body_rate_rad_s", "body_rate_rad_s and time_s > 5", "body_rate_rad_s - 0.01", "2"] {
        let error = refused(&LOOP.replacen("body_rate_rad_s < 0.01", wrong, 1));
        let [problem] = &error.problems[..] else { panic!("{error}") };
        assert!(problem.key == "guidance.damp.until" && problem.allowed.contains("a comparison"), "{wrong}: {problem}");
    }
    for right in ["(body_rate_rad_s < 0.01)", "1", "time_s > 5 and (body_rate_rad_s < 1 or time_s > 9)"] {
        plan(&LOOP.replacen("body_rate_rad_s < 0.01", right, 1));
    }
}

/// Law: a module is refused in one problem: by a build without WebAssembly with the command that builds it in, where it
/// cannot be read, where no phase flies it, and where a phase names it and there is none.
#[test]
fn a_module_that_cannot_be_flown_is_refused() {
    let scratch = ScratchFolder::new("campaign-files-module");
    std::fs::write(scratch.path("law.wasm"), b"\0asm\x01\0\0\0").unwrap();
    scratch.file("law.txt", "");
    let problem = |control: &str, law: &str| {
        let text = LOOP.replacen("period_s = 0.25\n", &format!("period_s = 0.25\n{control}"), 1);
        let (before, phases) = text.split_once("[[guidance]]").expect("phases");
        let phases = phases.replacen("law = \"rate_damping\"\n", law, 1);
        scratch.file("loop.toml", &format!("{before}[[guidance]]{phases}"));
        let error = Plan::load(&scratch.path("loop.toml"), Overrides::default()).expect_err(control);
        assert_eq!(error.problems.len(), 1, "{error}");
        error.to_string()
    };
    let of_module = "law = \"module\"\n";
    let unread = if cfg!(feature = "wasm") { "does not export" } else { "cargo build --release --features wasm" };
    let checksum = format!("module = \"law.wasm\"\nmodule_sha256 = \"{}\"\n", "0".repeat(64));
    for (control, law, says) in [
        ("module = \"law.wasm\"\n", of_module, unread),
        ("module = \"none.wasm\"\n", of_module, "a readable file"),
        ("module = \"law.txt\"\n", of_module, "ends in .wasm"),
        ("module = 3\n", of_module, "must be text"),
        (&checksum, of_module, "the SHA-256 of the module, "),
        ("module_sha256 = \"00\"\n", "law = \"rate_damping\"\n", "left out without `module`"),
        ("", of_module, "add module = \"law.wasm\" to [control]"),
    ] {
        let found = problem(control, law);
        assert!(found.contains(says), "{says}: {found}");
    }
}

/// Law: sensors measure at whole multiples or whole fractions of the control period, whatever the others do, where a
/// tick of a thousandth of it or more is common to all.
#[test]
fn periods_of_sensors_fit_into_the_loop() {
    let with = |control: &str, gyro: &str, tracker: &str| {
        LOOP.replacen("period_s = 0.25\n", &format!("period_s = {control}\n"), 1)
            .replacen("kind = \"rate_gyro\"", &format!("kind = \"rate_gyro\"\nperiod_s = {gyro}"), 1)
            .replacen("period_s = 0.5\nlatency_s = 0.25\n", &format!("period_s = {tracker}\n"), 1)
    };
    for (control, gyro, tracker) in [
        ("0.5", "2", "5"),
        ("0.5", "5", "2"),
        ("0.6", "0.3", "0.2"),
        ("0.6", "0.2", "3"),
        ("1", "0.001", "0.5"),
        ("0.1", "0.3", "0.7"),
    ] {
        plan(&with(control, gyro, tracker));
    }
    for (control, gyro, tracker, key) in [
        ("0.5", "0.7", "5", "sensors.gyro.period_s"),
        ("0.5", "2", "5.1", "sensors.tracker.period_s"),
        // 1/31 and 1/37 have 1/1147 in common
        ("1147", "37", "31", "sensors.tracker.period_s"),
    ] {
        let error = refused(&with(control, gyro, tracker));
        assert!(error.problems.len() == 1 && error.problems[0].key == key, "{error}");
    }
}

/// Law: what a remedy gives to write is accepted, and never what was refused.
#[test]
fn a_remedy_is_accepted() {
    let mut tried = 0;
    for (control, key, line) in [
        ("0.25", "period_s = 0.5", "period_s"),
        ("0.25", "latency_s = 0.25", "latency_s"),
        ("1e-4", "latency_s = 0.25", "latency_s"),
        ("0.1", "period_s = 0.5", "period_s"),
        ("300.0", "period_s = 0.5", "period_s"),
    ] {
        for value in ["0.25", "0.3", "0.375", "0.07", "0.999", "0.1250001", "77.7", "1e-9", "1e12"] {
            let mut text = LOOP.replacen("period_s = 0.25\n", &format!("period_s = {control}\n"), 1);
            if line == "period_s" {
                text = text.replacen("latency_s = 0.25\n", "", 1);
            } else {
                text = text.replacen("period_s = 0.5\n", "", 1);
            }
            let with = |value: &str| text.replacen(key, &format!("{line} = {value}"), 1);
            let Err(error) = Plan::from_text("loop.toml", &with(value), Overrides::default()) else { continue };
            let [problem] = &error.problems[..] else { panic!("{error}") };
            let written = problem.remedy.strip_prefix("write ").unwrap_or_else(|| panic!("{problem}"));
            assert_ne!(written.parse::<f64>(), value.parse::<f64>(), "{problem}");
            plan(&with(written));
            tried += 1;
        }
    }
    assert!(tried > 20, "{tried} remedies");
}

/// Law: a phase and a sensor are addressed by their names, as messages and `[[disperse]]` name them, and by their
/// places; a file that extends another overrides one of them alone.
#[test]
fn phases_and_sensors_have_names() {
    let value =
        |plan: &Plan, table: usize, key: &str| plan.nominal.control.guidance[table].named(key).expect("a key")[0];
    for key in ["guidance.hold.bandwidth_rad_s", "guidance[2].bandwidth_rad_s"] {
        let plan = set(&[(key, "0.15")]).expect(key);
        assert_eq!((value(&plan, 2, "bandwidth_rad_s"), value(&plan, 1, "bandwidth_rad_s")), (0.15, 0.1));
    }
    let noise = set(&[("sensors.tracker.noise_rad", "[1e-3, 2e-3, 3e-3]")]).expect("a sensor");
    assert_eq!(noise.nominal.control.sensors[1].named("noise_rad"), Some(&[1e-3, 2e-3, 3e-3][..]));
    let wrong = set(&[("guidance.held.damping", "1")]).expect_err("no such phase").to_string();
    assert!(wrong.contains("[[guidance]]") && wrong.contains("damp, slew, hold"), "{wrong}");
    let scratch = ScratchFolder::new("extended-loop");
    scratch.file("base.toml", LOOP);
    scratch.file(
        "variant.toml",
        "extends = \"base.toml\"\n[[guidance]]\nphase = \"hold\"\nbandwidth_rad_s = 0.15\n[[sensors]]\nname = \
        \"tracker\"\nnoise_rad = [1e-3, 2e-3, 3e-3]\n",
    );
    let variant =
        Plan::load(&scratch.path("variant.toml"), Overrides::default()).unwrap_or_else(|error| panic!("{error}"));
    let same = set(&[("guidance.hold.bandwidth_rad_s", "0.15"), ("sensors.tracker.noise_rad", "[1e-3, 2e-3, 3e-3]")])
        .expect("a plan");
    assert_eq!(variant.hash(), same.hash());
    assert_eq!(variant.nominal.control.guidance.len(), 3);
}

/// Law: what a filter takes from the file in every run is refused as a dispersion, as a derived parameter and in a file
/// of draws, with the reason; the same key of an estimator without filters is no parameter; what laws and sensors draw
/// is not refused.
#[test]
fn numbers_of_a_filter_are_not_dispersed() {
    let sigma = "control.initial_attitude_sigma_rad";
    let drawn = |name: &str| {
        let text = LOOP.replacen("samples = 1\n", "samples = 10\n", 1);
        format!("{text}[[disperse]]\nparameter = \"{name}\"\ndistribution = \"uniform\"\nmin = 0.01\nmax = 0.02\n")
    };
    for name in [sigma, "control.initial_bias_sigma_rad_s", "control.rate_random_walk_rad_s_sqrt_s"] {
        let error = refused(&drawn(name));
        assert_eq!(error.problems.len(), 1, "{error}");
        let said = error.to_string();
        for part in ["disperse[0].parameter", name, "believes the numbers of the file in every run", "--set"] {
            assert!(said.contains(part), "{part}: {said}");
        }
    }
    for name in ["control.delay_s", "control.settling_band_rad", "guidance.hold.damping"] {
        plan(&drawn(name));
    }
    let derived =
        format!("{}[[derive]]\nparameter = \"{sigma}\"\nexpression = \"control.delay_s\"\n", drawn("control.delay_s"));
    let said = refused(&derived).to_string();
    assert!(said.contains("derive[0].parameter") && said.contains("believes the numbers"), "{said}");
    let scratch = ScratchFolder::new("campaign-files-sigmas");
    scratch.file("draws.csv", "delay,sigma\n0.01,0.01\n0.02,0.02\n");
    let list = |name: &str| format!("file = \"draws.csv\"\nparameters = [\"control.delay_s\", \"{name}\"]\n");
    // a design by a table has as many samples as the table
    for (table, samples) in
        [("[[disperse]]\ndistribution = \"bootstrap\"\n", "samples = 3\n"), ("[design]\nkind = \"table\"\n", "")]
    {
        let read = |name: &str| {
            let columns = "columns = [\"delay\", \"sigma\"]\n";
            let text = LOOP.replacen("samples = 1\n", samples, 1) + table + &list(name) + columns;
            scratch.file("loop.toml", &text);
            Plan::load(&scratch.path("loop.toml"), Overrides::default())
        };
        let said = read(sigma).expect_err(table).to_string();
        assert!(said.contains(sigma) && said.contains("believes the numbers of the file in every run"), "{said}");
        read("control.settling_band_rad").unwrap_or_else(|error| panic!("{table}: {error}"));
    }
}

/// Law: on an orbit with an epoch a Sun sensor has the Sun of the date, and a direction beside it is refused; elsewhere
/// it is a key, and the bias has any sign.
#[test]
fn a_dated_orbit_has_one_sun() {
    let orbit = "[orbit]\nsemi_major_axis_m = 7e6\n";
    let sensor = "[[sensors]]\nname = \"sun\"\nkind = \"sun_sensor\"\nbias_rad = -0.01\n";
    let file = |sensor: &str, orbit: &str| LOOP.replacen("[[guidance]]", &format!("{sensor}{orbit}[[guidance]]"), 1);
    let dated = format!("{orbit}epoch = \"2026-06-21T00:00:00Z\"\n");
    let given = format!("{sensor}sun_direction = [0, 1, 0]\n");
    for (sensor, orbit) in [(sensor, &dated[..]), (sensor, orbit), (&given, orbit), (&given, "")] {
        let plan = plan(&file(sensor, orbit));
        assert_eq!(plan.text().contains("sun_direction"), !orbit.contains("epoch"));
        assert_eq!(self::plan(&plan.text()).text(), plan.text());
    }
    let error = refused(&file(&given, &dated));
    assert_eq!(error.problems.len(), 1, "{error}");
    let said = error.to_string();
    assert!(said.contains("sensors.sun.sun_direction") && said.contains("delete this line, or orbit.epoch"), "{said}");
}
