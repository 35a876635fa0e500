//! Runs that start at rest, hardly move, or stop obey the law of [`super::error_estimate`], for every method.

use super::error_estimate::{Family, Found, Measured, breaches, found, settings};
use crate::prelude::*;

const DURATION: f64 = 20.0;
const FAST: f64 = 60.0;

/// A satellite at rest with four equal wheels in a pyramid and two thrusters for each sense about s3.
fn satellite(k: u64, u: &mut Uniform) -> SceneInput {
    let mut input = SceneInput::report();
    let [x, y, z] = u.vector::<3>(0.4);
    let [a, b, c] = if k.is_multiple_of(2) { [0.0; 3] } else { u.vector(0.1) };
    input.body.mass_kg = Some(50.0);
    input.body.inertia_kg_m2 = Some([[2.5 + x, a, b], [a, 2.5 + y, c], [b, c, 2.5 + z]]);
    input.body.center_of_mass_m = Some(if k.is_multiple_of(2) { [0.0; 3] } else { u.vector(0.1) });
    let root = 2.0_f64.sqrt();
    let axes = [[root, 0.0, 1.0], [0.0, root, 1.0], [-root, 0.0, 1.0], [0.0, -root, 1.0]];
    input.wheels = ["w1", "w2", "w3", "w4"]
        .iter()
        .zip(axes)
        .map(|(name, axis)| {
            let mut wheel = WheelInput::named(name, axis, axis.map(|x| 0.1 * x));
            wheel.radius_m = Some(0.06);
            wheel.length_m = Some(0.03);
            wheel.density_kg_m3 = Some(8000.0);
            wheel
        })
        .collect();
    input.thrusters = [(1.0, 1.0), (-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0)]
        .iter()
        .enumerate()
        .map(|(i, (arm, way))| ThrusterInput::named(&format!("p{i}"), [*arm, 0.0, 0.0], [0.0, *way, 0.0]))
        .collect();
    input.debris = None;
    input.initial.position_m = [0.0; 3];
    input.initial.velocity_m_s = [0.0; 3];
    input.initial.attitude = u.unit_quaternion();
    input.initial.angular_velocity_rad_s = [0.0; 3];
    input.actuation = Vec::new();
    input
}

fn oppose(input: &mut SceneInput, u: &mut Uniform) {
    let [one, other] = [u.between(-FAST, FAST), u.between(-FAST, FAST)];
    for (wheel, rate) in input.wheels.iter_mut().zip([one, other, one, other]) {
        wheel.rate_rad_s = rate;
    }
    for wheel in &mut input.wheels[2..] {
        wheel.axis = wheel.axis.map(|x| -x);
    }
    for (from, to) in [(0, 2), (1, 3)] {
        input.wheels[to].axis = input.wheels[from].axis.map(|x| -x);
    }
}

fn slew(input: &mut SceneInput, (start, on, coast): (f64, f64, f64), torques: &[f64]) {
    let back: Vec<f64> = torques.iter().map(|torque| -torque).collect();
    let braking = start + on + coast;
    input.actuation = vec![
        ActuationInput::idle(start, start + on).with_torque(torques),
        ActuationInput::idle(braking, braking + on).with_torque(&back),
    ];
}

fn thrust_slew(input: &mut SceneInput, (start, on, coast): (f64, f64, f64), thrust: f64) {
    let braking = start + on + coast;
    input.actuation = vec![
        ActuationInput::idle(start, start + on).with_thrust(&[thrust, thrust, 0.0, 0.0]),
        ActuationInput::idle(braking, braking + on).with_thrust(&[0.0, 0.0, thrust, thrust]),
    ];
}

