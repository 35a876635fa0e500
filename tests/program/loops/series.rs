//! What a control loop records over time, and how steady it is: recomputed from the states of the run, its telemetry
//! and its arcs.

use crate::loops::closed_loops::{NET_LAUNCH, SLEW_CLOSED, plan, value};
use spindrift::campaign::{Overrides, Plan};
use spindrift::ensemble::SingleRun;
use spindrift::math::Isa;
use spindrift::observables::Series;
use spindrift::run::{Grid, StateField};
use spindrift::sampling::SampleId;
use spindrift::workflow::{Campaign, Quiet, Session};

use crate::support::scratch_folder::ScratchFolder;

/// Ticks of `slew_closed.toml`, and how many a run of 180 s has before its end, where there is one more.
const PERIOD: f64 = 0.25;
const TICKS: usize = 720;
/// The tick at which the second phase begins.
const SLEW: usize = 120;
/// Rounding of angles between attitudes that are computed in two ways.
const ROUNDING: f64 = 1e-13;

fn hamilton([a, b, c, d]: [f64; 4], [w, x, y, z]: [f64; 4]) -> [f64; 4] {
    [
        a * w - b * x - c * y - d * z,
        a * x + b * w + c * z - d * y,
        a * y - b * z + c * w + d * x,
        a * z + b * y - c * x + d * w,
    ]
}

/// The rotation vector of conj(a) b, the shorter way.
fn rotation([w, x, y, z]: [f64; 4], b: [f64; 4]) -> [f64; 3] {
    let [s, v @ ..] = hamilton([w, -x, -y, -z], b);
    let (s, v) = if s < 0.0 { (-s, v.map(|x| -x)) } else { (s, v) };
    let sine = v.iter().map(|x| x * x).sum::<f64>().sqrt();
    if sine == 0.0 { [0.0; 3] } else { v.map(|x| x * 2.0 * sine.atan2(s) / sine) }
}

