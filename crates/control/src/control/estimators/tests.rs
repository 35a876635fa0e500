//! Filters against models of sensors and their own assumptions: consistency over many runs, and estimates without
//! noise.

use super::*;
use crate::control::outcome::estimation::{Consistency, EstimateErrors};
use crate::control::sensors;
use crate::control::sensors::bench::{chi_square, input_on_orbit, sensor, table, truth};
use crate::control::truth::{DebrisMotion, Truth};
use crate::loops::estimate::{DebrisState, Estimate};
use crate::loops::measurement::{Measurement, Values, values};
use crate::loops::vector::{
    conjugate, dcm_from_quaternion, difference, hamilton, norm, product, quaternion_of, scaled, sum,
    transposed_product, vector_of,
};
use crate::sampling::{Noise, SampleId};
use crate::scene::{DebrisInput, DeclaredTable, MAX_WHEELS, Scene, SceneInput};

/// Number of times judged, and the family-wise error rate shared by NEES and innovations at each of them, at rest and
/// in a slew.
const TIMES: usize = 20;
const ALPHA: f64 = 0.05 / (4 * TIMES) as f64;

/// True if a chi-square sum is within two-sided ALPHA.
fn is_chi_square(sum: f64, degrees: f64) -> bool {
    (chi_square(0.5 * ALPHA, degrees)..=chi_square(1.0 - 0.5 * ALPHA, degrees)).contains(&sum)
}

/// Standard normal numbers of one run.
struct Draws(Noise, u64);

impl Draws {
    fn of(run: u64) -> Self {
        Draws(Noise::new(8, "test", SampleId(run)), 0)
    }

    fn vector(&mut self, deviation: f64) -> [f64; 3] {
        std::array::from_fn(|_| {
            self.1 += 1;
            deviation * self.0.normal(self.1)
        })
    }
}

const GYRO: [(&str, &[f64]); 2] =
    [("angular_random_walk_rad_sqrt_s", &[1e-4]), ("bias_random_walk_rad_s_sqrt_s", &[2e-5])];
const TRACKER_NOISE: [f64; 3] = [2e-4, 3e-4, 1e-3];
const START: [f64; 2] = [5e-3, 1e-3];

/// Law: in a slew the filter with gyro and star tracker is consistent: NEES (6) and innovations (3) of 1,000 runs at 20
/// times are chi-square at a family-wise alpha of 0.05 (seeds 5 and 8); a mean wrong by 10% is detected with a
/// probability above 0.99 at each time. The bias becomes ten times better known.
#[test]
fn attitude_and_bias_are_consistent() {
    let (runs, omega) = (1_000_u64, [0.2, -0.5, 0.3]);
    let nominal = &scene(&SceneInput::report());
    let own = &[("initial_attitude_sigma_rad", &START[..1]), ("initial_bias_sigma_rad_s", &START[1..])];
    let (parameters, gyro) = (&table("mekf", own), &table("rate_gyro", &GYRO));
    let tracker = &table("star_tracker", &[("noise_rad", &TRACKER_NOISE)]);
    let sensors = [known("rate_gyro", [1.0, 0.0], gyro), known("star_tracker", [1.0, 0.0], tracker)];
    let context = EstimatorContext { nominal, parameters, sensors: &sensors, tick: 1.0 };
    let (mut errors, mut innovations, mut bias_square) = ([0.0; TIMES], [0.0; TIMES], 0.0);
    for run in 1..=runs {
        let mut draws = Draws::of(run);
        let mut q = hamilton(nominal.initial.q_es, quaternion_of(draws.vector(START[0])));
        let bias = draws.vector(START[1]);
        let mut gyro = sensor("rate_gyro", &[GYRO[0], GYRO[1], ("bias_rad_s", &bias)], 1.0, run);
        let mut tracker = sensor("star_tracker", &[("noise_rad", &TRACKER_NOISE)], 2.0, run);
        let (mut error, (mut filter, mut estimate)) = (0.0, started("mekf", &context));
        for tick in 0..2 * TIMES as u64 {
            let truth = &truth(tick as f64, q, omega);
            let mut measurements: Vec<_> =
                gyro.measure(tick, truth).map(|values| at_once(0, values)).into_iter().collect();
            if tick % 2 == 1 {
                measurements.extend(tracker.measure(tick / 2, truth).map(|values| at_once(1, values)));
            }
            filter.update(&update(tick, 1.0, &measurements), &mut estimate);
            if tick % 2 == 1 {
                let squares = Consistency::of(&filter.filters(), &estimate, truth, gyro.bias_s()).squares[0];
                errors[(tick / 2) as usize] += 6.0 * squares[0];
                innovations[(tick / 2) as usize] += 3.0 * squares[1];
                error = norm(difference(estimate.gyro_bias_s, gyro.bias_s().expect("a bias")));
            }
            q = hamilton(q, quaternion_of(omega));
        }
        bias_square += error * error;
    }
    for time in 0..TIMES {
        assert!(is_chi_square(errors[time], 6.0 * runs as f64), "NEES {} at {time}", errors[time]);
        assert!(is_chi_square(innovations[time], 3.0 * runs as f64), "innovations {} at {time}", innovations[time]);
    }
    let bias = (bias_square / (3 * runs) as f64).sqrt();
    assert!(bias < START[1] / 10.0, "{bias}");
}

