//! Interface 2 of flight code: measurements and telemetry.

use super::assembled_module::{Assembled, INPUT, MEASURED, REPORTED, constant, copied};
use super::flight_code::{plan_in, refused, with};
use super::whole_rows::{column, names, rows};
use crate::prelude::*;

fn module(sensors: &'static str, telemetry: &'static str, step: &[u8]) -> Assembled {
    let mut module = Assembled::with_step(step);
    module.places[0] = 2;
    module.tables = [Some(sensors), Some(telemetry)];
    module
}

fn recorded(run: &SingleRun, name: &str) -> Vec<f64> {
    let place = run.telemetry.quantities.iter().position(|quantity| quantity.name() == name);
    let place = place.unwrap_or_else(|| panic!("no column {name}"));
    run.telemetry.rows.iter().map(|row| row[place]).collect()
}

/// Law: a module gets the last delivery of each sensor that it wants, in the order of telemetry columns, and its age.
#[test]
fn measurements_are_what_sensors_have_delivered_last() {
    let folder = ScratchFolder::new("flight-code-measurements");
    let sensors = "tracker | star_tracker\ntachometers | tachometers\n\ngyro | rate_gyro\n";
    let [tracker, tachometers, gyro] = [0, 13, 26].map(|first| MEASURED + 8 * first);
    let parts = [
        copied(tracker, REPORTED, 6),
        copied(tachometers, REPORTED + 48, 4),
        copied(gyro, REPORTED + 80, 4),
        vec![0x0b],
    ];
    let text: String = (0..14).map(|k| format!("n{k} | 1 | Number {k}\n")).collect();
    let module = module(sensors, String::leak(text), &parts.concat());
    // sensors of three periods; the gyro measures twice a control period
    let campaign =
        with(&folder, &module.bytes()).replace("kind = \"rate_gyro\"", "kind = \"rate_gyro\"\nperiod_s = 0.125");
    let plan = plan_in(&folder, &campaign.replace("kind = \"tachometers\"", "kind = \"tachometers\"\nperiod_s = 1.0"));
    let run = single(&plan, 5);
    let columns = |prefix: &str, parts: &[&str], suffix: &str| -> Vec<String> {
        parts.iter().map(|part| format!("{prefix}_{part}{suffix}")).collect()
    };
    let told = |first: usize, count: usize| -> Vec<Vec<f64>> {
        (first..first + count).map(|k| recorded(&run, &format!("module_n{k}"))).collect()
    };
    let of_sensors = [
        (told(0, 5), columns("measured_q_es", &["w", "x", "y", "z"], ""), [0.5, 0.25]),
        (told(6, 4), columns("measured_rate", &["w1", "w2", "w3"], "_rad_s"), [1.0, 0.0]),
        (told(10, 4), columns("measured_rate_s", &["x", "y", "z"], "_rad_s"), [0.125, 0.0]),
    ];
    for (told, names, [period, latency]) in of_sensors {
        let delivered: Vec<Vec<f64>> = names.iter().map(|name| recorded(&run, name)).collect();
        let (mut last, mut when) = (vec![0.0; names.len()], f64::NAN);
        for (tick, time) in run.telemetry.times.iter().enumerate() {
            if !delivered[0][tick].is_nan() {
                last = delivered.iter().map(|column| column[tick]).collect();
                when = time - latency;
            }
            let age = if when.is_nan() { -1.0 } else { time - when };
            assert!((told[0][tick] - age).abs() < 1e-9, "{names:?} at {time}: {} is not {age}", told[0][tick]);
            assert!(age < period + latency, "{names:?} at {time}");
            let found: Vec<f64> = told[1..].iter().map(|column| column[tick]).collect();
            assert_eq!(found, last, "{names:?} at {time}");
        }
        assert!(!when.is_nan() && told[0][0] <= 0.0, "{names:?}");
    }
    assert!(recorded(&run, "module_n5").iter().all(|beyond| *beyond == 0.0));
    assert_eq!(recorded(&run, "module_n0")[..5], [-1.0, 0.25, 0.5, 0.25, 0.5]);
}

