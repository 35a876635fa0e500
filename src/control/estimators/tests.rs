//! Filters against models of sensors and their own assumptions: consistency over many runs, and estimates without
//! noise.

use super::*;
use crate::control::estimate::{DebrisState, Estimate};
use crate::control::laws::plant::Body;
use crate::control::measurement::{Measurement, Values};
use crate::control::observes::Observes;
use crate::control::outcome::estimation::{Consistency, EstimateErrors};
use crate::control::rotation::{quaternion_of, vector_of};
use crate::control::sensors;
use crate::control::sensors::bench::{chi_square, input_on_orbit, sensor, table, truth};
use crate::control::sensors::sensor::Sensor;
use crate::control::truth::Truth;
use crate::control::vector::{conjugate, dcm_from_quaternion, difference, hamilton, norm, product, scaled, sum};
use crate::sampling::{Noise, SampleId};
use crate::scene::{DebrisInput, MAX_WHEELS, Scene, SceneInput};

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
    let nominal = &Scene::resolve(&SceneInput::report()).expect("a valid scene");
    let own = &[("initial_attitude_sigma_rad", &START[..1]), ("initial_bias_sigma_rad_s", &START[1..])];
    let parameters = &table("mekf", kind("mekf").expect("a kind").parameters, own);
    let declared = |kind: &str| sensors::kind(kind).expect("a kind").parameters;
    let gyro = &table("gyro", declared("rate_gyro"), &GYRO);
    let tracker = &table("tracker", declared("star_tracker"), &[("noise_rad", &TRACKER_NOISE)]);
    let sensors = [known("rate_gyro", 1.0, gyro), known("star_tracker", 1.0, tracker)];
    let context = EstimatorContext { nominal, parameters, sensors: &sensors, tick: 1.0 };
    let (mut errors, mut innovations, mut bias_square) = ([0.0; TIMES], [0.0; TIMES], 0.0);
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

/// A sensor of the kind `kind` as estimators know it.
pub fn known<'a>(kind: &str, period: f64, parameters: &'a crate::scene::DeclaredTable) -> KnownSensor<'a> {
    KnownSensor { observes: observes(kind), period, latency: 0.0, parameters }
}

/// Input at a tick without actuation.
pub fn update(tick: u64, period: f64, measurements: &[Measurement]) -> Update<'_> {
    Update {
        interval: if tick == 0 { 0.0 } else { period },
        measurements,
        acceleration_s: [0.0; 3],
        torque_s: [0.0; 3],
        motor_torques: [0.0; MAX_WHEELS],
        state: None,
    }
}

/// A measurement without latency by the sensor at the index `sensor`.
pub fn at_once(sensor: usize, values: Values) -> Measurement {
    Measurement { sensor, values, age: 0.0 }
}

pub fn observes(kind: &str) -> Observes {
    sensors::kind(kind).expect("a kind").observes
}

/// Noiseless sensors, with the filters' models; `gyro_period` in ticks of 0.1 s, 0 for none.
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

/// Estimate and truth after 60 s of a slew at constant rate under thrust beside tumbling debris, with noiseless but
/// late sensors and a truth that starts off the nominal scene.
fn without_noise(gyro_period: u64) -> (Estimate, Truth) {
    let input = SceneInput::report().with_debris(DebrisInput::Box { size_m: [1.0, 2.0, 3.0], density_kg_m3: 100.0 });
    let mut nominal = Scene::resolve(&input).expect("a valid scene");
    // p turns about c, so that c relative to it depends on the time of the measurement
    nominal.mass.center = [0.4, -0.3, 0.2];
    let nominal = &nominal;
    let mut sensors = Nominal::new(gyro_period);
    let kind = kind("mekf").expect("a kind");
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
    // a principal axis of the body: without torque the rate is constant
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
        estimator.update(&Update { acceleration_s, ..update(tick, 0.1, &measurements) }, &mut estimate);
        last = Some((estimate, at));
        debris.step([0.0; 3], 0.1, 4);
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