fn length(v: [f64; 3]) -> f64 {
    v.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// A run observed at its ticks.
fn at_ticks(text: &str, sample: u64) -> SingleRun {
    let grid = Grid::uniform(TICKS as f64 * PERIOD, TICKS + 1);
    SingleRun::new(&plan(text), SampleId(sample), grid, Isa::best()).expect("a physical scene")
}

fn series(run: &SingleRun, of: Series) -> &[f64] {
    &run.series.iter().find(|(series, _)| *series == of).expect("the loop records it").1
}

/// The rotation vectors from target to true attitude at the ticks.
fn errors(run: &SingleRun) -> Vec<[f64; 3]> {
    let slew = [3.0_f64.sqrt() / 2.0, 0.0, 0.0, 0.5];
    let target = |tick: usize| if tick < SLEW { [1.0, 0.0, 0.0, 0.0] } else { slew };
    (0..=TICKS).map(|tick| rotation(target(tick), run.table.at(StateField::Attitude, tick))).collect()
}

/// Law: at a tick the pointing error is the angle from the target of the phase to the true attitude, the errors of the
/// estimate are those of the recorded estimate, and the torque of a wheel is that of the arc that was flown. In the
/// nominal run and in others.
#[test]
fn quantities_over_time_are_those_of_the_run() {
    for sample in [0, 3, 17] {
        let run = at_ticks(SLEW_CLOSED, sample);
        let pointing = errors(&run);
        assert!(pointing[SLEW..].iter().any(|error| length(*error) > 1.0), "a slew");
        let telemetry = &run.telemetry;
        // and the tick at the end
        assert_eq!(telemetry.times.len(), TICKS + 1);
        let place = |name: &str| telemetry.quantities.iter().position(|quantity| quantity.name() == name).expect(name);
        let (q, omega) = (place("estimated_q_es_w"), place("estimated_omega_se_s_x_rad_s"));
        for (tick, error) in pointing.iter().enumerate() {
            let row = &telemetry.rows[tick];
            let estimated: [f64; 4] = std::array::from_fn(|i| row[q + i]);
            let rate: [f64; 3] = run.table.at(StateField::Rate, tick);
            for (of, expected) in [
                (Series::PointingError, length(*error)),
                (Series::AttitudeEstimateError, length(rotation(estimated, run.table.at(StateField::Attitude, tick)))),
                (Series::RateEstimateError, length(std::array::from_fn(|i| row[omega + i] - rate[i]))),
            ] {
                let found = series(&run, of)[tick];
                assert!((found - expected).abs() < ROUNDING, "{of:?} at tick {tick}: {found} {expected}");
            }
            let time = tick as f64 * PERIOD;
            let arc = run.arcs.iter().rfind(|arc| arc.start < time + 1e-9).expect("an arc");
            for wheel in 0..4 {
                assert_eq!(series(&run, Series::MotorTorque.of_wheel(wheel))[tick], arc.applied.motor_torque[wheel]);
            }
        }
        assert!(series(&run, Series::MotorTorque).iter().any(|torque| torque.abs() > 1e-3));
        // the last point has the tick at the end, and not the one before
        assert_ne!(series(&run, Series::PointingError)[TICKS], series(&run, Series::PointingError)[TICKS - 1]);
    }
    // between ticks an error is that of the tick before
    let text = SLEW_CLOSED;
    let between = SingleRun::new(&plan(text), SampleId(3), Grid::uniform(180.0, 1801), Isa::best()).expect("physical");
    let ticks = at_ticks(text, 3);
    for (point, found) in series(&between, Series::PointingError).iter().enumerate() {
        assert_eq!(*found, series(&ticks, Series::PointingError)[2 * point / 5], "{point}");
    }
}

/// Law: a requirement on such a quantity judges each run by its largest value at the points of the interval, and bands
/// are of the runs at each point.
#[test]
fn requirements_and_bands_are_of_the_quantities() {
    let require = "\n[[require]]\nband = \"pointing_error_rad\"\nat_most = 0.01\nfraction = 0.5\nfrom_s = \
        100\nat_all_times = true\n";
    let text = SLEW_CLOSED.replace("samples = 1024", "samples = 12") + require;
    let scratch = ScratchFolder::new("loop-series");
    let quiet = Quiet::default();
    let session = Session::new(&quiet).expect("a session");
    let results = Campaign::from_text("loop.toml", &text, session).store(scratch.path("r")).results().expect("results");
    let plan = results.plan();
    let runs: Vec<SingleRun> = (0..12)
        .map(|sample| SingleRun::new(plan, SampleId(sample), plan.grid.clone(), Isa::best()).expect("physical"))
        .collect();
    let column = results.column("highest_from_100_s_pointing_error_rad").expect("a column");
    for (run, found) in runs.iter().zip(&column) {
        let of_points = &series(run, Series::PointingError)[100..];
        assert_eq!(of_points.iter().copied().fold(0.0, f64::max), *found);
        assert_eq!(*found, value(run, "highest_from_100_s_pointing_error_rad"));
    }
    assert!(column[1..].windows(2).any(|pair| pair[0] != pair[1]));
    let bands = results.bands().expect("bands are read").expect("the campaign has bands");
    for (name, of) in [
        ("pointing_error_rad", Series::PointingError),
        ("attitude_estimate_error_rad", Series::AttitudeEstimateError),
        ("torque_w3_n_m", Series::MotorTorque.of_wheel(2)),
    ] {
        let band = bands.find(name).unwrap_or_else(|| panic!("bands of {name}"));
        for (point, time) in bands.times().iter().enumerate() {
            let at = plan.grid.times().iter().position(|other| other == time).expect("a point of the grid");
            let values = runs[1..].iter().map(|run| series(run, of)[at]);
            let expected = [values.clone().fold(f64::INFINITY, f64::min), values.fold(f64::NEG_INFINITY, f64::max)];
            assert_eq!(bands.extremes(band, point), Some(expected), "{name} at {time} s");
        }
    }
    // what a loop does not have has no bands: its state is known
    let known = SLEW_CLOSED.replace("estimator = \"mekf\"", "estimator = \"perfect\"");
    let known = known.replace("initial_attitude_sigma_rad = \"1 deg\"\ninitial_bias_sigma_rad_s = \"5 deg/h\"\n", "");
    let refused = known + &require.replace("pointing_error_rad", "attitude_estimate_error_rad");
    let error = Plan::from_text("loop.toml", &refused, Overrides::default()).expect_err("no estimate").to_string();
    assert!(error.contains("require[0].band") || error.contains("band = \"attitude_estimate_error_rad\""), "{error}");
}

/// Law: at a tick, distance and speed relative to the debris are those of the centres of mass, and the impulse is that
/// of the arcs before it.
#[test]
fn the_way_to_the_debris_is_that_of_the_run() {
    const PERIOD: f64 = 0.5;
    const TICKS: usize = 600;
    for sample in [0, 5] {
        let grid = Grid::uniform(TICKS as f64 * PERIOD, TICKS + 1);
        let run = SingleRun::new(&plan(NET_LAUNCH), SampleId(sample), grid, Isa::best()).expect("a physical scene");
        let apart = |tick: usize, debris: StateField, own: StateField| {
            let [a, b]: [[f64; 3]; 2] = [debris, own].map(|field| run.table.at(field, tick));
            length(std::array::from_fn(|i| a[i] - b[i]))
        };
        for tick in 0..=TICKS {
            for (of, expected) in [
                (Series::DebrisDistance, apart(tick, StateField::DebrisPosition, StateField::ComPosition)),
                (Series::DebrisSpeed, apart(tick, StateField::DebrisVelocity, StateField::ComVelocity)),
            ] {
                let found = series(&run, of)[tick];
                assert!(
                    (found - expected).abs() < 1e-12 * expected.max(1.0),
                    "{of:?} at tick {tick}: {found} {expected}"
                );
            }
            let before = run.arcs.iter().take_while(|arc| arc.start < tick as f64 * PERIOD - 1e-9);
            let fired = before.map(|arc| arc.applied.thrust.iter().sum::<f64>() * (arc.applied.until - arc.start));
            let (found, expected) = (series(&run, Series::Impulse)[tick], fired.sum::<f64>());
            assert!((found - expected).abs() <= 1e-12 * expected, "impulse at tick {tick}: {found} {expected}");
        }
        assert!(series(&run, Series::Impulse)[TICKS] > 10.0, "thrusters fire");
    }
}

/// Law: the settling time of a mission and the relative performance error over a window are those of the attitudes at
/// the ticks, in two passes.
#[test]
fn stability_is_that_of_the_attitudes_at_the_ticks() {
    let band = std::f64::consts::PI / 180.0;
    for sample in [0, 5] {
        for (keys, window) in [("", None), ("stability_from_s = 100\nstability_window_s = 50\n", Some(400..600))] {
            let run = at_ticks(&SLEW_CLOSED.replace("[control]\n", &format!("[control]\n{keys}")), sample);
            let errors = errors(&run);
            let last = errors.iter().rposition(|error| length(*error) > band).expect("a slew");
            assert_eq!(value(&run, "mission_settling_time_s"), (last + 1) as f64 * PERIOD);
            let expected = value(&run, "settling_time_s") + SLEW as f64 * PERIOD;
            assert_eq!(value(&run, "mission_settling_time_s"), expected, "the last phase begins at 30 s");
            let errors = &errors[window.unwrap_or(last + 1..TICKS)];
            let n = errors.len() as f64;
            let mean: [f64; 3] = std::array::from_fn(|axis| errors.iter().map(|error| error[axis]).sum::<f64>() / n);
            let square = |error: &[f64; 3]| length(std::array::from_fn(|axis| error[axis] - mean[axis])).powi(2);
            let rms = (errors.iter().map(square).sum::<f64>() / n).sqrt();
            let swing = |axis: usize| {
                let of_axis = errors.iter().map(|error| error[axis]);
                of_axis.clone().fold(f64::NEG_INFINITY, f64::max) - of_axis.fold(f64::INFINITY, f64::min)
            };
            let peak_to_peak = (0..3).map(swing).fold(0.0, f64::max);
            for (name, expected) in [("rms", rms), ("peak_to_peak", peak_to_peak)] {
                let found = value(&run, &format!("relative_performance_error_{name}_rad"));
                assert!(expected > 0.0 && (found - expected).abs() < ROUNDING, "{name}: {found} {expected}");
            }
        }
    }
}

/// Law: a filter agrees with its tracker wherever that looks: the innovations of some 350 measurements have a mean
/// square of one. A boresight along s3, of any length, is the default, bit for bit; a direction of no length is
/// refused.
#[test]
fn a_tracker_looks_in_any_direction() {
    let of = |boresight: &str| {
        SLEW_CLOSED.replace("kind = \"star_tracker\"\n", &format!("kind = \"star_tracker\"\n{boresight}"))
    };
    for boresight in ["[1, 0, 0]", "[0, -2, 0]", "[0, 0, -1]", "[0.5, 0.6, 0.3]"] {
        let run = at_ticks(&of(&format!("boresight = {boresight}\n")), 7);
        let found = value(&run, "attitude_innovation_mean");
        assert!((0.8..1.25).contains(&found), "{boresight}: {found}");
        assert!(run.row != at_ticks(SLEW_CLOSED, 7).row);
    }
    let bits = |text: &str| at_ticks(text, 7).row.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(&of("boresight = [0, 0, 5]\n")), bits(SLEW_CLOSED));
    let error =
        Plan::from_text("loop.toml", &of("boresight = [0, 0, 0]\n"), Overrides::default()).expect_err("nowhere");
    assert!(error.to_string().contains("sensors.tracker.boresight"), "{error}");
}