fn scene(input: &SceneInput) -> Scene {
    Scene::resolve(input).expect("a valid scene")
}

const DEBRIS: DebrisInput = DebrisInput::Box { size_m: [1.0, 2.0, 3.0], density_kg_m3: 100.0 };

/// A sensor of the kind `kind` as estimators know it.
fn known<'a>(kind: &str, [period, latency]: [f64; 2], parameters: &'a DeclaredTable) -> KnownSensor<'a> {
    KnownSensor { observes: sensors::maker(kind).expect("a kind").kind.observes, period, latency, parameters }
}

/// Input at a tick without actuation.
fn update(tick: u64, period: f64, measurements: &[Measurement]) -> Update<'_> {
    Update {
        interval: if tick == 0 { 0.0 } else { period },
        measurements,
        acceleration_s: [0.0; 3],
        torque_s: [0.0; 3],
        motor_torques: [0.0; MAX_WHEELS],
        state: None,
    }
}

/// The estimator `name` and its estimate at the start.
fn started(name: &str, context: &EstimatorContext<'_>) -> (Box<dyn Estimator>, Estimate) {
    ((maker(name).expect("a kind").make)(context), context.start())
}

/// A measurement without latency by the sensor at the index `sensor`.
fn at_once(sensor: usize, values: Values) -> Measurement {
    Measurement { sensor, values, age: 0.0 }
}

