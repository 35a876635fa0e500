//! Filters against models of sensors and against their own assumptions: consistency over many runs, and estimates
//! without noise.

use super::delayed::Filter;
use super::rigid_body_filter::{BodyObservation, BodyStep, MeasuredMotion, RigidBodyFilter};
use super::translation_filter::{MotionObservation, TranslationFilter, TranslationStep};
use super::*;
use crate::control::estimate::Estimate;
use crate::control::laws::plant::Body;
use crate::control::measurement::{Measurement, PointMotion};
use crate::control::measurement::{Values, values};
use crate::control::observes::Observes;
use crate::control::rotation::quaternion_of;
use crate::control::sensors;
use crate::control::sensors::bench::{chi_square, input_on_orbit, sensor, table, truth};
use crate::control::sensors::sensor::Sensor;
use crate::control::small_matrix::diagonal;
use crate::control::truth::DebrisState;
use crate::control::vector::{dcm_from_quaternion, product, sum};
use crate::control::vector::{difference, hamilton, norm, scaled};
use crate::sampling::{Noise, SampleId};
use crate::scene::{DebrisInput, SceneInput};
use crate::scene::{MAX_WHEELS, Scene};

/// Times at which the statistics are judged, and the share of H0 that may fail one of them: each of `TIMES` times NEES
/// and innovations at rest and in a slew.
const TIMES: usize = 20;
const ALPHA: f64 = 0.05 / (4 * TIMES) as f64;

/// Whether a sum of squares with so many degrees of freedom is one that H0 gives: each tail has ALPHA/2.
fn is_chi_square(sum: f64, degrees: f64) -> bool {
    (chi_square(0.5 * ALPHA, degrees)..=chi_square(1.0 - 0.5 * ALPHA, degrees)).contains(&sum)
}

/// Standard normal numbers of run `run`.
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

/// What many runs of the attitude filter with gyro and star tracker found: sums of NEES (6) and of squares of
/// innovations (3) at each time, root mean square of the bias's error at the end.
struct Found {
    errors: [f64; TIMES],
    innovations: [f64; TIMES],
    bias: f64,
}

/// `runs` runs with the rate `omega` from the sensor models, of a filter that is told `told` times the noise of the
/// tracker.
fn attitude_runs(runs: u64, omega: [f64; 3], told: f64) -> Found {
    let nominal = &Scene::resolve(&SceneInput::report()).expect("a valid scene");
    let own = &[("initial_attitude_sigma_rad", &START[..1]), ("initial_bias_sigma_rad_s", &START[1..])];
    let parameters = &table("mekf", kind("mekf").expect("a kind").parameters, own);
    let declared = |kind: &str| sensors::kind(kind).expect("a kind").parameters;
    let gyro = &table("gyro", declared("rate_gyro"), &GYRO);
    let believed = TRACKER_NOISE.map(|noise| told * noise);
    let tracker = &table("tracker", declared("star_tracker"), &[("noise_rad", &believed)]);
    let known =
        |kind: &str, parameters| KnownSensor { observes: observes(kind), period: 1.0, latency: 0.0, parameters };
    let sensors = [known("rate_gyro", gyro), known("star_tracker", tracker)];
    let context = EstimatorContext { nominal, parameters, sensors: &sensors, tick: 1.0 };
    let mut found = Found { errors: [0.0; TIMES], innovations: [0.0; TIMES], bias: 0.0 };
    for run in 1..=runs {
        let mut draws = Draws::of(run);
        let mut q = hamilton(nominal.initial.q_es, quaternion_of(draws.vector(START[0])));
        let bias = draws.vector(START[1]);
        let mut gyro = sensor("rate_gyro", &[GYRO[0], GYRO[1], ("bias_rad_s", &bias)], 1.0, run);
        let mut tracker = sensor("star_tracker", &[("noise_rad", &TRACKER_NOISE)], 2.0, run);
        let mut filter = (kind("mekf").expect("a kind").make)(&context);
        let (mut error, mut estimate) = (0.0, context.start());
        for tick in 0..2 * TIMES as u64 {
            let truth = &truth(tick as f64, q, omega);
            let mut measurements: Vec<_> =
                gyro.measure(tick, truth).map(|values| at_once(0, values)).into_iter().collect();
            if tick % 2 == 1 {
                measurements.extend(tracker.measure(tick / 2, truth).map(|values| at_once(1, values)));
            }
            filter.update(&update(tick, 1.0, &measurements), &mut estimate);
            if tick % 2 == 1 {
                let time = (tick / 2) as usize;
                let consistency = filter.consistency(truth, gyro.bias_s());
                found.errors[time] += consistency.attitude.expect("NEES").value;
                found.innovations[time] += consistency.attitude_innovation.expect("an innovation").value;
                error = norm(difference(estimate.gyro_bias_s, gyro.bias_s().expect("a bias")));
            }
            q = hamilton(q, quaternion_of(omega));
        }
        found.bias += error * error;
    }
    found.bias = (found.bias / (3 * runs) as f64).sqrt();
    found
}

