//! Events that end runs: the row is that of a campaign of that duration, with the final state of closed forms.

use super::whole_rows::{SPREAD, column, event, free_body, names, near_rounding, own_rows, plan, precession, rows};
use crate::prelude::*;

const ENDS: &str = "ends_run = true\n";

/// Law: a run ends where s3 has left its direction by alpha, sin(alpha/2) = sin(theta) sin(Omega t/2).
#[test]
fn a_free_body_ends_in_the_state_of_its_closed_form() {
    let (rate, angle) = precession();
    for value in [0.1_f64, 0.5, 1.0] {
        let end = 2.0 / rate * ((0.5 * value).sin() / angle.sin()).asin();
        let events = event("late", "spin_axis_angle_rad", value + 0.05, ENDS)
            + &event("tipped", "spin_axis_angle_rad", value, ENDS)
            + &event("before", "spin_axis_angle_rad", value - 0.05, "")
            + &event("never", "spin_axis_angle_rad", value + 0.01, "");
        for method in Method::ALL {
            let written = near_rounding(method);
            let plan = plan(&(free_body(&written, 121, 30.0) + &events));
            let rows = rows(&plan, Isa::best(), 0, 1);
            let found = |name: &str| column(&plan, &rows, name)[0];
            let bound = if method.name() == "runge_kutta_4" { 1e-9 } else { 1e-10 };
            let phase = (30.0 - 20.0) / 30.0 * 0.6 * end;
            for (name, expected) in [
                ("tipped_time_s", end),
                ("before_time_s", 2.0 / rate * ((0.5 * (value - 0.05)).sin() / angle.sin()).asin()),
                ("spin_axis_angle_final_rad", value),
                ("spin_axis_angle_max_rad", value),
                ("omega_se_s_x_final_rad_s", 0.3 * phase.cos()),
                ("omega_se_s_y_final_rad_s", -0.3 * phase.sin()),
                ("omega_se_s_z_final_rad_s", 0.6),
            ] {
                let found = found(name);
                assert!((found - expected).abs() <= bound, "{} {name} {value}: {found} {expected}", method.name());
            }
            assert_eq!((rows.statuses()[0], found("ended_by")), (Status::Done, 2.0), "late is 1, tipped 2");
            let counts = ["late", "tipped", "before", "never"].map(|event| found(&format!("{event}_count")));
            assert_eq!(counts, [0.0, 1.0, 1.0, 0.0]);
            assert!(found("late_time_s").is_nan() && found("never_time_s").is_nan());
        }
    }
}

/// Law: the row of a run that ends at 17.5 s is that of a campaign of 17.5 s with the same points, in every column.
#[test]
fn an_ended_run_is_one_of_that_duration() {
    let text = free_body("", 121, 30.0).replace("[0.3, 0.0, 0.6]", "[0.0, 0.0, 0.6]")
        + "[environment]\nbody_torque_n_m = [0, 0, -0.4]\n"
        + &event("half", "angular_rate_rad_s", 0.45, "");
    let ends =
        plan(&(text.clone() + &event("slow", "angular_rate_rad_s", 0.25, "direction = \"falling\"\nends_run = true")));
    let ended = rows(&ends, Isa::best(), 0, 1);
    let off = |duration: &str, points: usize| {
        let short = text.replace("60.0", duration).replace("points = 121", &format!("points = {points}"));
        let short = plan(&short);
        let rows = rows(&short, Isa::best(), 0, 1);
        let of = |name: &String| {
            let [a, b] = [column(&ends, &ended, name)[0], column(&short, &rows, name)[0]];
            if a.to_bits() == b.to_bits() || a.abs().max(b.abs()) < 1e-13 {
                0.0
            } else {
                (a - b).abs() / a.abs().max(b.abs())
            }
        };
        let names = names(&short);
        names.into_iter().filter(|name| !name.starts_with("steps") && of(name) > 1e-9).collect::<Vec<_>>()
    };
    assert_eq!(off("17.5", 36), Vec::<String>::new());
    assert!(off("17.0", 35).len() > 5);
    assert!((column(&ends, &ended, "slow_time_s")[0] - 17.5).abs() < 1e-11);
    assert!((column(&ends, &ended, "half_time_s")[0] - 7.5).abs() < 1e-11);
}

#[test]
fn single_runs_end_where_their_rows_do() {
    let text = free_body("", 121, 30.0) + SPREAD + &event("tipped", "spin_axis_angle_rad", 0.7, ENDS);
    let plan = plan(&text);
    let all = rows(&plan, Isa::best(), 0, 12);
    for (sample, time) in column(&plan, &all, "tipped_time_s").iter().enumerate() {
        let end = if time.is_nan() { 60.0 } else { *time };
        for grid in [plan.grid.clone(), Grid::uniform(60.0, 777)] {
            let run = single_on(&plan, sample as u64, grid);
            assert_eq!((run.grid.duration(), run.outcome.time, run.outcome.points), (end, end, run.grid.points()));
        }
    }
}

