use super::whole_rows::{SPREAD, column, event, free_body, near_rounding, plan, precession, rows};
use crate::prelude::*;

fn free(method: &str, points: usize, middle: f64, more: &str) -> Plan {
    plan(&(free_body(method, points, middle) + more))
}

pub fn extreme(name: &str, quantity: &str, more: &str) -> String {
    format!("[[extreme]]\nname = \"{name}\"\nquantity = \"{quantity}\"\n{more}\n")
}

/// Law: s3 of a free body leaves its direction by alpha with sin(alpha/2) = sin(theta) |sin(Omega t/2)|.
#[test]
fn extremes_of_a_free_body_are_those_of_its_precession() {
    let (rate, angle) = precession();
    let alpha = |time: f64| 2.0 * (angle.sin() * (0.5 * rate * time).sin().abs()).asin();
    let up = 2.0 / rate * ((0.5 * 0.5_f64).sin() / angle.sin()).asin();
    let period = 2.0 * std::f64::consts::PI / rate;
    let late = 60.0 - 0.2 * period - up;
    assert!(alpha(60.0) < alpha(60.0 - 0.2 * period) && (60.0 / period).fract() > 0.7, "{}", 60.0 / period);
    let more = event("up", "spin_axis_angle_rad", 0.5, "direction = \"rising\"")
        + &event("never", "spin_axis_angle_rad", 3.0, "")
        + &extreme("most_rad", "spin_axis_angle_rad", "")
        + &extreme("most_after_deg", "180 / pi * spin_axis_angle_rad", "after = \"up\"\ndelay_s = 1")
        + &extreme("least_rad", "spin_axis_angle_rad", "which = \"min\"\nafter = \"up\"")
        + &extreme("last_rad", "spin_axis_angle_rad", &format!("after = \"up\"\ndelay_s = {late:?}"))
        + &extreme("none_rad", "spin_axis_angle_rad", "after = \"never\"")
        + &extreme("beyond_rad", "spin_axis_angle_rad", "delay_s = 60.001");
    for method in Method::ALL {
        let written = near_rounding(method);
        let plan = free(&written, 62, 30.0, &more);
        let rows = rows(&plan, Isa::best(), 0, 1);
        let found = |name: &str| column(&plan, &rows, name)[0];
        let bound = if method.name() == "runge_kutta_4" { 1e-9 } else { 1e-11 };
        for (name, expected, bound) in [
            ("most_rad", 2.0 * angle, bound),
            ("most_after_deg", (2.0 * angle).to_degrees(), 60.0 * bound),
            ("least_rad", 0.0, 1e-6),
            ("last_rad", alpha(up + late), 10.0 * bound),
        ] {
            let found = found(name);
            assert!((found - expected).abs() <= bound, "{} {name}: {found} for {expected}", method.name());
        }
        assert!(found("none_rad").is_nan() && found("beyond_rad").is_nan());
        assert!(found("spin_axis_angle_max_rad") < 2.0 * angle - 1e-5);
    }
}

/// Law: an extreme is a value that the quantity takes, to the bit.
#[test]
fn extremes_are_values_of_the_quantity() {
    let more = SPREAD.to_owned()
        + &extreme("step", "if(spin_axis_angle_rad > 0.05, 1, 0)", "")
        + &extreme("third", "if(spin_axis_angle_rad > 0.05, 1, 0) / 3", "")
        + &extreme("lowest", "if(spin_axis_angle_rad > 0.05, 1, 0.7)", "which = \"min\"")
        + &extreme("plateau", "min(spin_axis_angle_rad, 0.05)", "")
        + &extreme("kink", "0.1 - abs(spin_axis_angle_rad - 0.1)", "")
        + &extreme("end", "angular_rate_rad_s", "delay_s = 60")
        + &extreme("root", "sqrt(0.05 - spin_axis_angle_rad)", "")
        + &extreme("at_start", "sqrt(0.05 - spin_axis_angle_rad)", "which = \"min\"\ndelay_s = 61");
    for method in ["method = \"auto\"", "method = \"dormand_prince\"\ntolerance = 1e-9"] {
        let plan = free(method, 61, 26.0, &more);
        let rows = rows(&plan, Isa::best(), 0, 40);
        let of = |name: &str, row: usize| column(&plan, &rows, name)[row];
        for row in 0..40 {
            assert!(of("spin_axis_angle_max_rad", row) > 0.2, "sample {row} tumbles");
            assert_eq!([of("step", row), of("third", row), of("lowest", row)], [1.0, 1.0 / 3.0, 0.7], "sample {row}");
            assert_eq!(of("plateau", row), 0.05, "sample {row}");
            assert!(of("kink", row) <= 0.1 && of("kink", row) > 0.1 - 1e-9, "sample {row}: {}", of("kink", row));
            let run = single(&plan, row as u64);
            let rate = run.table.at::<3>(StateField::Rate, 60).map(|rate| rate * rate).iter().sum::<f64>().sqrt();
            assert!((of("end", row) - rate).abs() < 1e-15, "sample {row}: {} for {rate}", of("end", row));
            assert!(of("root", row).is_nan() && of("at_start", row).is_nan(), "sample {row}");
        }
    }
}