/// What is known at a tick without actuation.
pub fn update(tick: u64, period: f64, measurements: &[Measurement]) -> Update<'_> {
    Update {
        interval: if tick == 0 { 0.0 } else { period },
        measurements,
        acceleration_s: [0.0; 3],
        torque_s: [0.0; 3],
        motor_torques: [0.0; MAX_WHEELS],
        perfect: None,
    }
}

/// What the sensor at the place `sensor` delivers without latency.
pub fn at_once(sensor: usize, values: Values) -> Measurement {
    Measurement { sensor, values, age: 0.0 }
}

/// What sensors of the kind called `kind` observe.
pub fn observes(kind: &str) -> Observes {
    sensors::kind(kind).expect("a kind").observes
}

/// H0: NEES and innovations of 1,000 runs at 20 times are chi-square; family-wise alpha 0.05 with the other rate, seeds
/// 5 and 8. A mean that is wrong by 10% is found with a probability above 0.99 at each time. The bias is known ten
/// times better than at the start (17 and 10.4 times).
fn assert_consistent(omega: [f64; 3]) {
    let found = attitude_runs(1_000, omega, 1.0);
    for time in 0..TIMES {
        assert!(is_chi_square(found.errors[time], 6_000.0), "NEES {} at {time}", found.errors[time]);
        assert!(is_chi_square(found.innovations[time], 3_000.0), "innovations {} at {time}", found.innovations[time]);
    }
    assert!(found.bias < START[1] / 10.0, "{}", found.bias);
}

/// Law: the filter is consistent at rest.
#[test]
fn attitude_and_bias_are_consistent_at_rest() {
    assert_consistent([0.0; 3]);
}

/// Law: it is in a slew.
#[test]
fn attitude_and_bias_are_consistent_in_a_slew() {
    assert_consistent([0.2, -0.5, 0.3]);
}

/// Law: a filter that is told 0.8 or 1.25 times the noise of the tracker fails, in innovations and in NEES.
#[test]
fn wrong_noise_is_found() {
    for told in [0.8, 1.25] {
        let found = attitude_runs(250, [0.2, -0.5, 0.3], told);
        let count = |sums: &[f64], degrees| sums.iter().filter(|sum| !is_chi_square(**sum, degrees)).count();
        let (errors, innovations) = (count(&found.errors, 1_500.0), count(&found.innovations, 750.0));
        assert!(errors >= 15 && innovations >= 15, "{errors} and {innovations} of {TIMES}");
    }
}