type Regime = (&'static str, fn(u64, &mut Uniform, &mut SceneInput));

const REGIMES: [Regime; 8] = [
    ("at rest", |k, u, input| {
        if k.is_multiple_of(2) {
            oppose(input, u);
        }
    }),
    ("near rest", |k, u, input| {
        let rate = libm::pow(10.0, u.between(-12.0, -3.0));
        input.initial.angular_velocity_rad_s = u.vector::<3>(1.0).map(|x| rate * x);
        if k % 4 > 1 {
            input.wheels.clear();
        }
    }),
    ("near rest, biased", |_, u, input| {
        let rate = libm::pow(10.0, u.between(-12.0, -3.0));
        input.initial.angular_velocity_rad_s = u.vector::<3>(1.0).map(|x| rate * x);
        input.wheels[0].rate_rad_s = FAST;
    }),
    ("zero momentum", |_, u, input| {
        oppose(input, u);
        let rate = libm::pow(10.0, u.between(-12.0, -1.0));
        input.initial.angular_velocity_rad_s = u.vector::<3>(1.0).map(|x| rate * x);
    }),
    ("zero momentum, driven", |_, u, input| {
        oppose(input, u);
        let torque = u.vector::<4>(0.02);
        input.actuation = vec![ActuationInput::idle(10.0, DURATION).with_torque(&torque)];
    }),
    ("slew by wheels", |k, u, input| {
        if k % 4 > 1 {
            oppose(input, u);
        }
        let torque = u.vector::<4>(0.05);
        slew(input, (1.0, 4.0, u.between(0.5, 4.0)), &torque);
    }),
    ("slew by thrusters", |_, u, input| {
        thrust_slew(input, (1.0, 3.0, u.between(0.5, 4.0)), u.between(0.01, 0.05));
    }),
    ("thrust from rest", |_, u, input| {
        let thrust = u.vector::<4>(0.05).map(f64::abs);
        input.actuation = vec![ActuationInput::idle(10.0, DURATION).with_thrust(&thrust)];
    }),
];

fn family((name, make): Regime, count: u64) -> Family {
    let mut u = Uniform::new(27);
    let scene = |k: u64| {
        let mut input = satellite(k, &mut u);
        make(k, &mut u, &mut input);
        resolved(&input)
    };
    Family::new(name, Grid::uniform(DURATION, 41), (0..count).map(scene).collect())
}

fn settings_at_rest(method: Method) -> Vec<(f64, Control)> {
    match method {
        RUNGE_KUTTA | GAUSS_LEGENDRE => [0.5, 0.05].map(|step| (step, fixed(step))).to_vec(),
        Method::NullSpace => [1e-4, 1e-6].map(|tolerance| (tolerance, adaptive(tolerance))).to_vec(),
        other => settings(other),
    }
}

fn measured(count: u64) -> Vec<Measured> {
    let families = REGIMES.map(|regime| (regime.0, family(regime, count)));
    let mut all = Vec::new();
    for method in Method::ALL {
        for (name, family) in &families {
            for (setting, control) in settings_at_rest(method) {
                let runs = found(family, method, control);
                assert_eq!(runs.len() as u64, count, "{name}, {}: complete runs", method.name());
                all.push(Measured { method, family: name, setting, runs });
            }
        }
    }
    all
}

/// Law: every run is `ok`, with an estimate that covers its error in 95% of the runs and is not idle.
#[test]
fn at_rest_is_an_ordinary_state() {
    let all = measured(8);
    let breached = breaches(&all, 1.0);
    assert!(breached.is_empty(), "{breached:#?}");
}

#[test]
fn a_slew_that_is_wrong_is_inaccurate() {
    let mut u = Uniform::new(28);
    let scene = |k: u64| {
        let mut input = satellite(k, &mut u);
        input.wheels[0].rate_rad_s = 30.0 * FAST;
        slew(&mut input, (1.0, 4.0, 1.0), &u.vector::<4>(0.5));
        resolved(&input)
    };
    let family = Family::new("biased slew", Grid::uniform(DURATION, 41), (0..16).map(scene).collect());
    let runs = found(&family, RUNGE_KUTTA, fixed(0.5));
    let wrong: Vec<&Found> = runs.iter().filter(|run| run.error > 0.1).collect();
    assert!(wrong.len() >= 8, "the steps are too long: {runs:?}");
    for run in wrong {
        assert_eq!(run.status, Status::Inaccurate, "{run:?}");
    }
}
