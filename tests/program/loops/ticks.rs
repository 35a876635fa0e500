//! The ticks of a control loop: what a table over time shows of them, the one at the end of a run, and those at which slow sensors measure.

use std::fmt::Write as _;

use spindrift::ensemble::SingleRun;
use spindrift::math::Isa;
use spindrift::run::{Grid, StateField};
use spindrift::sampling::SampleId;

use crate::loops::closed_loops::{SLEW_CLOSED, plan, run, small_craft, value};

/// The recorded column `name` of `run` at the points of its grid.
fn shown(run: &SingleRun, name: &str) -> Vec<f64> {
    let place = run.telemetry.quantities.iter().position(|quantity| quantity.name() == name);
    run.telemetry.held_at(run.grid.times()).swap_remove(place.unwrap_or_else(|| panic!("no column {name}")))
}

/// The angle between the true and the estimated attitude at each point of `run`.
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

/// Law: a row at the time of a tick shows that tick, the last row too, wherever rounding puts the time: with perfect knowledge the estimate there is the
/// state there, to 1e-7 of a slew at 1e-2 rad/s (a tick before it is 1e-3 off and more).
#[test]
fn a_row_shows_the_tick_of_its_time() {
    let control = "[control]\nperiod_s = 0.1\nwheels = [\"w1\", \"w2\", \"w3\"]\n[[guidance]]\nphase = \"drift\"\n";
    let text = small_craft(control, "angular_velocity_rad_s = [0.01, 0.02, -0.01]")
        .replace("duration_s = 100", "duration_s = 60")
        .replace("points = 401", "points = 601");
    let run = run(&plan(&text), 0);
    assert_eq!((run.grid.points(), run.telemetry.times.len()), (601, 601));
    let off = estimation_errors(&run);
    let worst = off.iter().copied().fold(0.0, f64::max);
    assert!(worst < 1e-7, "{worst:e} at {:?}", off.iter().position(|error| *error == worst));
    // some ticks are after the point that they are meant by
    let late = run.telemetry.times.iter().zip(run.grid.times()).filter(|(tick, point)| tick > point).count();
    assert!(late > 5, "{late} ticks");
}

/// Law: what a run shows does not depend on when it ends: the ticks of a run are the first ones of a run twice as long, the last one included, with filters
/// and commands.
#[test]
fn the_last_tick_is_that_of_a_longer_run() {
    let plan = plan(SLEW_CLOSED);
    for duration in [10.0, 12.25, 20.0] {
        let flown = |duration: f64| {
            SingleRun::new(&plan, SampleId(3), Grid::uniform(duration, 11), Isa::best()).expect("a physical scene")
        };
        let (short, long) = (flown(duration), flown(2.0 * duration));
        let ticks = short.telemetry.times.len();
        assert!((short.telemetry.times[ticks - 1] - duration).abs() < 1e-9, "{:?}", short.telemetry.times.last());
        for (short, long) in short.telemetry.rows.iter().zip(&long.telemetry.rows) {
            // the state at the end is that of the observation, and at a tick within the run that of the step: rounding apart
            let near = |a: f64, b: f64| a.is_nan() && b.is_nan() || (a - b).abs() <= 1e-13 * (1.0 + a.abs());
            assert!(short.iter().zip(long).all(|(a, b)| near(*a, *b)), "{short:?}\n{long:?}");
        }
    }
}

/// A loop whose first phase holds for `hold` seconds, with `more` in that phase.
fn holding(duration: f64, hold: f64, more: &str) -> String {
    let mut control = String::from("[control]\nperiod_s = 0.1\nwheels = [\"w1\", \"w2\", \"w3\"]\n");
    let _ = write!(
        control,
        "[[guidance]]\nphase = \"wait\"\nuntil = \"time_s >= 0\"\nhold_s = {hold:?}\n{more}[[guidance]]\nphase = \"after\"\n"
    );
    small_craft(&control, "angular_velocity_rad_s = [0.01, 0, 0]")
        .replace("duration_s = 100", &format!("duration_s = {duration:?}"))
        .replace("points = 401", "points = 2")
}