/// Law: position and velocity of a thrusting point, and attitude and rate of a tumbling body that is not seen for a
/// while, have chi-square errors and innovations where truth and filter have the same noise: 200 runs, 20 times,
/// family-wise alpha 0.05, seed 8.
#[test]
fn translation_and_debris_are_consistent() {
    let (runs, t) = (200, 0.5_f64);
    let (walk, sigmas, noise, acceleration) = (2e-3, [0.5, 0.02], [0.3, 0.05], [0.01, -0.02, 0.005]);
    let (body_walk, body_sigmas, body_noise) = (1e-4, [0.02, 2e-3], [5e-3, 2e-3]);
    let start = Body { inertia: [300.0, 420.0, 180.0], q_es: [0.5, 0.5, -0.5, 0.5], omega: [0.08, -0.05, 0.1] };
    let mut all = [[0.0; 4]; TIMES];
    for run in 1..=runs {
        let mut draws = Draws::of(run);
        let zero = PointMotion { r_e: [0.0; 3], v_e: [0.0; 3] };
        let mut point = PointMotion { r_e: draws.vector(sigmas[0]), v_e: draws.vector(sigmas[1]) };
        let mut filter = TranslationFilter::new(zero, sigmas, walk, None);
        let mut body = start;
        body.q_es = hamilton(body.q_es, quaternion_of(draws.vector(body_sigmas[0])));
        body.omega = sum(body.omega, draws.vector(body_sigmas[1]));
        let mut body_filter = RigidBodyFilter::new(start.matrix(), start.q_es, start.omega, body_sigmas, body_walk);
        for (time, sums) in all.iter_mut().enumerate() {
            // white noise of the acceleration over t: walk of the velocity, and what of it is in the position
            let (of_velocity, apart) = (draws.vector(walk * t.sqrt()), draws.vector(walk * t * (t / 12.0).sqrt()));
            let moved = sum(scaled(t, point.v_e), scaled(0.5 * t * t, acceleration));
            point.r_e = sum(sum(point.r_e, moved), sum(scaled(0.5 * t, of_velocity), apart));
            point.v_e = sum(sum(point.v_e, scaled(t, acceleration)), of_velocity);
            filter.propagate(&TranslationStep { acceleration_e: acceleration, interval: t });
            let seen = PointMotion {
                r_e: sum(point.r_e, draws.vector(noise[0])),
                v_e: sum(point.v_e, draws.vector(noise[1])),
            };
            let square = filter.update(&MotionObservation { motion: seen, sigmas: noise });
            sums[0] += filter.error_square(&point).expect("NEES").value;
            sums[1] += square.expect("an innovation").value;

            body.step([0.0; 3], t, 4);
            let (of_rate, apart) =
                (draws.vector(body_walk * t.sqrt()), draws.vector(body_walk * t * (t / 12.0).sqrt()));
            body.q_es = hamilton(body.q_es, quaternion_of(sum(scaled(0.5 * t, of_rate), apart)));
            body.omega = sum(body.omega, of_rate);
            body_filter.propagate(&BodyStep { torque: [0.0; 3], momentum: [0.0; 3], interval: t });
            let q_es = hamilton(body.q_es, quaternion_of(draws.vector(body_noise[0])));
            let rate = sum(body.omega, draws.vector(body_noise[1]));
            if !(5..12).contains(&time) {
                let [of_turn, of_rate] = body_noise.map(|sigma| diagonal([sigma * sigma; 3]));
                let seen =
                    MeasuredMotion { q: q_es, attitude_covariance: of_turn, omega: rate, rate_covariance: of_rate };
                let square = body_filter.update(&BodyObservation::AttitudeAndRate(seen));
                sums[3] += square.expect("an innovation").value;
            }
            sums[2] += body_filter.error_square(body.q_es, body.omega).expect("NEES").value;
        }
    }
    for (time, sums) in all.iter().enumerate() {
        for (index, sum) in sums.iter().enumerate().filter(|(_, sum)| **sum > 0.0) {
            assert!(is_chi_square(*sum, 6.0 * runs as f64), "{index}: {sum} at {time}");
        }
    }
}

/// The sensors of a nominal run, which have no noise, with what the filters believe of it; the period of the gyro in
/// ticks of 0.1 s, 0 for none.
struct Nominal {
    names: Vec<&'static str>,
    /// Period and latency, s.
    times: Vec<[f64; 2]>,
    tables: Vec<crate::scene::DeclaredTable>,
    sampled: Vec<sensors::SampledSensor>,
}