/// Law: a control loop ends at the tick of the crossing with the columns of a campaign of that duration, but for the
/// error that its pilots, which fly to the end, show.
#[test]
fn loops_end_as_in_a_campaign_of_that_duration() {
    let shipped = SLEW_CLOSED.replace("points = 181", "points = 721");
    let ends = plan(
        &(shipped.clone() + &event("turned", "pointing_error_rad", 0.3, "direction = \"falling\"\nends_run = true")),
    );
    let ended = own_rows(&ends, 12);
    for row in 0..8 {
        let end = column(&ends, &ended, "turned_time_s")[row];
        assert!((end / 0.25 - (end / 0.25).round()).abs() < 1e-12 && end > 30.0 && end < 180.0, "{end} is a tick");
        assert_eq!(column(&ends, &ended, "ended_by")[row], 2.0, "0 duration, 1 mission");
        let points = (end / 0.25).round() as usize + 1;
        let short = shipped.replace("duration_s = \"3 min\"", &format!("duration_s = {end:?}"));
        let short = plan(&short.replace("points = 721", &format!("points = {points}")));
        let rows = rows(&short, Isa::best(), row as u64, 1);
        let off = |name: &String| {
            let [a, b] = [column(&ends, &ended, name)[row], column(&short, &rows, name)[0]];
            let is_same = a.to_bits() == b.to_bits() || (a - b).abs() <= 1e-9 * a.abs().max(b.abs()) + 1e-15;
            (!is_same).then(|| format!("{name}: {a} and {b}"))
        };
        let is_compared = |name: &String| !name.starts_with("nutation_angle") && name != "state_error_estimate";
        let compared = names(&short).into_iter().filter(is_compared);
        let wrong: Vec<String> = compared.filter_map(|name| off(&name)).collect();
        assert!(wrong.is_empty(), "sample {row} at {end} s: {wrong:#?}");
        assert!(single(&ends, row as u64).telemetry.times.last().is_some_and(|last| *last <= end));
    }
    let fast = plan(&(shipped + &event("fast", "angular_rate_rad_s", 0.005, ENDS)));
    let fast_rows = rows(&fast, Isa::best(), 0, 8);
    for row in 0..8 {
        let [rate, end] = ["angular_rate_final_rad_s", "fast_time_s"].map(|name| column(&fast, &fast_rows, name)[row]);
        assert!((rate - 0.005).abs() < 1e-12, "{rate} at {end} s");
    }
}

#[test]
fn a_run_may_fail_after_its_end() {
    let text = free_body("method = \"dormand_prince\"\ntolerance = 1e-12\nmax_steps = 200", 121, 30.0);
    let fails = plan(&text);
    assert_eq!(rows(&fails, Isa::best(), 0, 1).statuses(), [Status::StepLimit]);
    let ends = plan(&(text.clone() + &event("tipped", "spin_axis_angle_rad", 0.5, ENDS)));
    let found = rows(&ends, Isa::best(), 0, 1);
    assert_eq!((found.statuses(), found.reasons().len()), (&[Status::Done][..], 0));
    let late = plan(&(text + &event("tipped", "spin_axis_angle_rad", 3.0, ENDS)));
    assert_eq!(rows(&late, Isa::best(), 0, 1).statuses(), [Status::StepLimit]);
}

#[test]
fn bands_lose_a_run_at_its_end() {
    let text = free_body("", 121, 30.0) + SPREAD + "[bands]\npoints = 121\n";
    let ends = plan(&(text + &event("tipped", "spin_axis_angle_rad", 0.7, ENDS)));
    let all = rows(&ends, Isa::best(), 0, 40);
    let times = &column(&ends, &all, "tipped_time_s")[1..];
    let bands = all.bands().unwrap();
    let layout = bands.layout();
    let angle = layout.series.iter().position(|(quantity, _)| quantity.name() == "spin_axis_angle_rad").unwrap();
    let nominal_end = column(&ends, &all, "tipped_time_s")[0];
    for (point, time) in layout.times.iter().enumerate() {
        let (runs, buckets) = bands.column(angle * layout.times.len() + point);
        let ended = times.iter().filter(|end| **end < *time).count() as u64;
        assert_eq!((runs.without, buckets.map(|(_, count)| count).sum::<u64>()), (ended, 39 - ended), "{time} s");
        let most = runs.extremes.map_or(0.0, |[_, most]| 2.0 * most.atan());
        assert!(most <= 0.7 + 1e-9, "{most} at {time} s");
        assert_eq!(layout.nominal[angle * layout.times.len() + point].is_nan(), nominal_end < *time);
    }
    assert!(times.iter().filter(|time| time.is_finite()).count() > 20);
}
