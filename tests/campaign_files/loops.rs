//! Control loops in campaign files: what is refused, and how a phase or a sensor is addressed.

use crate::prelude::*;
use spindrift::loops::observes::Observes;

pub const LOOP: &str = include_str!("loop.toml");

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

#[test]
fn a_sensor_that_nobody_uses_is_refused() {
    let raw = LOOP.replacen("initial_attitude_sigma_rad = 0.1\n", "", 1);
    let tachometers = "[[sensors]]\nname = \"tach\"\nkind = \"tachometers\"\n";
    let mut refusals = 0;
    for estimator in spindrift::control::estimators::KINDS.iter().map(|maker| &maker.kind) {
        for kind in spindrift::control::sensors::KINDS.iter().map(|maker| &maker.kind) {
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
                assert_says(
                    &said,
                    [&format!("sensors.unused.kind = \"{}\"", kind.name), &format!("the estimator \"{name}\" uses")],
                );
                refusals += 1;
            }
        }
    }
    assert_eq!(refusals, 3, "Sun sensor, horizon sensor and magnetometer, by raw measurements");
}

#[test]
fn a_transfer_takes_less_than_half_a_revolution() {
    let text = campaign_text("net_launch");
    plan(&text.replacen("transfer_time_s = 300.0", "transfer_time_s = 3000.0", 1));
    let on_orbit = format!("{text}\n[orbit]\nsemi_major_axis_m = 7e6\n");
    let notes = |text: &str| plan(text).notes().join("\n");
    assert!(!notes(&on_orbit).contains("orbit.j2"));
    assert!(
        notes(&format!("{on_orbit}j2 = 1.08262668e-3\n")).contains("Clohessy & Wiltshire about a point mass; orbit.j2")
    );
    let error = refused(&on_orbit.replacen("transfer_time_s = 300.0", "transfer_time_s = 3000.0", 1)).to_string();
    // pi sqrt(a^3/mu)
    let (key, allowed) = ("guidance.aim.transfer_time_s = 3000.0", "below half a period of the orbit, 2914 s");
    assert_says(&error, [key, allowed]);
}

#[test]
fn a_loop_without_phases_is_one_problem() {
    let requirement = "[[require]]\nobservable = \"phase_slew_begin_s\"\nquantile = 0.95\nat_most = 100\n";
    let without = LOOP[..LOOP.find("[[guidance]]").unwrap()].to_owned() + requirement;
    let keys = |text: &str| refused(text).problems.into_iter().map(|problem| problem.key).collect::<Vec<_>>();
    assert_eq!(keys(&without), ["guidance"]);
    let several = without.replacen("\"mekf\"", "\"ekf2\"", 1).replacen("mass_kg = 100", "mass_kg = \"heavy\"", 1);
    assert_eq!(keys(&several), ["body.mass_kg", "control.estimator", "guidance"]);
}

/// Law: a module that is not built in, not readable, not flown or not there is one problem.
#[test]
fn a_module_that_cannot_be_flown_is_refused() {
    let scratch = ScratchFolder::new("campaign-files-module");
    std::fs::write(scratch.path("law.wasm"), b"\0asm\x01\0\0\0").unwrap();
    scratch.file("law.txt", "");
    let problem = |control: &str, law: &str| {
        let text = LOOP.replacen("period_s = 0.25\n", &format!("period_s = 0.25\n{control}"), 1);
        let (before, phases) = text.split_once("[[guidance]]").unwrap();
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
        assert_says(&found, [says]);
    }
}

/// Law: sensors measure at whole multiples or fractions of the control period, with a common tick of a thousandth of
/// it.
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

/// Law: phases and sensors are addressed by names, as in messages, and by places; a file that extends another overrides
/// one alone.
#[test]
fn phases_and_sensors_have_names() {
    let value = |plan: &Plan, table: usize, key: &str| plan.nominal.control.guidance[table].named(key).unwrap()[0];
    for key in ["guidance.hold.bandwidth_rad_s", "guidance[2].bandwidth_rad_s"] {
        let plan = set(&[(key, "0.15")]).expect(key);
        assert_eq!((value(&plan, 2, "bandwidth_rad_s"), value(&plan, 1, "bandwidth_rad_s")), (0.15, 0.1));
    }
    let noise = set(&[("sensors.tracker.noise_rad", "[1e-3, 2e-3, 3e-3]")]).unwrap();
    assert_eq!(noise.nominal.control.sensors[1].named("noise_rad"), Some(&[1e-3, 2e-3, 3e-3][..]));
    assert_says(
        set(&[("guidance.held.damping", "1")]).expect_err("no such phase").to_string(),
        ["[[guidance]]", "damp, slew, hold"],
    );
    let scratch = ScratchFolder::new("extended-loop");
    scratch.file("base.toml", LOOP);
    scratch.file(
        "variant.toml",
        "extends = \"base.toml\"\n[[guidance]]\nphase = \"hold\"\nbandwidth_rad_s = 0.15\n[[sensors]]\nname = \
        \"tracker\"\nnoise_rad = [1e-3, 2e-3, 3e-3]\n",
    );
    let variant = Plan::load(&scratch.path("variant.toml"), Overrides::default()).unwrap();
    let same =
        set(&[("guidance.hold.bandwidth_rad_s", "0.15"), ("sensors.tracker.noise_rad", "[1e-3, 2e-3, 3e-3]")]).unwrap();
    assert_eq!(variant.hash(), same.hash());
    assert_eq!(variant.nominal.control.guidance.len(), 3);
}

/// Law: what a filter takes from the file is refused as a dispersion, a derived parameter and in a file of draws.
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
            assert_says(&said, [part]);
        }
    }
    for name in ["control.delay_s", "control.settling_band_rad", "guidance.hold.damping"] {
        plan(&drawn(name));
    }
    let derived =
        format!("{}[[derive]]\nparameter = \"{sigma}\"\nexpression = \"control.delay_s\"\n", drawn("control.delay_s"));
    assert_says(refused(&derived).to_string(), ["derive[0].parameter", "believes the numbers"]);
    let scratch = ScratchFolder::new("campaign-files-sigmas");
    scratch.file("draws.csv", "delay,sigma\n0.01,0.01\n0.02,0.02\n");
    let list = |name: &str| format!("file = \"draws.csv\"\nparameters = [\"control.delay_s\", \"{name}\"]\n");
    for (table, samples) in
        [("[[disperse]]\ndistribution = \"bootstrap\"\n", "samples = 3\n"), ("[design]\nkind = \"table\"\n", "")]
    {
        let read = |name: &str| {
            let columns = "columns = [\"delay\", \"sigma\"]\n";
            let text = LOOP.replacen("samples = 1\n", samples, 1) + table + &list(name) + columns;
            scratch.file("loop.toml", &text);
            Plan::load(&scratch.path("loop.toml"), Overrides::default())
        };
        assert_says(
            read(sigma).expect_err(table).to_string(),
            [sigma, "believes the numbers of the file in every run"],
        );
        read("control.settling_band_rad").unwrap_or_else(|error| panic!("{table}: {error}"));
    }
}

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
    assert_says(error.to_string(), ["sensors.sun.sun_direction", "delete this line, or orbit.epoch"]);
}

#[test]
fn torque_rods_need_a_field() {
    let field = "magnetic_field = \"dipole\"\nmagnetic_dipole_a_m2 = [0.01, -0.01, 0.02]\n";
    assert_says(refused(&DETUMBLE_MAGNETIC.replacen(field, "", 1)).to_string(), ["where there are [[torque_rods]]"]);
}