impl Nominal {
    fn new(gyro_period: u64) -> Self {
        let mut all = Nominal { names: Vec::new(), times: Vec::new(), tables: Vec::new(), sampled: Vec::new() };
        if gyro_period > 0 {
            all.add("rate_gyro", gyro_period, 0, &[GYRO[0], ("bias_rad_s", &[2e-4, 0.0, -1e-4])]);
        }
        all.add("star_tracker", 5, 2, &[("noise_rad", &[1e-5, 1e-5, 1e-5])]);
        all.add("ground_radar", 10, 3, &[("position_noise_m", &[0.1]), ("velocity_noise_m_s", &[0.001])]);
        all.add("relative_camera", 4, 4, &[("attitude_noise_rad", &[1e-3]), ("rate_noise_rad_s", &[1e-3])]);
        all
    }

    fn add(&mut self, kind: &'static str, every: u64, latency: u64, values: &[(&str, &[f64])]) {
        self.names.push(kind);
        self.times.push([every, latency].map(|ticks| 0.1 * ticks as f64));
        self.tables.push(table("nominal", sensors::kind(kind).expect("a kind").parameters, values));
        let model: Box<dyn Sensor> = sensor(kind, values, 0.1 * every as f64, 0);
        self.sampled.push(sensors::SampledSensor::new(model, every, latency, 0.1));
    }
}