/// Law: telemetry is a column of time series, and two of rows: the last value and the largest magnitude.
#[test]
fn telemetry_is_columns() {
    let folder = ScratchFolder::new("flight-code-telemetry");
    let rate = [copied(INPUT + 8 * 8, REPORTED, 3), copied(INPUT, REPORTED + 24, 1), vec![0x0b]].concat();
    let text = "x_rad_s | rad/s | Rate about s1\ny_rad_s | rad/s | Rate about s2\nz_rad_s | rad/s | Rate about \
        s3\nclock_s | s | Time\n";
    let campaign = with(&folder, &module("", text, &rate).bytes());
    let judged =
        "[[require]]\nobservable = \"module_x_max_rad_s\"\nfraction = 0.9\nat_most = \"1 deg/s\"\nconfidence = 0.9\n";
    let plan = plan_in(&folder, &[&campaign, judged].concat());
    let run = single(&plan, 4);
    for axis in ["x", "y", "z"] {
        let told = recorded(&run, &format!("module_{axis}_rad_s"));
        assert_eq!(told, recorded(&run, &format!("estimated_omega_se_s_{axis}_rad_s")));
        let judged = &told[..told.len() - 1];
        assert_eq!(value(&run, &format!("module_{axis}_final_rad_s")), judged[judged.len() - 1]);
        let most = judged.iter().fold(0.0_f64, |most, rate| most.max(rate.abs()));
        assert_eq!(value(&run, &format!("module_{axis}_max_rad_s")), most);
    }
    assert_eq!(value(&run, "module_clock_final_s"), 179.75);
    let column =
        plan.request().columns().into_iter().find(|column| column.quantity.name() == "module_x_max_rad_s").unwrap();
    assert_eq!(column.quantity.unit(), "rad/s");
    assert!(column.quantity.meaning().starts_with("Rate about s1: largest magnitude"), "{}", column.quantity.meaning());
    let none = plan_in(&folder, &with(&folder, &Assembled::with_step(&[0x0b]).bytes()));
    assert!(names(&none).iter().all(|name| !name.starts_with("module_")));
}

/// Law: telemetry that is not finite is null where it stands, in the largest magnitude, and as the last value.
#[test]
fn telemetry_that_is_not_finite_is_null() {
    let folder = ScratchFolder::new("flight-code-telemetry-null");
    let number = |value: f64| [vec![0x44], value.to_le_bytes().to_vec()].concat();
    let time = [constant(INPUT), vec![0x2b, 3, 0]].concat();
    let step = |value: f64, end: f64, then: &[u8]| {
        let is_between = [time.clone(), number(2.0), vec![0x66], time.clone(), number(end), vec![0x63, 0x71]].concat();
        let otherwise =
            [vec![0x04, 0x40], constant(REPORTED), number(value), vec![0x39, 3, 0], then.to_vec(), vec![0x0b, 0x0b]]
                .concat();
        [copied(INPUT, REPORTED, 1), is_between, otherwise].concat()
    };
    let fly = |step: &[u8]| {
        let campaign = with(&folder, &module("", "clock_s | s | Time\n", step).bytes());
        let run = single(&plan_in(&folder, &campaign.replace("\"3 min\"", "\"4 s\"")), 1);
        let names = ["module_clock_final_s", "module_clock_max_s", "failure"];
        (names.map(|name| value(&run, name)), recorded(&run, "module_clock_s"))
    };
    let end = 3.75;
    for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let ([last, most, failure], series) = fly(&step(value, 3.0, &[]));
        assert!(last == end && most.is_nan() && failure == 0.0, "{value}: {last} {most} {failure}");
        let nulls: Vec<usize> = (0..series.len()).filter(|tick| series[*tick].is_nan()).collect();
        assert_eq!(nulls, (8..12).collect::<Vec<_>>(), "{value}");
        let ([last, most, failure], _) = fly(&step(value, 1e9, &[]));
        assert!(last.is_nan() && most.is_nan() && failure == 0.0, "{value}: {last} {most} {failure}");
    }
    let ([last, most, _], _) = fly(&step(-50.0, 3.0, &[]));
    assert_eq!([last, most], [end, 50.0]);
    let ([last, most, failure], series) = fly(&step(-50.0, 3.0, &[0x00]));
    assert!(last == 1.75 && most == 1.75 && failure == 7.0, "{last} {most} {failure}");
    assert!(series.len() == 9 && series[8].is_nan(), "{series:?}");
}