/// Estimate and truth after 60 s of a slew at constant rate under thrust beside tumbling debris, with noiseless but
/// late sensors and a truth that starts off the nominal scene; `gyro_period` in ticks of 0.1 s, 0 for none.
/// Updates are at the ticks at which a sensor measures or delivers.
fn without_noise(gyro_period: u64) -> (Estimate, Truth) {
    let mut nominal = scene(&SceneInput::report().with_debris(DEBRIS));
    // p turns about c, so that c relative to it depends on the time of the measurement
    nominal.mass.center = [0.4, -0.3, 0.2];
    let nominal = &nominal;
    type Key<'a> = (&'a str, &'a [f64]);
    let mut list: Vec<(&str, [u64; 2], &[Key<'_>])> = vec![
        ("star_tracker", [5, 2], &[("noise_rad", &[1e-5; 3])]),
        ("ground_radar", [10, 3], &[("position_noise_m", &[0.1]), ("velocity_noise_m_s", &[0.001])]),
        ("relative_camera", [4, 4], &[("attitude_noise_rad", &[1e-3]), ("rate_noise_rad_s", &[1e-3])]),
    ];
    if gyro_period > 0 {
        list.insert(0, ("rate_gyro", [gyro_period, 0], &[GYRO[0], ("bias_rad_s", &[2e-4, 0.0, -1e-4])]));
    }
    let tables: Vec<_> = list.iter().map(|(kind, _, values)| table(kind, values)).collect();
    let times = |ticks: &[u64; 2]| ticks.map(|ticks| 0.1 * ticks as f64);
    let sensors = list.iter().zip(&tables).map(|((kind, ticks, _), table)| known(kind, times(ticks), table));
    let sensors: Vec<_> = sensors.collect();
    let sampled = list.iter().map(|(kind, [every, latency], values)| {
        sensors::SampledSensor::new(sensor(kind, values, 0.1 * *every as f64, 0), *every, *latency, 0.1)
    });
    let mut sampled: Vec<_> = sampled.collect();
    let context = EstimatorContext { nominal, parameters: &table("mekf", &[]), sensors: &sensors, tick: 0.1 };
    let (mut estimator, mut estimate) = started("mekf", &context);
    let mut tumbling = nominal.clone();
    (tumbling.initial.q_ed, tumbling.initial.omega_de_d) = ([0.8, 0.6, 0.0, 0.0], [0.03, -0.02, 0.04]);
    let mut debris = DebrisMotion::of(&tumbling).expect("debris");
    // a principal axis of the body: without torque the rate is constant
    let omega = [0.0, 0.0, 0.02];
    let mut q = quaternion_of([0.05, -0.02, 0.03]);
    let (mut r, mut v) = ([3.0, -2.0, 1.0], [0.05, 0.0, -0.02]);
    let acceleration_s = [0.0, 0.0, 1e-3];
    let (r_gdo, v_gdo) = ([25.0, 4.0, -1.0], [0.0, 0.03, 0.0]);
    let (mut last, mut updated) = (None, 0);
    for tick in 0..=600 {
        let mut at = truth(0.1 * tick as f64, q, omega);
        (at.body.r_co_e, at.body.v_co_e) = (r, v);
        at.r_cp_s = nominal.mass.center;
        let r_gdo_e = sum(r_gdo, scaled(at.time, v_gdo));
        at.debris = Some(DebrisState { r_gdo_e, v_gdo_e: v_gdo, ..debris.at(at.time) });
        let mut measurements = Vec::new();
        for (place, sensor) in sampled.iter_mut().enumerate() {
            measurements.extend(sensor.deliver(place, tick, &at));
        }
        if !measurements.is_empty() || list.iter().any(|(_, [every, _], _)| tick % every == 0) {
            let interval = 0.1 * (tick - updated) as f64;
            estimator.update(&Update { acceleration_s, ..update(tick, interval, &measurements) }, &mut estimate);
            (last, updated) = (Some((estimate, at)), tick);
        }
        let q_after = hamilton(q, quaternion_of(scaled(0.1, omega)));
        // thrust along the rotation axis has a constant direction in F_e
        let acceleration = product(dcm_from_quaternion(q), acceleration_s);
        r = sum(r, sum(scaled(0.1, v), scaled(0.005, acceleration)));
        v = sum(v, scaled(0.1, acceleration));
        q = q_after;
    }
    last.expect("ticks")
}

/// Law: without noise the filters converge to the truth in spite of latencies up to four ticks, a bias, a wrong start
/// and a slow or absent gyro. Bounds are five to ten times the remaining errors with the gyro.
#[test]
fn estimates_without_noise_are_the_truth() {
    for gyro_period in [1, 2, 0] {
        let (estimate, truth) = without_noise(gyro_period);
        let errors = EstimateErrors::of(&estimate, &truth);
        assert!(errors.attitude < 1e-5 && errors.rate < 2e-5, "{gyro_period}: {errors:?}");
        assert!(errors.relative_position < 2e-3 && errors.relative_velocity < 5e-5, "{gyro_period}: {errors:?}");
        let body = &truth.body;
        let own = [difference(estimate.r_co_e, body.r_co_e), difference(estimate.v_co_e, body.v_co_e)].map(norm);
        assert!(own[0] < 2e-3 && own[1] < 5e-5, "{gyro_period}: {own:?}");
        let (debris, actual) = (estimate.debris.expect("debris"), truth.debris.expect("debris"));
        let turn = vector_of(hamilton(conjugate(debris.q_ed), actual.q_ed));
        let rate = difference(debris.omega_de_d, actual.omega_de_d);
        assert!(norm(turn) < 1e-5 && norm(rate) < 5e-7, "{gyro_period}: {turn:?} {rate:?}");
        if gyro_period > 0 {
            assert!(norm(difference(estimate.gyro_bias_s, [2e-4, 0.0, -1e-4])) < 2e-5, "{:?}", estimate.gyro_bias_s);
        }
    }
}

/// Law: a kind of sensor changes an estimate exactly if the estimator claims to use it, since `check` refuses unused
/// sensors.
#[test]
fn each_sensor_that_is_used_changes_the_estimate() {
    let nominal = &scene(&input_on_orbit().with_debris(DEBRIS));
    let half = std::f64::consts::FRAC_PI_2;
    let quarters = [[0.1, 0.0, 0.0], [half, 0.1, 0.0], [0.1, half, 0.0], [-half, 0.0, 0.1], [0.0, -half, 0.1]];
    let mut pairs = 0;
    for estimator in KINDS.iter().map(|maker| &maker.kind).filter(|kind| !kind.knows_the_truth) {
        let parameters = &table(estimator.name, &[]);
        for kind in sensors::KINDS.iter().map(|maker| &maker.kind) {
            let numbers = table(kind.name, &[]);
            let sensors = [known(kind.name, [0.1, 0.0], &numbers)];
            let context = EstimatorContext { nominal, parameters, sensors: &sensors, tick: 0.1 };
            // an attitude with the sensor's object in its field of view
            let delivered = quarters.iter().find_map(|turn| {
                let mut model = sensor(kind.name, &[], 0.1, 0);
                let mut at = truth(0.0, quaternion_of(*turn), [0.03, -0.02, 0.01]);
                at.wheel_rates = [12.0; MAX_WHEELS];
                at.r_cp_s = [4.0, 5.0, 6.0];
                // on the day side
                at.body.r_co_e = [-6.8e6, -1e6, -2e6];
                let debris = DebrisState {
                    r_gdo_e: [20.0, 3.0, 1.0],
                    v_gdo_e: [0.0, 0.1, 0.0],
                    q_ed: quaternion_of([0.7, 0.2, 0.1]),
                    omega_de_d: [0.02, 0.01, 0.03],
                };
                at.debris = Some(debris);
                model.measure(0, &at);
                at.body.q_es = hamilton(at.body.q_es, quaternion_of(scaled(0.1, at.body.omega_se_s)));
                model.measure(1, &at)
            });
            let delivered = [at_once(0, delivered.unwrap_or_else(|| panic!("{} measures nothing", kind.name)))];
            let after = |measurements: &[Measurement]| {
                let (mut made, mut estimate) = started(estimator.name, &context);
                made.update(&update(1, 0.1, measurements), &mut estimate);
                estimate
            };
            let is_used = (estimator.uses)(&kind.observes);
            assert_eq!(after(&delivered) != after(&[]), is_used, "{} of {}", kind.name, estimator.name);
            pairs += usize::from(is_used);
        }
    }
    assert!(pairs > sensors::KINDS.len(), "{pairs}");
}

/// Law: an image of the debris is as uncertain, about the same axes, as the attitude through which it was taken: after
/// one image the debris's attitude has, about each axis of F_s, the variance that follows from those of attitude,
/// camera and start by the sum of information, whatever the rotation from F_d to F_s.
#[test]
fn an_image_is_as_uncertain_as_the_attitude() {
    // standard deviations, rad: of the start, of the tracker (poor about its boresight), of camera and debris
    let (start, noise, of_camera, of_debris) = (0.1, [1e-3, 2e-3, 5e-2], 1e-4, 1.0);
    let nominal = &scene(&SceneInput::report().with_debris(DEBRIS));
    let own: [(&str, &[f64]); 2] =
        [("initial_attitude_sigma_rad", &[start]), ("debris_attitude_sigma_rad", &[of_debris])];
    let (parameters, tracker) = (&table("mekf", &own), &table("star_tracker", &[("noise_rad", &noise)]));
    let camera = &table("relative_camera", &[("attitude_noise_rad", &[of_camera])]);
    let list = [known("star_tracker", [0.1, 0.0], tracker), known("relative_camera", [0.1, 0.0], camera)];
    for turn in [[0.0; 3], [1.2, 0.0, 0.0], [0.4, -0.9, 1.7]] {
        let context = EstimatorContext { nominal, parameters, sensors: &list, tick: 0.1 };
        let (mut estimator, mut estimate) = started("mekf", &context);
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
            let attitude = 1.0 / (1.0 / (start * start) + 1.0 / (noise[axis] * noise[axis]));
            let variance = 1.0 / (1.0 / (of_debris * of_debris) + 1.0 / (attitude + of_camera * of_camera));
            let expected = error * error / variance;
            assert!((square / expected - 1.0).abs() < 1e-6, "{turn:?} {axis}: {square:e} for {expected:e}");
        }
    }
}