/// The errors of the estimator `name` after 60 s in a slew at a constant rate with thrust, beside tumbling debris, from
/// sensors without noise but with latency: the truth starts apart from the nominal scene.
fn errors_without_noise(name: &str, gyro_period: u64) -> (crate::control::estimate::EstimateErrors, Estimate) {
    let input = SceneInput::report().with_debris(DebrisInput::Box { size_m: [1.0, 2.0, 3.0], density_kg_m3: 100.0 });
    let mut nominal = Scene::resolve(&input).expect("a valid scene");
    // p turns about c: where c is relative to it depends on when it was seen
    nominal.mass.center = [0.4, -0.3, 0.2];
    let nominal = &nominal;
    let mut sensors = Nominal::new(gyro_period);
    let kind = kind(name).expect("a kind");
    let parameters = &table("estimator", kind.parameters, &[]);
    let known = |((kind, [period, latency]), parameters): ((&'static str, [f64; 2]), _)| KnownSensor {
        observes: observes(kind),
        period,
        latency,
        parameters,
    };
    let names = sensors.names.iter().copied().zip(sensors.times.iter().copied());
    let tables: Vec<_> = names.zip(&sensors.tables).map(known).collect();
    let context = EstimatorContext { nominal, parameters, sensors: &tables, tick: 0.1 };
    let (mut estimator, mut estimate) = ((kind.make)(&context), context.start());
    let body = nominal.mass.debris.as_ref().expect("debris").inertia;
    let mut debris =
        Body { inertia: [body[0][0], body[1][1], body[2][2]], q_es: [0.8, 0.6, 0.0, 0.0], omega: [0.03, -0.02, 0.04] };
    // about a principal axis of the body, so that the rate is constant without torque
    let omega = [0.0, 0.0, 0.02];
    let mut q = quaternion_of([0.05, -0.02, 0.03]);
    let (mut r, mut v) = ([3.0, -2.0, 1.0], [0.05, 0.0, -0.02]);
    let acceleration_s = [0.0, 0.0, 1e-3];
    let (r_gdo, v_gdo) = ([25.0, 4.0, -1.0], [0.0, 0.03, 0.0]);
    let mut last = None;
    for tick in 0..=600 {
        let mut at = truth(0.1 * tick as f64, q, omega);
        (at.body.r_co_e, at.body.v_co_e) = (r, v);
        at.r_cp_s = nominal.mass.center;
        let r_gdo_e = sum(r_gdo, scaled(at.time, v_gdo));
        at.debris = Some(DebrisState { r_gdo_e, v_gdo_e: v_gdo, q_ed: debris.q_es, omega_de_d: debris.omega });
        let mut measurements = Vec::new();
        for (place, sensor) in sensors.sampled.iter_mut().enumerate() {
            measurements.extend(sensor.deliver(place, tick, &at));
        }
        let state = Estimate::perfect(&at);
        let perfect = kind.knows_the_truth.then_some(&state);
        estimator.update(&Update { acceleration_s, perfect, ..update(tick, 0.1, &measurements) }, &mut estimate);
        last = Some((estimate.errors(&at), estimate));
        debris.step([0.0; 3], 0.1, 4);
        let q_after = hamilton(q, quaternion_of(scaled(0.1, omega)));
        // the thrust's axis is that of the turn, so that its direction in F_e is constant
        let acceleration = product(dcm_from_quaternion(q), acceleration_s);
        r = sum(r, sum(scaled(0.1, v), scaled(0.005, acceleration)));
        v = sum(v, scaled(0.1, acceleration));
        q = q_after;
    }
    last.expect("ticks")
}

/// Law: without noise the filters find the truth in spite of latencies of up to four ticks, a bias, a wrong start, and
/// a gyro that is slower than the loop or not there. What is left is what they have not forgotten of the start: bounds
/// are five to ten times the errors with the gyro.
#[test]
fn estimates_without_noise_are_the_truth() {
    for gyro_period in [1, 2, 0] {
        let (errors, estimate) = errors_without_noise("mekf", gyro_period);
        assert!(errors.attitude < 1e-5 && errors.rate < 2e-5, "{gyro_period}: {errors:?}");
        assert!(errors.position < 2e-3 && errors.velocity < 5e-5, "{gyro_period}: {errors:?}");
        assert!(errors.relative_position < 2e-3 && errors.relative_velocity < 5e-5, "{gyro_period}: {errors:?}");
        assert!(errors.debris_attitude < 1e-5 && errors.debris_rate < 5e-7, "{gyro_period}: {errors:?}");
        if gyro_period > 0 {
            assert!(norm(difference(estimate.gyro_bias_s, [2e-4, 0.0, -1e-4])) < 2e-5, "{:?}", estimate.gyro_bias_s);
        }
    }
}

/// Law: raw measurements are late by the latency and what is held; the rate has the gyro's bias, or without a gyro is
/// that between attitudes. Perfect knowledge has no error.
#[test]
fn raw_measurements_are_late_and_perfect_knowledge_is_not() {
    // tick 600: the last attitude is of tick 595, delivered at 597
    let lag = 5.0 * 0.1 * 0.02;
    for (gyro_period, rate) in [(1, norm([2e-4, 0.0, -1e-4])), (0, 0.0)] {
        let (late, _) = errors_without_noise("raw", gyro_period);
        assert!((late.attitude - lag).abs() < 1e-13 && (late.rate - rate).abs() < 1e-14, "{late:?}");
    }
    let (none, _) = errors_without_noise("perfect", 1);
    assert!(
        none.attitude < 1e-15 && none.relative_position == 0.0 && none.rate == 0.0 && none.debris_rate == 0.0,
        "{none:?}"
    );
}

/// Law: every kind has a name of its own, and a default for each component of each key.
#[test]
fn kinds_have_names_and_defaults() {
    for (index, one) in KINDS.iter().enumerate() {
        assert!(KINDS[..index].iter().all(|other| other.name != one.name));
        for parameter in one.parameters {
            let default = parameter.default.map(<[f64]>::len);
            assert_eq!(default, Some(parameter.facts.components.len()), "{} {}", one.name, parameter.facts.key);
        }
    }
}

/// Law: without torque on the whole, the momentum in F_e and the energy of rotation stay where wheels have a constant
/// momentum in the body, to 2e-9 (measured: 2.9e-10 over 600 steps of 0.014 rad).
#[test]
fn a_body_with_wheels_keeps_momentum_and_energy() {
    let inertia = diagonal([300.0, 420.0, 180.0]);
    let momentum = [5.0, -12.0, 8.0];
    let mut filter = RigidBodyFilter::new(inertia, [0.5, 0.5, -0.5, 0.5], [0.08, -0.05, 0.1], [0.0; 2], 0.0);
    let invariants = |filter: &RigidBodyFilter| {
        let of_body = product(inertia, filter.omega);
        let in_space = product(dcm_from_quaternion(filter.q), sum(of_body, momentum));
        (in_space, 0.5 * crate::control::vector::dot(filter.omega, of_body))
    };
    let before = invariants(&filter);
    for _ in 0..600 {
        filter.propagate(&BodyStep { torque: [0.0; 3], momentum, interval: 0.1 });
    }
    let after = invariants(&filter);
    let error = norm(difference(after.0, before.0)) / norm(before.0);
    assert!(error < 2e-9 && (after.1 / before.1 - 1.0).abs() < 2e-11, "{error} and {}", after.1 / before.1 - 1.0);
}

/// Law: between tachometer readings the axial momentum of a wheel grows by the commanded torque of its motor, whatever
/// the body does; the rotations of a gyro that is faster than the loop are joined in their order.
#[test]
fn wheels_follow_their_motors_and_fast_gyros_are_joined() {
    let nominal = &Scene::resolve(&SceneInput::report()).expect("a valid scene");
    let mekf = kind("mekf").expect("a kind");
    let parameters = &table("mekf", mekf.parameters, &[]);
    let context = EstimatorContext { nominal, parameters, sensors: &[], tick: 0.1 };
    let (mut estimator, mut last) = ((mekf.make)(&context), context.start());
    let wheel = nominal.mass.wheels[0];
    let (torque_s, mut motor_torques) = (scaled(-0.4, wheel.axis), [0.0; MAX_WHEELS]);
    motor_torques[0] = 0.4;
    for tick in 0..=50 {
        estimator.update(&Update { torque_s, motor_torques, ..update(tick, 0.1, &[]) }, &mut last);
    }
    let of_body = crate::control::vector::dot(wheel.axis, last.omega_se_s);
    let momentum = wheel.axial * (last.wheel_rates[0] + of_body);
    assert!((momentum - 0.4 * 5.0).abs() < 1e-12 && of_body < 0.0, "{momentum}");

    let gyro = &table("gyro", sensors::kind("rate_gyro").expect("a kind").parameters, &[]);
    let context = EstimatorContext {
        nominal,
        parameters,
        sensors: &[KnownSensor { observes: observes("rate_gyro"), period: 0.05, latency: 0.0, parameters: gyro }],
        tick: 0.1,
    };
    let (mut estimator, mut estimate) = ((mekf.make)(&context), context.start());
    let rotations = [[0.3, 0.0, 0.1], [0.0, -0.4, 0.2]];
    let measurements = rotations.map(|rotation_s| at_once(0, values(&[&rotation_s])));
    estimator.update(&update(1, 0.1, &measurements), &mut estimate);
    let q = rotations.iter().fold(nominal.initial.q_es, |q, rotation| hamilton(q, quaternion_of(*rotation)));
    assert!(estimate.q_es.iter().zip(q).all(|(a, b)| (a - b).abs() < 4e-16), "{:?} for {q:?}", estimate.q_es);
}

/// Law: each kind of sensor that an estimator is said to use changes its estimate, and no other does: what nobody uses
/// is refused by `check`, not ignored.
#[test]
fn each_sensor_that_is_used_changes_the_estimate() {
    let input = input_on_orbit().with_debris(DebrisInput::Box { size_m: [1.0, 2.0, 3.0], density_kg_m3: 100.0 });
    let nominal = &Scene::resolve(&input).expect("a valid scene");
    let half = std::f64::consts::FRAC_PI_2;
    let quarters = [[0.1, 0.0, 0.0], [half, 0.1, 0.0], [0.1, half, 0.0], [-half, 0.0, 0.1], [0.0, -half, 0.1]];
    let mut pairs = 0;
    for estimator in KINDS.iter().filter(|kind| !kind.knows_the_truth) {
        let parameters = &table("estimator", estimator.parameters, &[]);
        for kind in &sensors::KINDS {
            let known = table("unit", kind.parameters, &[]);
            let sensors = [KnownSensor { observes: kind.observes, period: 0.1, latency: 0.0, parameters: &known }];
            let context = EstimatorContext { nominal, parameters, sensors: &sensors, tick: 0.1 };
            // an attitude at which a sensor with a field of view sees what it looks for
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
                let (mut made, mut estimate) = ((estimator.make)(&context), context.start());
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