#[test]
fn what_is_declared_is_checked() {
    let sound = module("gyro | rate_gyro\n", "error_rad | rad | Error\n", &[0x0b]);
    let sensors = |text: &'static str| sound.changed(|m| m.tables[0] = Some(text));
    let telemetry = |text: &'static str| sound.changed(|m| m.tables[1] = Some(text));
    let many: &'static str = String::leak((0..33).map(|k| format!("n{k} | 1 | Number\n")).collect());
    let cases = vec![
        (
            sound.changed(|m| m.places[0] = 1),
            "it exports spindrift_measurements, which interface 2 has, and its interface is 1",
        ),
        (sound.changed(|m| (m.places[0], m.tables[0]) = (1, None)), "it exports spindrift_telemetry, which"),
        (sound.changed(|m| m.places[0] = 3), "its interface is 3, and this version of spindrift has 1 and 2"),
        (
            sound.changed(|m| m.misnamed = "spindrift_measurements"),
            "one of spindrift_measurements and spindrift_measurement_table",
        ),
        (
            sound.changed(|m| m.misnamed = "spindrift_measurement_table"),
            "one of spindrift_measurements and spindrift_measurement_table",
        ),
        (
            sound.changed(|m| m.misnamed = "spindrift_telemetry_table"),
            "one of spindrift_telemetry and spindrift_telemetry_table",
        ),
        (sound.changed(|m| m.places[3] = 65_536 - 8 * 13 + 1), "spindrift_measurements returns 65433, and 13 numbers"),
        (sound.changed(|m| m.places[4] = 65_529), "spindrift_telemetry returns 65529, and 1 numbers"),
        (sensors("gyro\n"), "\"gyro\" is not of the form \"name | kind\""),
        (sensors("gyro | rate_gyro\ngyro | rate_gyro\n"), "\"gyro\" stands in it twice"),
        (
            sensors("giro | rate_gyro\n"),
            "it wants \"giro\", a rate_gyro; there is \"gyro\", a rate_gyro; \"tracker\", a star_tracker",
        ),
        (sensors("gyro | star_tracker\n"), "it wants \"gyro\", a star_tracker; there is \"gyro\", a rate_gyro"),
        (sensors("\x1b[31mgyro | rate_gyro\n"), "its text has control characters"),
        (telemetry("error_rad | Error\n"), "\"error_rad | Error\" is not of the form \"key | unit | meaning\""),
        (telemetry("Error | 1 | Error\n"), "\"Error\" is not a key"),
        (telemetry("error | rad | Error\n"), "the key \"error\" does not end in its unit, as in error_rad of \"rad\""),
        (telemetry("error_rad | 1 | Error\n"), "\"error_rad\" ends in \"rad\", and says \"1\""),
        (telemetry("error_deg | deg | Error\n"), "\"error_deg\" ends in \"1\", and says \"deg\""),
        (telemetry(many), "33 lines are more than 32"),
    ];
    refused("flight-code-declared", cases);
    let folder = ScratchFolder::new("flight-code-declared-soundly");
    let plan = plan_in(&folder, &with(&folder, &sound.bytes()));
    assert_eq!(column(&plan, &rows(&plan, Isa::best(), 0, 3), "failure"), [0.0; 3]);
}
