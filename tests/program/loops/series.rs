//! Recorded quantities of a control loop over time.

use crate::prelude::*;

const PERIOD: f64 = 0.25;
const TICKS: usize = 720;
const SLEW: usize = 120;
const ROUNDING: f64 = 1e-13;

fn rotation(a: [f64; 4], b: [f64; 4]) -> [f64; 3] {
    rotation_vector(hamilton(conjugate(a), b))
}
fn at_ticks(text: &str, sample: u64) -> SingleRun {
    let grid = Grid::uniform(TICKS as f64 * PERIOD, TICKS + 1);
    single_on(&plan(text), sample, grid)
}

fn series(run: &SingleRun, of: Series) -> &[f64] {
    &run.series.iter().find(|(series, _)| *series == of).unwrap().1
}

fn errors(run: &SingleRun) -> Vec<[f64; 3]> {
    let slew = [3.0_f64.sqrt() / 2.0, 0.0, 0.0, 0.5];
    let target = |tick: usize| if tick < SLEW { [1.0, 0.0, 0.0, 0.0] } else { slew };
    (0..=TICKS).map(|tick| rotation(target(tick), run.table.at(StateField::Attitude, tick))).collect()
}

/// Law: the pointing error is from the target to the true attitude; torques are those of the arc flown.
#[test]
fn quantities_over_time_are_those_of_the_run() {
    for sample in [0, 3, 17] {
        let run = at_ticks(SLEW_CLOSED, sample);
        let pointing = errors(&run);
        assert!(pointing[SLEW..].iter().any(|error| norm(*error) > 1.0), "a slew");
        let telemetry = &run.telemetry;
        assert_eq!(telemetry.times.len(), TICKS + 1);
        let place = |name: &str| telemetry.quantities.iter().position(|quantity| quantity.name() == name).expect(name);
        let (q, omega) = (place("estimated_q_es_w"), place("estimated_omega_se_s_x_rad_s"));
        for (tick, error) in pointing.iter().enumerate() {
            let row = &telemetry.rows[tick];
            let estimated: [f64; 4] = from_fn(|i| row[q + i]);
            let rate: [f64; 3] = run.table.at(StateField::Rate, tick);
            for (of, expected) in [
                (Series::PointingError, norm(*error)),
                (Series::AttitudeEstimateError, norm(rotation(estimated, run.table.at(StateField::Attitude, tick)))),
                (Series::RateEstimateError, norm(from_fn(|i| row[omega + i] - rate[i]))),
            ] {
                let found = series(&run, of)[tick];
                assert!((found - expected).abs() < ROUNDING, "{of:?} at tick {tick}: {found} {expected}");
            }
            let time = tick as f64 * PERIOD;
            let arc = run.arcs.iter().rfind(|arc| arc.start < time + 1e-9).unwrap();
            for wheel in 0..4 {
                assert_eq!(series(&run, Series::MotorTorque.of_wheel(wheel))[tick], arc.applied.motor_torque[wheel]);
            }
        }
        assert!(series(&run, Series::MotorTorque).iter().any(|torque| torque.abs() > 1e-3));
        assert_ne!(series(&run, Series::PointingError)[TICKS], series(&run, Series::PointingError)[TICKS - 1]);
    }
    let text = SLEW_CLOSED;
    let between = single_on(&plan(text), 3, Grid::uniform(180.0, 1801));
    let ticks = at_ticks(text, 3);
    for (point, found) in series(&between, Series::PointingError).iter().enumerate() {
        assert_eq!(*found, series(&ticks, Series::PointingError)[2 * point / 5], "{point}");
    }
}

/// Law: at a tick, debris distance and speed are those of the centres of mass, and the impulse that of the arcs before.
#[test]
fn the_way_to_the_debris_is_that_of_the_run() {
    const PERIOD: f64 = 0.5;
    const TICKS: usize = 600;
    for sample in [0, 5] {
        let grid = Grid::uniform(TICKS as f64 * PERIOD, TICKS + 1);
        let run = single_on(&plan(NET_LAUNCH), sample, grid);
        let apart = |tick: usize, debris: StateField, own: StateField| {
            let [a, b]: [[f64; 3]; 2] = [debris, own].map(|field| run.table.at(field, tick));
            norm(from_fn(|i| a[i] - b[i]))
        };
        for tick in 0..=TICKS {
            for (of, expected) in [
                (Series::DebrisDistance, apart(tick, StateField::DebrisPosition, StateField::ComPosition)),
                (Series::DebrisSpeed, apart(tick, StateField::DebrisVelocity, StateField::ComVelocity)),
            ] {
                let found = series(&run, of)[tick];
                assert!((found - expected).abs() < 1e-12 * expected.max(1.0), "{of:?}, {tick}: {found} {expected}");
            }
            let before = run.arcs.iter().take_while(|arc| arc.start < tick as f64 * PERIOD - 1e-9);
            let fired = before.map(|arc| arc.applied.thrust.iter().sum::<f64>() * (arc.applied.until - arc.start));
            let (found, expected) = (series(&run, Series::Impulse)[tick], fired.sum::<f64>());
            assert!((found - expected).abs() <= 1e-12 * expected, "impulse at tick {tick}: {found} {expected}");
        }
        assert!(series(&run, Series::Impulse)[TICKS] > 10.0, "thrusters fire");
    }
}
