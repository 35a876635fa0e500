//! Events: when quantities of a run cross values. Times are those of closed forms, by every method; bits are a row's
//! own.

use std::f64::consts::PI;

use super::whole_rows::{SPREAD, column, event, near_rounding, plan, rows};
use spindrift::campaign::Plan;
use spindrift::ensemble::{Rows, SingleRun};
use spindrift::math::Isa;
use spindrift::propagation::Method;
use spindrift::sampling::SampleId;

/// A free body with an axis of symmetry: moments 30, 30 and 20 kg m^2, which turns at 0.3 rad/s across its axis and at
/// 0.6 rad/s about it.
const FREE: &str = r#"[campaign]
name = "free"
samples = 40
seed = 3
duration_s = 60.0
[integrator]
METHOD
[observe]
points = POINTS
groups = ["attitude", "motion"]
[body]
mass_kg = 10.0
center_of_mass_m = [0, 0, 0]
principal_moments_kg_m2 = [30, 30, 20]
[initial]
angular_velocity_rad_s = [0.3, 0.0, 0.6]
"#;

fn free(method: &str, points: usize, more: &str) -> Plan {
    plan(&(FREE.replace("METHOD", method).replace("POINTS", &points.to_string()) + more))
}

/// The precession of that body about its momentum, rad/s, and the angle between both, rad.
fn precession() -> (f64, f64) {
    let (across, along): (f64, f64) = (30.0 * 0.3, 20.0 * 0.6);
    (across.hypot(along) / 30.0, across.atan2(along))
}

/// Law: s3 leaves its direction by alpha with sin(alpha/2) = sin(theta) sin(Omega t/2): its crossings of an angle are
/// located to 1e-9 of their time or better by every method, and all of them are counted.
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
            // errors of the motion itself: of order 4 with this step, else by the tolerance
            let bound = if method.name() == "runge_kutta_4" { 1e-9 } else { 1e-10 };
            for (name, expected) in [("up", up), ("down", period - up), ("last_up", last_up), ("any", up)] {
                let time = found(&format!("{name}_time_s"));
                assert!(
                    (time - expected).abs() <= bound * expected.max(1.0),
                    "{} {name} at {value}: {time} for {expected}",
                    method.name()
                );
            }
            let ups = (0..100).filter(|turn| f64::from(*turn) * period + up < 60.0).count() as f64;
            let downs = (1..100).filter(|turn| f64::from(*turn) * period - up < 60.0).count() as f64;
            assert_eq!([found("up_count"), found("down_count"), found("any_count")], [ups, downs, ups + downs]);
            assert!(found("never_time_s").is_nan() && found("never_count") == 0.0);
        }
    }
}

/// Law: the rate of a body under a constant torque about an axis is linear in time; of a body that comes to rest and
/// turns round it is |w - a t|.
#[test]
fn a_rate_under_torque_crosses_where_it_must() {
    let of = |value: f64, more: &str| {
        let text = FREE.replace("METHOD", "").replace("POINTS", "62").replace("[0.3, 0.0, 0.6]", "[0.0, 0.0, 0.6]")
            + "[environment]\nbody_torque_n_m = [0, 0, -0.4]\n"
            + &event("spin", "angular_rate_rad_s", value, more);
        let plan = plan(&text);
        let rows = rows(&plan, Isa::best(), 0, 1);
        (column(&plan, &rows, "spin_time_s")[0], column(&plan, &rows, "spin_count")[0])
    };
    // 0.6 - 0.02 t, at rest after 30 s
    for (value, more, time, count) in [
        (0.25, "direction = \"falling\"", 17.5, 1.0),
        (0.25, "direction = \"rising\"", 42.5, 1.0),
        (0.25, "direction = \"rising\"\nwhich = \"stays\"", 42.5, 1.0),
        (0.25, "which = \"last\"", 42.5, 2.0),
        (0.7, "direction = \"falling\"\nwhich = \"stays\"", 0.0, 0.0),
        (0.25, "direction = \"falling\"\nwhich = \"stays\"", f64::NAN, 1.0),
        (0.59, "", 0.5, 2.0),
        // where it starts and where it ends
        (0.6, "", f64::NAN, 0.0),
        (0.6, "direction = \"falling\"\nwhich = \"stays\"", 0.0, 0.0),
        (0.6, "direction = \"rising\"\nwhich = \"stays\"", f64::NAN, 0.0),
    ] {
        let found = of(value, more);
        assert_eq!(found.1, count, "{value} {more}");
        assert!(
            if time.is_nan() { found.0.is_nan() } else { (found.0 - time).abs() < 1e-11 },
            "{value} {more}: {}",
            found.0
        );
    }
    // nearer to the turn than two observation points: not seen, as the documents say
    assert_eq!(of(0.001, "").1, 0.0);
}

