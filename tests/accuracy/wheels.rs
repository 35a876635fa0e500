//! Wheels whose motors hold their speed, and wheels with misaligned axes and offset centres.

use crate::support::{
    prelude::*,
    runs::rotation_distance,
    scenes::{misaligned, speed_held},
};

const HORIZON: f64 = 1.0;
const TAYLOR: f64 = 1e-16;

fn held_scenes(count: u64, forced: bool) -> Vec<Scene> {
    let scene = |k: u64| {
        let kind = Kind { wheels: [true; 2], debris: 0, products: k % 2 == 1, offset: !k.is_multiple_of(3), forced };
        let held = [[true, false], [false, true], [true, true]][(k % 3) as usize];
        let input = speed_held(random(kind, 400 + k, HORIZON), held);
        resolved(&if k % 5 > 1 { misaligned(input, k) } else { input })
    };
    (0..count).map(scene).collect()
}

#[test]
fn a_held_wheel_keeps_its_rate_and_its_angle_is_a_line() {
    let scenes = held_scenes(12, false);
    let grid = Grid::uniform(HORIZON, 17);
    for method in [Method::Auto, Method::Taylor, DORMAND_PRINCE, Method::NullSpace] {
        for (scene, run) in scenes.iter().zip(propagate(method, adaptive(1e-11), &grid, &scenes)) {
            for w in (0..2).filter(|w| scene.mass.wheels[*w].mode == WheelMode::SpeedHeld) {
                let (start, rate) = (scene.initial.wheel_angles[w], scene.initial.wheel_rates[w]);
                for (point, time) in grid.times().iter().enumerate() {
                    assert_eq!(run.table.column(StateField::WheelRates, w)[point].to_bits(), rate.to_bits());
                    let off = run.table.column(StateField::WheelAngles, w)[point] - (start + rate * time);
                    assert!(off.abs() <= 2e-15 * (1.0 + rate.abs()), "{} {off:e}", method.name());
                }
            }
        }
    }
}

/// Berdoz's body with wheel 1 on s1, so that P2 against P3 turns the body about the wheel's axis, and P1 balances them.
fn rotor(mode: WheelMode) -> SceneInput {
    let mut input = Golden::load("table1").scene;
    input.debris = None;
    keep_wheels(&mut input, [true, false]);
    let wheel = &mut input.wheels[0];
    wheel.tilt_rad = [0.0, -std::f64::consts::FRAC_PI_2];
    wheel.mode = mode;
    wheel.rate_rad_s = 120.0;
    input.initial.velocity_m_s = [0.0; 3];
    input.initial.angular_velocity_rad_s = [0.25, 0.0, 0.0];
    input.actuation = vec![ActuationInput::idle(0.0, 4.0).with_thrust(&[300.0, 200.0, 100.0])];
    input
}

/// Law: the body's rate grows by tau t/J with the wheel held and tau t/J* with it free, which lags by as much.
#[test]
fn a_torque_about_the_wheels_axis_has_a_closed_form() {
    const TAU: f64 = 0.5 * (200.0 - 100.0);
    /// Rounding of a hundred steps; the axis is a quarter turn to 6e-17. Measured: 5.6e-17, and 7.8e-17 of the work.
    const BOUND: f64 = 5e-16;
    let grid = Grid::uniform(4.0, 9);
    for (method, tolerance) in [(Method::Taylor, TAYLOR), (DOP853, 1e-13), (Method::NullSpace, 1e-13)] {
        let mut rates = [0.0; 2];
        for mode in [WheelMode::Free, WheelMode::SpeedHeld] {
            let scene = resolved(&rotor(mode));
            let (wheel, locked) = (scene.mass.wheels[0], scene.mass.inertia[0][0]);
            let held = mode == WheelMode::SpeedHeld;
            let inertia = if held { locked } else { locked - wheel.axial };
            let run = propagate_one(method, adaptive(tolerance), &grid, &scene);
            for (point, time) in grid.times().iter().enumerate() {
                let gained = TAU * time / inertia;
                let omega: [f64; 3] = run.table.at(StateField::Rate, point);
                assert!(norm(difference(omega, [0.25 + gained, 0.0, 0.0])) < BOUND, "{} {omega:?}", method.name());
                let (lag, work) = if held { (0.0, 120.0 * wheel.axial * gained) } else { (gained, 0.0) };
                // relative to the 120 rad/s of the wheel; measured: 0, and 9.3e-15 J of the work
                let rate = run.table.column(StateField::WheelRates, 0)[point];
                assert!((rate - (120.0 - lag)).abs() < 120.0 * BOUND, "{} {rate}", method.name());
                let done = run.table.column(StateField::Work, 1)[point];
                assert!((done - work).abs() < 120.0 * BOUND, "{} {done} {work}", method.name());
            }
            rates[usize::from(held)] = run.table.column(StateField::Rate, 0)[grid.points() - 1];
        }
        // measured: 3.6e-5
        assert!((rates[0] - rates[1]).abs() > 1e-5, "J and J* differ: {rates:?}");
    }
}

/// Law: a period found for held wheels is valid for many periods.
#[test]
fn periods_carry_held_wheels_too() {
    let kind = Kind { wheels: [true; 2], debris: 0, products: true, offset: true, forced: false };
    let grid = Grid::uniform(200.0, 101);
    let mut folded = 0;
    for seed in 0..6 {
        let input = misaligned(speed_held(random(kind, 70 + seed, 1.0), [seed % 2 == 0, seed % 3 > 0]), seed);
        let scene = resolved(&input);
        let run = |method| propagate_one(method, adaptive(TAYLOR), &grid, &scene);
        let (auto, plain) = (run(Method::Auto), run(Method::Taylor));
        folded += usize::from(auto.outcome.effort.steps * 4 < plain.outcome.effort.steps);
        let [rate, attitude] = rotation_distance(&auto.table, &plain.table);
        let angle = 200.0 * norm(scene.initial.omega_se_s);
        // two ulps a radian: a rounding of the period and those of plain integration; measured: 0.54
        assert!(rate.max(attitude) < 2.0 * f64::EPSILON * angle, "{rate:e} {attitude:e} over {angle} rad");
    }
    assert!(folded >= 4, "most of these have a period within the horizon: {folded}");
}