/// Law: extremes from points a second apart are those of points 500 times as near, and no smaller.
#[test]
fn extremes_are_those_of_many_points() {
    let more = SPREAD.to_owned()
        + &extreme("angle_rad", "spin_axis_angle_rad", "")
        + &extreme("rate_rad_s", "angular_rate_rad_s", "")
        + &extreme("least_rate_rad_s", "angular_rate_rad_s", "which = \"min\"");
    let coarse = free("", 61, 26.0, &more);
    let found = rows(&coarse, Isa::best(), 0, 40);
    let fine = free("", 30_001, 26.0, SPREAD);
    let truth = rows(&fine, Isa::best(), 0, 40);
    let mut beyond = 0;
    for row in 0..40 {
        for (name, dense) in [("angle_rad", "spin_axis_angle_max_rad"), ("rate_rad_s", "angular_rate_max_rad_s")] {
            let [found, dense] = [column(&coarse, &found, name)[row], column(&fine, &truth, dense)[row]];
            let bound = 1e-6 / (std::f64::consts::PI - found).clamp(1e-3, 1.0);
            assert!(found >= dense - 1e-12 && found - dense < bound, "sample {row}, {name}: {found} and {dense}");
        }
        let sampled = column(&coarse, &found, "angular_rate_max_rad_s")[row];
        beyond += usize::from(column(&coarse, &found, "rate_rad_s")[row] > sampled + 1e-6);
        assert!(column(&coarse, &found, "least_rate_rad_s")[row] <= column(&coarse, &found, "rate_rad_s")[row]);
    }
    assert!(beyond > 20, "{beyond} beyond the points");
}

#[test]
fn extremes_of_loops_are_at_ticks() {
    let shipped = SLEW_CLOSED;
    let more = event("turned", "pointing_error_rad", 0.5, "direction = \"falling\"")
        + &extreme("error_max_rad", "pointing_error_rad", "after = \"turned\"\ndelay_s = 30")
        + &extreme("later_max_rad", "pointing_error_rad", "after = \"turned\"\ndelay_s = 60");
    let of = |points: usize| {
        let plan = plan(&(shipped.replace("points = 181", &format!("points = {points}")) + &more));
        let rows = rows(&plan, Isa::best(), 0, 12);
        let errors = ["error_max_rad", "later_max_rad"].map(|name| column(&plan, &rows, name).to_vec());
        (errors, column(&plan, &rows, "turned_time_s").to_vec())
    };
    let (every, _) = of(721);
    for points in [46, 100] {
        assert_eq!(of(points).0, every, "{points}");
    }
    let [errors, later] = &every;
    assert!(errors.iter().zip(later).all(|(error, later)| later <= error && *later > 0.0), "{every:?}");
    let plan = plan(&(shipped.replace("points = 181", "points = 721") + &more));
    let (_, turned) = of(721);
    for sample in 0..12 {
        let run = single(&plan, sample as u64);
        let is_error = |(series, _): &&(Series, Vec<f64>)| *series == Series::PointingError;
        let (_, values) = run.series.iter().find(is_error).unwrap();
        let from = turned[sample] + 30.0;
        let ticks = plan.grid.times().iter().zip(values).filter(|(time, _)| **time >= from - 1e-9);
        let most = ticks.fold(0.0, |most: f64, (_, value)| most.max(*value));
        assert_eq!(most, errors[sample], "sample {sample}");
    }
}