/// Law: a hold that completes exactly at the end of the run counts, whichever way the times round, and one that needs a tick more does not; so does a
/// timeout.
#[test]
fn what_ends_with_the_run_counts() {
    for ticks in [1, 3, 6, 7, 11, 23, 100] {
        let duration = f64::from(ticks) / 10.0;
        let complete = run(&plan(&holding(duration, duration, "")), 0);
        assert_eq!(
            (value(&complete, "phase_final"), value(&complete, "phase_after_begin_s")),
            (1.0, duration),
            "{duration}"
        );
        let short = run(&plan(&holding(duration, duration + 0.1, "")), 0);
        assert_eq!(value(&short, "phase_final"), 0.0, "{duration}");
        assert!(value(&short, "phase_after_begin_s").is_nan());
        let timeout = |time: f64| run(&plan(&holding(duration, 1e3, &format!("timeout_s = {time:?}\n"))), 0);
        let failed = timeout(duration);
        assert_eq!((value(&failed, "failure"), value(&failed, "end_time_s")), (1.0, duration), "{duration}");
        assert_eq!(value(&timeout(duration + 0.1), "failure"), 0.0, "{duration}");
    }
}

/// Law: sensors whose periods are multiples of the loop's, and not of one another, measure at their own times and at no other, and the filter with them is
/// consistent: over 64 runs at rest the mean of its normalised square error (6 degrees of freedom) is within the 1e-4 interval of its chi-square, 0.76 to
/// 1.29.
#[test]
fn slow_sensors_measure_at_their_times() {
    let control = "[control]\nperiod_s = 0.5\nestimator = \"mekf\"\ninitial_attitude_sigma_rad = 1e-7\ninitial_bias_sigma_rad_s = 1e-9\n\
        wheels = [\"w1\", \"w2\", \"w3\"]\n\
        [[sensors]]\nname = \"gyro\"\nkind = \"rate_gyro\"\nperiod_s = 2\nangular_random_walk_rad_sqrt_s = 1e-5\nbias_random_walk_rad_s_sqrt_s = 1e-8\n\
        [[sensors]]\nname = \"tracker\"\nkind = \"star_tracker\"\nperiod_s = 5\nnoise_rad = [1e-4, 1e-4, 5e-4]\n\
        [[guidance]]\nphase = \"drift\"\n";
    let text = small_craft(control, "").replace("samples = 2", "samples = 65").replace("points = 401", "points = 201");
    let plan = plan(&text);
    let (mut sum, runs) = (0.0, 64);
    for sample in 1..=runs {
        let run = run(&plan, sample);
        if sample == 1 {
            for (column, period) in [("measured_rate_s_x_rad_s", 2.0), ("measured_q_es_w", 5.0)] {
                for (time, value) in run.grid.times().iter().zip(shown(&run, column)) {
                    // a gyro measures the turn since its sample before
                    let samples = time / period;
                    let is_due = (samples - samples.round()).abs() < 1e-9 && (period == 5.0 || *time > 0.0);
                    assert_eq!(value.is_finite(), is_due, "{column} at {time}");
                }
            }
        }
        sum += shown(&run, "attitude_nees").last().expect("a last tick");
    }
    let mean = sum / runs as f64;
    assert!((0.76..1.29).contains(&mean), "{mean}");
}

/// Law: the share of a law's torque beyond which a note says that errors grow is where they begin to grow in a flown run, with a delay: 2% below it they
/// die away, 2% above it they grow.
#[test]
fn the_noted_limit_is_where_a_run_diverges() {
    let text = |gain: f64| {
        let control = format!(
            "[control]\nperiod_s = 0.25\ndelay_s = 0.1\nwheels = [\"w1\", \"w2\", \"w3\"]\n[[guidance]]\nphase = \"damp\"\nlaw = \"rate_damping\"\ngain_n_m_s = {gain:?}\n"
        );
        small_craft(&control, "angular_velocity_rad_s = [1e-6, 1e-6, 1e-6]")
    };
    let noted = |gain: f64| plan(&text(gain)).notes().into_iter().find(|note| note.contains("small errors grow"));
    let note = noted(1000.0).expect("a note");
    let share = note.split("at most ").nth(1).and_then(|rest| rest.split(' ').next()).expect("a share");
    let limit = 1000.0 * share.parse::<f64>().expect("a number");
    for (factor, grows) in [(0.98, false), (1.02, true)] {
        let gain = factor * limit;
        assert_eq!(noted(gain).is_some(), grows, "{gain}");
        let run = run(&plan(&text(gain)), 0);
        let rates = run.table.column(StateField::Rate, 2);
        let largest = |part: &[f64]| part.iter().fold(0.0_f64, |most, rate| most.max(rate.abs()));
        let (early, late) = (largest(&rates[40..120]), largest(&rates[321..401]));
        assert_eq!(late > early, grows, "{gain}: {early:e} {late:e}");
    }
}
