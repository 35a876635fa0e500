//! The ticks of a control loop: in a table over time, at the end of a run, and on every grid.

use crate::prelude::*;
use std::fmt::Write as _;

use crate::loops::closed_loops::small_craft;

fn shown(run: &SingleRun, name: &str) -> Vec<f64> {
    let place = run.telemetry.quantities.iter().position(|quantity| quantity.name() == name);
    run.telemetry.held_at(run.grid.times()).swap_remove(place.unwrap_or_else(|| panic!("no column {name}")))
}

fn estimation_errors(run: &SingleRun) -> Vec<f64> {
    let estimated = ["w", "x", "y", "z"].map(|component| shown(run, &format!("estimated_q_es_{component}")));
    let error = |point: usize| {
        let q: [f64; 4] = run.table.at(StateField::Attitude, point);
        let cosine: f64 = (0..4).map(|i| q[i] * estimated[i][point]).sum();
        let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
        2.0 * sine.atan2(cosine.abs())
    };
    (0..run.grid.points()).map(error).collect()
}

#[test]
fn a_row_shows_the_tick_of_its_time() {
    let control = "[control]\nperiod_s = 0.1\nwheels = [\"w1\", \"w2\", \"w3\"]\n[[guidance]]\nphase = \"drift\"\n";
    let text = small_craft(control, "angular_velocity_rad_s = [0.01, 0.02, -0.01]")
        .replace("duration_s = 100", "duration_s = 60")
        .replace("points = 401", "points = 601");
    let run = single(&plan(&text), 0);
    assert_eq!((run.grid.points(), run.telemetry.times.len()), (601, 601));
    let off = estimation_errors(&run);
    let worst = off.iter().copied().fold(0.0, f64::max);
    assert!(worst < 1e-7, "{worst:e} at {:?}", off.iter().position(|error| *error == worst));
    let late = run.telemetry.times.iter().zip(run.grid.times()).filter(|(tick, point)| tick > point).count();
    assert!(late > 5, "{late} ticks");
}

#[test]
fn the_last_tick_is_that_of_a_longer_run() {
    let plan = plan(SLEW_CLOSED);
    for duration in [10.0, 12.25, 20.0] {
        let flown = |duration: f64| single_on(&plan, 3, Grid::uniform(duration, 11));
        let (short, long) = (flown(duration), flown(2.0 * duration));
        let ticks = short.telemetry.times.len();
        assert!((short.telemetry.times[ticks - 1] - duration).abs() < 1e-9, "{:?}", short.telemetry.times.last());
        for (short, long) in short.telemetry.rows.iter().zip(&long.telemetry.rows) {
            let near = |a: f64, b: f64| a.is_nan() && b.is_nan() || (a - b).abs() <= 1e-13 * (1.0 + a.abs());
            assert!(short.iter().zip(long).all(|(a, b)| near(*a, *b)), "{short:?}\n{long:?}");
        }
    }
}

fn holding(duration: f64, hold: f64, more: &str) -> String {
    let mut control = String::from("[control]\nperiod_s = 0.1\nwheels = [\"w1\", \"w2\", \"w3\"]\n");
    let _ = write!(
        control,
        "[[guidance]]\nphase = \"wait\"\nuntil = \"time_s >= 0\"\nhold_s = {hold:?}\n{more}[[guidance]]\nphase = \
        \"after\"\n"
    );
    small_craft(&control, "angular_velocity_rad_s = [0.01, 0, 0]")
        .replace("duration_s = 100", &format!("duration_s = {duration:?}"))
        .replace("points = 401", "points = 2")
}

/// Law: a hold that completes exactly at the end of the run counts, and one a tick longer does not.
#[test]
fn what_ends_with_the_run_counts() {
    for ticks in [1, 3, 6, 7, 11, 23, 100] {
        let duration = f64::from(ticks) / 10.0;
        let complete = single(&plan(&holding(duration, duration, "")), 0);
        let after = (value(&complete, "phase_final"), value(&complete, "phase_after_begin_s"));
        assert_eq!(after, (1.0, duration));
        let short = single(&plan(&holding(duration, duration + 0.1, "")), 0);
        assert_eq!(value(&short, "phase_final"), 0.0, "{duration}");
        assert!(value(&short, "phase_after_begin_s").is_nan());
        let timeout = |time: f64| single(&plan(&holding(duration, 1e3, &format!("timeout_s = {time:?}\n"))), 0);
        let failed = timeout(duration);
        assert_eq!((value(&failed, "failure"), value(&failed, "end_time_s")), (1.0, duration), "{duration}");
        assert_eq!(value(&timeout(duration + 0.1), "failure"), 0.0, "{duration}");
    }
}

