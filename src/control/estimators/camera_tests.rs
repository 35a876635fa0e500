//! An image of the debris is as uncertain, and about the same axes, as the attitude through which it was taken.

use super::tests::{at_once, known, update};
use super::*;
use crate::control::estimate::DebrisState;
use crate::control::measurement::values;
use crate::control::outcome::estimation::Consistency;
use crate::control::rotation::quaternion_of;
use crate::control::sensors;
use crate::control::sensors::bench::{table, truth};
use crate::control::vector::{dcm_from_quaternion, hamilton, scaled, transposed_product};
use crate::scene::Scene;
use crate::scene::{DebrisInput, SceneInput};

/// Initial standard deviation of the attitude, rad.
const START: f64 = 0.1;
/// Star tracker noise about s1, s2, s3, rad: poor about its boresight.
const TRACKER: [f64; 3] = [1e-3, 2e-3, 5e-2];
/// Camera noise, rad.
const CAMERA: f64 = 1e-4;
/// Initial standard deviation of the debris's attitude, rad.
const DEBRIS: f64 = 1.0;

/// Law: after one image the debris's attitude has, about each axis of F_s, the variance that follows from those of
/// attitude, camera and start by the sum of information, whatever the rotation from F_d to F_s.
#[test]
fn an_image_is_as_uncertain_as_the_attitude() {
    let input = SceneInput::report().with_debris(DebrisInput::Box { size_m: [1.0, 2.0, 3.0], density_kg_m3: 100.0 });
    let nominal = &Scene::resolve(&input).expect("a valid scene");
    let mekf = kind("mekf").expect("a kind");
    let own: [(&str, &[f64]); 2] = [("initial_attitude_sigma_rad", &[START]), ("debris_attitude_sigma_rad", &[DEBRIS])];
    let parameters = &table("mekf", mekf.parameters, &own);
    let declared = |kind: &str| sensors::kind(kind).expect("a kind").parameters;
    let tracker = &table("tracker", declared("star_tracker"), &[("noise_rad", &TRACKER)]);
    let camera = &table("camera", declared("relative_camera"), &[("attitude_noise_rad", &[CAMERA])]);
    let list = [known("star_tracker", 0.1, tracker), known("relative_camera", 0.1, camera)];
    for turn in [[0.0; 3], [1.2, 0.0, 0.0], [0.4, -0.9, 1.7]] {
        let context = EstimatorContext { nominal, parameters, sensors: &list, tick: 0.1 };
        let (mut estimator, mut estimate) = ((mekf.make)(&context), context.start());
        let q_es = nominal.initial.q_es;
        let q_sd = quaternion_of(turn);
        let mut at = truth(0.0, q_es, [0.0; 3]);
        let debris = |q_ed| DebrisState { r_gdo_e: [0.0; 3], v_gdo_e: [0.0; 3], q_ed, omega_de_d: [0.0; 3] };
        at.debris = Some(debris(hamilton(q_es, q_sd)));
        let seen = [at_once(0, values(&[&q_es])), at_once(1, values(&[&q_sd, &[0.0; 3]]))];
        estimator.update(&update(0, 0.1, &seen), &mut estimate);
        let found = estimate.debris.expect("debris");
        for axis in 0..3 {
            let mut unit = [0.0; 3];
            unit[axis] = 1.0;
            // the axis of F_s in F_d
            let unit_d = transposed_product(dcm_from_quaternion(q_sd), unit);
            let error = 1e-6;
            at.debris = Some(DebrisState {
                omega_de_d: found.omega_de_d,
                ..debris(hamilton(found.q_ed, quaternion_of(scaled(error, unit_d))))
            });
            let square = 6.0 * Consistency::of(&estimator.filters(), &estimate, &at, None).squares[3][0];
            let attitude = 1.0 / (1.0 / (START * START) + 1.0 / (TRACKER[axis] * TRACKER[axis]));
            let variance = 1.0 / (1.0 / (DEBRIS * DEBRIS) + 1.0 / (attitude + CAMERA * CAMERA));
            let expected = error * error / variance;
            assert!((square / expected - 1.0).abs() < 1e-6, "{turn:?} {axis}: {square:e} for {expected:e}");
        }
    }
}
