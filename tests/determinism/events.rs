//! Events: times at which quantities of a run cross values.

use crate::prelude::*;

use super::extremes::extreme;
use super::whole_rows::{SPREAD, column, event, free_body, names, near_rounding, own_rows, plan, precession, rows};

fn free(method: &str, points: usize, more: &str) -> Plan {
    plan(&(free_body(method, points, 30.0) + more))
}

/// Law: s3 leaves its direction by alpha with sin(alpha/2) = sin(theta) sin(Omega t/2).
#[test]
fn crossings_of_a_free_body_are_at_the_times_of_its_precession() {
    let (rate, angle) = precession();
    let period = 2.0 * PI / rate;
    for value in [0.1_f64, 0.5, 1.0] {
        let up = 2.0 / rate * ((0.5 * value).sin() / angle.sin()).asin();
        let turns = (60.0 / period).floor();
        let last_up = if turns * period + up < 60.0 { turns * period + up } else { (turns - 1.0) * period + up };
        let events = event("up", "spin_axis_angle_rad", value, "direction = \"rising\"")
            + &event("down", "spin_axis_angle_rad", value, "direction = \"falling\"")
            + &event("last_up", "spin_axis_angle_rad", value, "direction = \"rising\"\nwhich = \"last\"")
            + &event("any", "180 / pi * spin_axis_angle_rad", value * 180.0 / PI, "")
            + &event("never", "spin_axis_angle_rad", 3.0, "");
        for method in Method::ALL {
            let written = near_rounding(method);
            let plan = free(&written, 121, &events);
            let rows = rows(&plan, Isa::best(), 0, 1);
            let found = |name: &str| column(&plan, &rows, name)[0];
            let bound = if method.name() == "runge_kutta_4" { 1e-9 } else { 1e-10 };
            for (name, expected) in [("up", up), ("down", period - up), ("last_up", last_up), ("any", up)] {
                let time = found(&format!("{name}_time_s"));
                let off = (time - expected).abs() / expected.max(1.0);
                assert!(off <= bound, "{} {name} at {value}: {time} for {expected}", method.name());
            }
            let ups = (0..100).filter(|turn| f64::from(*turn) * period + up < 60.0).count() as f64;
            let downs = (1..100).filter(|turn| f64::from(*turn) * period - up < 60.0).count() as f64;
            assert_eq!([found("up_count"), found("down_count"), found("any_count")], [ups, downs, ups + downs]);
            assert!(found("never_time_s").is_nan() && found("never_count") == 0.0);
        }
    }
}

#[test]
fn a_rate_under_torque_crosses_where_it_must() {
    let of = |value: f64, more: &str| {
        let text = free_body("", 62, 30.0).replace("[0.3, 0.0, 0.6]", "[0.0, 0.0, 0.6]")
            + "[environment]\nbody_torque_n_m = [0, 0, -0.4]\n"
            + &event("spin", "angular_rate_rad_s", value, more);
        let plan = plan(&text);
        let rows = rows(&plan, Isa::best(), 0, 1);
        (column(&plan, &rows, "spin_time_s")[0], column(&plan, &rows, "spin_count")[0])
    };
    for (value, more, time, count) in [
        (0.25, "direction = \"falling\"", 17.5, 1.0),
        (0.25, "direction = \"rising\"", 42.5, 1.0),
        (0.25, "direction = \"rising\"\nwhich = \"stays\"", 42.5, 1.0),
        (0.25, "which = \"last\"", 42.5, 2.0),
        (0.7, "direction = \"falling\"\nwhich = \"stays\"", 0.0, 0.0),
        (0.25, "direction = \"falling\"\nwhich = \"stays\"", f64::NAN, 1.0),
        (0.59, "", 0.5, 2.0),
        (0.6, "", f64::NAN, 0.0),
        (0.6, "direction = \"falling\"\nwhich = \"stays\"", 0.0, 0.0),
        (0.6, "direction = \"rising\"\nwhich = \"stays\"", f64::NAN, 0.0),
    ] {
        let found = of(value, more);
        assert_eq!(found.1, count, "{value} {more}");
        let is_right = if time.is_nan() { found.0.is_nan() } else { (found.0 - time).abs() < 1e-11 };
        assert!(is_right, "{value} {more}: {}", found.0);
    }
    assert_eq!(of(0.001, "").1, 0.0);
}

#[test]
fn a_start_at_the_value_is_no_crossing() {
    let (rate, angle) = precession();
    let up = 2.0 / rate * ((0.5 * 0.5_f64).sin() / angle.sin()).asin();
    let turns = (60.0 * rate / (2.0 * PI)).floor();
    let events = event("zero", "spin_axis_angle_rad", 0.0, "")
        + &event("rounding", "spin_axis_angle_rad", 1e-16, "")
        + &event("shifted", "2 - 3 * spin_axis_angle_rad", 2.0, "")
        + &event("step", "if(spin_axis_angle_rad > 0.5, 1, 0)", 0.5, "direction = \"rising\"");
    for method in Method::ALL {
        let plan = free(&near_rounding(method), 121, &events);
        let rows = rows(&plan, Isa::best(), 0, 1);
        let found = |name: &str| column(&plan, &rows, name)[0];
        for name in ["zero", "rounding", "shifted"] {
            let found = (found(&format!("{name}_count")), found(&format!("{name}_time_s")).is_nan());
            assert_eq!(found, (0.0, true), "{} {name}", method.name());
        }
        assert!((found("step_time_s") - up).abs() < 1e-8, "{}: {} for {up}", method.name(), found("step_time_s"));
        assert!((found("step_count") - turns).abs() <= 1.0);
    }
}