/// Law: an angle that starts at zero by rounding does not cross it, nor what it starts with; in steps of an expression
/// a crossing is where the steps are left.
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

/// Law: where the quantity is not a number at an observation point, its event has neither time nor count; a run that it
/// would end goes on. The counter-test: a quantity that is always a number has both.
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
    // a run that ends before its quantity is no number, and one that goes on to the end
    let ends = |value| event("condition", "if(sqrt(0.5 - spin_axis_angle_rad) < 0.3, 1, 0)", value, "ends_run = true");
    for (value, ended_by, count) in [(0.5, 1.0, 1.0), (1.5, 0.0, f64::NAN)] {
        let plan = free("method = \"auto\"", 121, &ends(value));
        let found = rows(&plan, Isa::best(), 0, 1);
        let of = |name: &str| column(&plan, &found, name)[0];
        assert_eq!((of("ended_by"), of("condition_count").to_bits()), (ended_by, f64::to_bits(count)));
        let single = SingleRun::new(&plan, SampleId(0), plan.grid.clone(), Isa::best()).expect("physical");
        let bits: Vec<u64> = single.row.iter().map(|value| value.to_bits()).collect();
        let row: Vec<u64> = (0..bits.len()).map(|index| found.observable(index)[0].to_bits()).collect();
        assert_eq!(bits, row, "{value}");
    }
}

/// Law: events are a row's own: the same bits alone, in any part, on every instruction set, and in a single run; and no
/// other column changes.
#[test]
fn events_are_bits_of_their_row() {
    let events = event("first", "spin_axis_angle_rad", 0.7, "")
        + &event("last", "nutation_angle_rad - 0.2 * spin_axis_angle_rad", 0.4, "which = \"last\"");
    for method in ["method = \"auto\"", "method = \"dormand_prince\"\ntolerance = 1e-9"] {
        let plan = free(method, 121, &(SPREAD.to_owned() + &events));
        let bits = |rows: &Rows, row: usize| -> Vec<u64> {
            (0..plan.request().columns().len()).map(|index| rows.observable(index)[row].to_bits()).collect()
        };
        let all = rows(&plan, Isa::best(), 0, 40);
        let times = column(&plan, &all, "first_time_s");
        assert!(times.iter().filter(|time| time.is_finite()).count() > 20, "{times:?}");
        assert!(times.iter().any(|time| time.is_nan()), "{times:?}");
        for isa in Isa::available() {
            let found = rows(&plan, isa, 0, 40);
            (0..40).for_each(|row| assert_eq!(bits(&found, row), bits(&all, row), "{}", isa.name()));
        }
        for (first, count) in [(7, 1), (11, 9), (33, 7)] {
            let part = rows(&plan, Isa::best(), first, count);
            (0..count).for_each(|row| assert_eq!(bits(&part, row), bits(&all, row + first as usize)));
        }
        for sample in [0_usize, 3, 12] {
            let single =
                SingleRun::new(&plan, SampleId(sample as u64), plan.grid.clone(), Isa::best()).expect("physical");
            let single: Vec<u64> = single.row.iter().map(|value| value.to_bits()).collect();
            assert_eq!(single, bits(&all, sample));
        }
        let without = free(method, 121, SPREAD);
        let others = rows(&without, Isa::best(), 0, 40);
        for (index, column) in without.request().columns().iter().enumerate() {
            let same =
                others.observable(index).iter().zip(all.observable(index)).all(|(a, b)| a.to_bits() == b.to_bits());
            assert!(same, "{}", column.quantity.name());
        }
    }
}

/// Law: a quantity of a control loop changes at its ticks, and its events are at ticks; whatever the observation points
/// are.
#[test]
fn quantities_of_loops_cross_at_ticks() {
    let shipped = include_str!("../../campaigns/slew_closed.toml");
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
