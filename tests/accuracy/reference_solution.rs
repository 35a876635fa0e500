//! The reference solution in double-double, against 40 digits and conservation laws.

use crate::prelude::*;
use spindrift::math::vector::{constant, constant_matrix};

fn everything() -> StateFields {
    let constraints = [StateField::Dcm, StateField::Residuals];
    StateField::ALL.into_iter().filter(|block| !constraints.contains(block)).fold(StateFields::NONE, StateFields::with)
}

fn solved(name: &str, tolerance: f64) -> (Golden, Scene, ReferenceSolution) {
    let golden = Golden::load(name);
    let scene = resolved(&golden.scene);
    let truth =
        ReferenceSolution::new(Isa::best(), &scene, &Grid::at(golden.times()), everything(), tolerance).unwrap();
    (golden, scene, truth)
}

/// A moment of inertia rounded to f64 times the angle of the body, 320 rad in Table I. Measured: rate 4.4e-15, attitude
/// 7.0e-15; 4e-16 for `forced`.
const ROUNDED_SCENE: f64 = 1e-14;

#[test]
fn agrees_with_forty_digits_as_far_as_the_scene_is_rounded() {
    for name in ["table1", "forced"] {
        let (golden, _, truth) = solved(name, TOLERANCE);
        let (mut rate, mut attitude, mut wheels, mut debris) = (0.0_f64, 0.0_f64, 0.0_f64, 0.0_f64);
        for (point, row) in golden.truth.iter().enumerate() {
            let off = difference(truth.high.at(StateField::Rate, point), row.omega_se_s);
            rate = rate.max(norm(off) / norm(row.omega_se_s));
            attitude = attitude.max(off_attitude(truth.high.at(StateField::Attitude, point), row.q_es));
            debris = debris.max(off_attitude(truth.high.at(StateField::DebrisAttitude, point), row.q_ed));
            for i in 0..2 {
                let exact = row.wheel_angles[i];
                let off = truth.high.column(StateField::WheelAngles, i)[point] - exact;
                wheels = wheels.max(off.abs() / exact.abs().max(1.0));
            }
        }
        for error in [rate, attitude, wheels, debris] {
            assert!(error < ROUNDED_SCENE, "{name}: {error:e}");
        }
    }
}

fn off_attitude(q: [f64; 4], p: [f64; 4]) -> f64 {
    let square = |sign: f64| (0..4).map(|i| (q[i] - sign * p[i]).powi(2)).sum::<f64>();
    square(1.0).min(square(-1.0)).sqrt()
}

/// Balances in double-double. Measured: 3.4e-30.
const BALANCED: f64 = 3e-29;

/// Law: energy minus work, momentum minus impulse, angular momentum minus angular impulse are constant.
#[test]
fn balances_hold_to_the_last_digits() {
    for name in ["table1", "forced"] {
        let (golden, scene, truth) = solved(name, TOLERANCE);
        let zero = DoubleDouble::exact(0.0);
        let balances = |state: usize, actuators: usize| {
            let omega = truth.at::<3>(StateField::Rate, state);
            let rates = truth.at::<2>(StateField::WheelRates, state);
            let velocity = truth.at::<3>(StateField::ComVelocity, state);
            let mass = zero.splat(scene.mass.total);
            let mut momentum = product(constant_matrix(zero, scene.mass.inertia_free), omega);
            let half = zero.splat(0.5);
            let mut energy = half * (dot(momentum, omega) + mass * dot(velocity, velocity));
            for (wheel, rate) in scene.mass.wheels.iter().zip(rates) {
                let axis = constant(zero, wheel.axis);
                let h = zero.splat(wheel.axial) * (dot(axis, omega) + rate);
                momentum = sum(momentum, scaled(h, axis));
                energy += half * h * h / zero.splat(wheel.axial);
            }
            let c_es = dcm_from_quaternion(truth.at(StateField::Attitude, state));
            let work = truth.at::<2>(StateField::Work, actuators);
            let spin = difference(product(c_es, momentum), truth.at(StateField::AngularImpulse, actuators));
            let push = difference(scaled(mass, velocity), truth.at(StateField::Impulse, actuators));
            (energy - work[0] - work[1], spin, push)
        };
        let (energy, spin, push) = balances(0, 0);
        let off = |(e, s, p): (DoubleDouble, [DoubleDouble; 3], [DoubleDouble; 3])| {
            [
                ((e - energy) / energy).high.abs(),
                (norm(difference(s, spin)) / norm(spin)).high,
                (norm(difference(p, push)) / norm(push)).high,
            ]
        };
        let last = golden.truth.len() - 1;
        let worst = (0..=last).flat_map(|point| off(balances(point, point))).fold(0.0, f64::max);
        assert!(worst < BALANCED, "{name}: {worst:e}");
    }
}