#[test]
fn what_is_not_a_number_crosses_nothing() {
    let events = event("never", "ln(-1 - spin_axis_angle_rad)", 0.0, "")
        + &event("sometimes", "sqrt(0.5 - spin_axis_angle_rad)", 0.3, "")
        + &event("number", "sqrt(0.5 + spin_axis_angle_rad)", 0.8, "");
    let plan = free("method = \"auto\"", 121, &events);
    let found = rows(&plan, Isa::best(), 0, 1);
    for name in ["never", "sometimes"] {
        for of in ["time_s", "count"] {
            assert!(column(&plan, &found, &format!("{name}_{of}"))[0].is_nan(), "{name}_{of}");
        }
    }
    assert!(column(&plan, &found, "number_count")[0] >= 1.0);
    let ends = |value| event("condition", "if(sqrt(0.5 - spin_axis_angle_rad) < 0.3, 1, 0)", value, "ends_run = true");
    for (value, ended_by, count) in [(0.5, 1.0, 1.0), (1.5, 0.0, f64::NAN)] {
        let plan = free("method = \"auto\"", 121, &ends(value));
        let found = rows(&plan, Isa::best(), 0, 1);
        let of = |name: &str| column(&plan, &found, name)[0];
        assert_eq!((of("ended_by"), of("condition_count").to_bits()), (ended_by, f64::to_bits(count)));
        let row: Vec<u64> = (0..names(&plan).len()).map(|index| found.observable(index)[0].to_bits()).collect();
        assert!(single(&plan, 0).row.iter().map(|value| value.to_bits()).eq(row), "{value}");
    }
}

#[test]
fn events_extremes_and_ends_are_bits_of_their_row() {
    let late = event("last", "nutation_angle_rad - 0.2 * spin_axis_angle_rad", 0.4, "which = \"last\"");
    let first = |more: &str| event("first", "spin_axis_angle_rad", 0.7, more);
    let extremes =
        extreme("angle_rad", "spin_axis_angle_rad - 0.1 * angular_rate_rad_s", "after = \"first\"\ndelay_s = 3")
            + &extreme("least_rad_s", "angular_rate_rad_s", "which = \"min\"");
    for (points, middle, before, more, sometimes) in [
        (121, 30.0, "", first("") + &late, "first_time_s"),
        (61, 26.0, &*first(""), extremes, "angle_rad"),
        (121, 30.0, &late, first("ends_run = true"), "first_time_s"),
    ] {
        for method in ["method = \"auto\"", "method = \"dormand_prince\"\ntolerance = 1e-9"] {
            let text = free_body(method, points, middle) + SPREAD + before;
            let (with, without) = (plan(&(text.clone() + &more)), plan(&text));
            let (all, others) = (own_rows(&with, 40), rows(&without, Isa::best(), 0, 40));
            let values = column(&with, &all, sometimes);
            let found = values.iter().filter(|value| value.is_finite()).count();
            assert!(found > 20 && found < 40, "{sometimes}: {values:?}");
            let ended = column(&with, &all, if more.contains("ends_run") { "first_time_s" } else { "steps" });
            for name in names(&without) {
                let [with, without] = [column(&with, &all, &name), column(&without, &others, &name)];
                let has_ended = |row: usize| more.contains("ends_run") && ended[row].is_finite();
                let same = |row: &usize| has_ended(*row) || with[*row].to_bits() == without[*row].to_bits();
                assert!((0..40).all(|row| same(&row)), "{name}");
            }
        }
    }
}

#[test]
fn quantities_of_loops_cross_at_ticks() {
    let shipped = SLEW_CLOSED;
    let events = event("settled", "pointing_error_rad", 0.01, "direction = \"falling\"\nwhich = \"stays\"")
        + &event("turned", "pointing_error_rad", 0.5, "direction = \"falling\"");
    let of = |points: usize| {
        let plan = plan(&(shipped.replace("points = 181", &format!("points = {points}")) + &events));
        let rows = rows(&plan, Isa::best(), 0, 12);
        [column(&plan, &rows, "settled_time_s").to_vec(), column(&plan, &rows, "turned_time_s").to_vec()]
    };
    let times = of(181);
    for points in [46, 720, 100] {
        assert_eq!(of(points), times, "{points}");
    }
    for time in times.iter().flatten() {
        assert!((time / 0.25 - (time / 0.25).round()).abs() < 1e-12 && *time > 30.0, "{time} is a tick");
    }
}