#[test]
fn phases_last_whole_ticks() {
    let fast = "estimator = \"mekf\"\n[[sensors]]\nname = \"gyro\"\nkind = \"rate_gyro\"\nperiod_s = PERIOD\n\
        [[sensors]]\nname = \"tracker\"\nkind = \"star_tracker\"\n";
    let mut is_ambiguous = false;
    for (period, lasting, ticks) in [("0.1", "0.3", 3), ("0.7", "2.1", 3), ("0.05", "0.35", 7)] {
        let number: f64 = period.parse().unwrap();
        for sensors in [String::new(), fast.replace("PERIOD", &format!("{:?}", number / 10.0))] {
            let control = format!(
                "[control]\nperiod_s = {period}\nwheels = [\"w1\", \"w2\", \"w3\"]\n{sensors}\
                 [[guidance]]\nphase = \"wait\"\nuntil = \"time_s >= {lasting}\"\n\
                 [[guidance]]\nphase = \"a\"\nuntil = \"time_in_phase_s >= {lasting}\"\n\
                 [[guidance]]\nphase = \"b\"\nuntil = \"body_rate_rad_s > 0\"\nhold_s = {lasting}\nnext = \"a\"\n"
            );
            let duration = 150.5 * number;
            let text = small_craft(&control, "angular_velocity_rad_s = [0.01, 0, 0]")
                .replace("duration_s = 100", &format!("duration_s = {duration:?}"))
                .replace("points = 401", "points = 2");
            let run = single(&plan(&text), 0);
            let phases: Vec<f64> = run.telemetry.rows.iter().map(|row| row[0]).collect();
            assert_eq!(run.telemetry.quantities[0].name(), "phase");
            let changes: Vec<usize> = (1..phases.len()).filter(|tick| phases[*tick] != phases[tick - 1]).collect();
            let lasted: Vec<usize> = changes.windows(2).map(|pair| pair[1] - pair[0]).collect();
            let expected: Vec<usize> = (0..lasted.len()).map(|place| ticks + place % 2).collect();
            assert_eq!((changes[0], &lasted), (ticks, &expected), "{period}");
            assert!(lasted.len() > 15);
            let at = |tick: usize| tick as f64 * number;
            let limit: f64 = lasting.parse().unwrap();
            let short = changes.iter().filter(|tick| at(**tick + ticks) - at(**tick) < limit).count();
            is_ambiguous |= short > 3 && short + 3 < changes.len();
        }
    }
    assert!(is_ambiguous);
}

#[test]
fn the_end_of_a_run_is_observed_on_every_grid() {
    let text = holding(200.0, 1e3, "timeout_s = 3.1\n");
    let plan = plan(&text);
    let mut beside = [0; 3];
    let of_parts = |part: u32| [1, 2, 4, 5, 8, 10, 20].map(|place| (part, place));
    for (part, place) in (1..=40).flat_map(of_parts).filter(|(part, place)| part > place) {
        let (duration, intervals, place) =
            (f64::from(31 * part) / f64::from(10 * place), part as usize, place as usize);
        let grid = Grid::uniform(duration, intervals + 1);
        let time = grid.times()[place];
        assert!((time - 3.1).abs() < 1e-14);
        let run = single_on(&plan, 0, grid);
        assert_eq!(value(&run, "end_time_s"), 31.0 * 0.1);
        assert_eq!(run.outcome.points, place + 1, "{duration} s in {intervals} intervals");
        beside[if time < 31.0 * 0.1 { 0 } else { 1 + usize::from(time > 31.0 * 0.1) }] += 1;
    }
    assert!(beside.iter().all(|count| *count > 5), "{beside:?}");
}
