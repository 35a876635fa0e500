//! A two-axis Sun sensor: the direction of the Sun in the axes of the sensor, as two angles; nothing where the Sun is out of view.
//!
//! The third axis of the sensor, F_t, is its boresight; the others are turned with s3 to it the shortest way. With the direction u of the Sun in F_t the angles
//! are atan(u1/u3) and atan(u2/u3): what two crossed slits measure (J. R. Wertz, *Spacecraft Attitude Determination and Control*, 1978, section 7.1). The rotation about
//! the direction of the Sun is not seen.

use std::sync::Arc;

use super::{Components, MeasuredQuantity, NormalErrors, Sensor, SensorContext, SensorKind, axes, optional};
use crate::control::declared::declared;
use crate::control::estimators::attitude_innovation::{AttitudeInnovation, Innovation};
use crate::control::measurement::{AttitudeSensor, Observes, Values, part, values};
use crate::control::rotation::from_s3_to;
use crate::control::small_matrix::{multiplied, transposed};
use crate::control::truth::Truth;
use crate::control::vector::{cross, dcm_from_quaternion, dot, norm, product, scaled, transposed_product};
use crate::scene::DeclaredTable;
use crate::scene::schema::Limit;

pub(super) const KIND: SensorKind = SensorKind {
    name: "sun_sensor",
    parameters: &PARAMETERS,
    quantities: &[MeasuredQuantity::new(
        "measured_sun_angle",
        Components::Named(&["x", "y"]),
        ["rad", "rad"],
        "Angle of the Sun from the boresight of a Sun sensor, in the plane of this axis and the boresight",
    )],
    observes: Observes::Direction(|table| Arc::new(Geometry::of(table))),
    make: |context| Box::new(SunSensor::new(context)),
};

declared! {
    /// Its numbers in campaign files.
    SunSensorNumbers = PARAMETERS {
    noise: f64 = optional("noise_rad", "rad", "Standard deviation of each angle");
    boresight: [f64; 3] = axes("boresight", "1", "Direction of the boresight in F_s", Limit::Direction).or(&[0.0, 0.0, 1.0]);
    sun_direction: [f64; 3] = axes("sun_direction", "1", "Direction of the Sun in F_e", Limit::Direction).or(&[1.0, 0.0, 0.0]);
    half_field_of_view: f64 = optional(
        "half_field_of_view_rad",
        "rad",
        "Angle from the boresight beyond which it sees nothing; 0: all before it",
    );
    bias: f64 = optional("bias_rad", "rad", "Constant error of both angles");
    }
}

/// Where a sensor and the Sun are, and how exactly it measures.
#[derive(Clone, Copy, Debug)]
struct Geometry {
    /// F_t -> F_s.
    c_st: [[f64; 3]; 3],
    /// Unit vector to the Sun in F_e.
    sun_e: [f64; 3],
    /// Standard deviation of each angle, rad.
    deviation: f64,
}

impl Geometry {
    fn of(table: &DeclaredTable) -> Self {
        let numbers = SunSensorNumbers::of(table);
        let sun = numbers.sun_direction;
        Geometry { c_st: from_s3_to(numbers.boresight), sun_e: scaled(1.0 / norm(sun), sun), deviation: numbers.noise }
    }

    /// The direction of the Sun in F_t at the attitude `q_es`.
    fn sun_t(&self, q_es: [f64; 4]) -> [f64; 3] {
        transposed_product(self.c_st, transposed_product(dcm_from_quaternion(q_es), self.sun_e))
    }
}

/// The two angles of the direction `u` in F_t, rad.
fn angles([x, y, z]: [f64; 3]) -> [f64; 2] {
    [libm::atan2(x, z), libm::atan2(y, z)]
}

impl AttitudeSensor for Geometry {
    /// The innovation is across the measured direction m: e_i = -b_i . u for two unit vectors b across m, where u is the direction as estimated. With
    /// u' = u x d for a small error d of the attitude, b . (u x d) = (b x u) . d; the noise of the angles moves m by b_i . dm/d(angle). Unlike the difference
    /// of the angles it has no pole where the estimate has the Sun beside the sensor.
    fn innovation(&self, values: &Values, q_es: [f64; 4]) -> AttitudeInnovation {
        let sun_t = self.sun_t(q_es);
        let tangents = part::<2>(values, 0).map(libm::tan);
        let seen = [tangents[0], tangents[1], 1.0];
        let length = norm(seen);
        let [across, other, _] = transposed(&from_s3_to(seen));
        let across = [across, other];
        let slopes: [[f64; 2]; 2] =
            across.map(|b| std::array::from_fn(|i| b[i] * (1.0 + tangents[i] * tangents[i]) / length));
        let variance = self.deviation * self.deviation;
        AttitudeInnovation::Two(Innovation {
            value: across.map(|b| -dot(b, sun_t)),
            sensitivity: across.map(|b| product(self.c_st, cross(b, sun_t))),
            covariance: multiplied(&slopes, &transposed(&slopes)).map(|row: [f64; 2]| row.map(|x| variance * x)),
        })
    }
}

struct SunSensor {
    geometry: Geometry,
    /// Cosine of the largest angle from the boresight.
    least_cosine: f64,
    bias: f64,
    noise: NormalErrors<2>,
}

impl SunSensor {
    fn new(context: &SensorContext<'_>) -> Self {
        let numbers = SunSensorNumbers::of(context.parameters);
        let half = numbers.half_field_of_view;
        SunSensor {
            geometry: Geometry::of(context.parameters),
            least_cosine: if half > 0.0 { libm::cos(half).max(0.0) } else { 0.0 },
            bias: numbers.bias,
            noise: context.normal("noise", ["x", "y"]),
        }
    }
}

impl Sensor for SunSensor {
    fn measure(&mut self, count: u64, truth: &Truth) -> Option<Values> {
        let sun_t = self.geometry.sun_t(truth.body.q_es);
        if sun_t[2] <= self.least_cosine {
            return None;
        }
        let errors = self.noise.scaled(count, [self.geometry.deviation; 2]);
        let [a, b] = angles(sun_t);
        Some(values(&[&[a + self.bias + errors[0], b + self.bias + errors[1]]]))
    }
}

#[cfg(test)]
mod tests {
    use super::super::bench::{assert_normal, sensor, table, truth};
    use super::*;
    use crate::control::estimators::attitude_filter::{AttitudeFilter, AttitudeObservation};
    use crate::control::estimators::delayed::Filter;
    use crate::control::rotation::{quaternion_of, vector_of};
    use crate::control::sensors::rate_gyro::GyroNoise;
    use crate::control::vector::{conjugate, difference, hamilton};

    const SUN: [f64; 3] = [0.6, 0.0, -0.8];
    const BORESIGHT: [f64; 3] = [2.0, 1.0, -2.0];

    /// Law: the tangents of the angles and one are the direction of the Sun, whatever the attitude; the Sun is seen within the field of view and nowhere else.
    #[test]
    fn the_angles_are_those_of_the_sun() {
        let values: [(&str, &[f64]); 3] =
            [("boresight", &BORESIGHT), ("sun_direction", &[3.0, 0.0, -4.0]), ("half_field_of_view_rad", &[1.0])];
        let mut tried = [0; 2];
        for turn in [[0.0; 3], [0.3, -0.2, 0.5], [0.0, 0.9, 0.0], [0.0, -0.7, 0.1], [0.0, 2.0, 0.0], [0.0, 0.0, 3.1]] {
            let q = quaternion_of(turn);
            let sun_s = transposed_product(dcm_from_quaternion(q), SUN);
            let axis = scaled(1.0 / 3.0, BORESIGHT);
            let angle = libm::atan2(norm(cross(axis, sun_s)), dot(axis, sun_s));
            let seen = sensor("sun_sensor", &values, 1.0, 0).measure(0, &truth(0.0, q, [0.0; 3]));
            assert_eq!(seen.is_some(), angle < 1.0, "{turn:?}: {angle}");
            tried[usize::from(seen.is_some())] += 1;
            let Some(seen) = seen else { continue };
            let [a, b] = part::<2>(&seen, 0);
            let u = [libm::tan(a), libm::tan(b), 1.0];
            let found = product(from_s3_to(BORESIGHT), scaled(1.0 / norm(u), u));
            assert!(norm(difference(found, sun_s)) < 4e-15, "{found:?} for {sun_s:?}");
        }
        assert!(tried[0] > 1 && tried[1] > 2, "{tried:?}");
    }

    /// Law: both angles have noise of their own with its deviation, about the bias: 4,000 samples, alpha 1e-3 each, seed 5.
    #[test]
    fn each_angle_has_noise() {
        let values: [(&str, &[f64]); 3] =
            [("noise_rad", &[2e-3]), ("sun_direction", &[0.2, -0.1, 1.0]), ("bias_rad", &[0.01])];
        let mut noisy = sensor("sun_sensor", &values, 1.0, 3);
        let mut errors = [Vec::new(), Vec::new()];
        for count in 0..4_000 {
            let seen = noisy.measure(count, &truth(0.0, [1.0, 0.0, 0.0, 0.0], [0.0; 3])).expect("the Sun");
            errors[0].push(seen[0] - libm::atan(0.2) - 0.01);
            errors[1].push(seen[1] - libm::atan(-0.1) - 0.01);
        }
        errors.iter().for_each(|errors| assert_normal(errors, 2e-3, 1e-3));
        let both: Vec<f64> = errors[0].iter().zip(&errors[1]).map(|(a, b)| a + b).collect();
        assert_normal(&both, 2e-3 * std::f64::consts::SQRT_2, 1e-3);
    }

    /// Law: the innovation of an attitude that is wrong by a small rotation d is H d, to second order.
    #[test]
    fn the_sensitivity_is_the_derivative() {
        let values: [(&str, &[f64]); 2] = [("boresight", &BORESIGHT), ("sun_direction", &SUN)];
        let geometry = Geometry::of(&table("unit", &PARAMETERS, &values));
        let q = quaternion_of([0.2, -0.3, 0.1]);
        let size = 1e-6;
        for axis in 0..3 {
            let mut d = [0.0; 3];
            d[axis] = size;
            let q_true = hamilton(q, quaternion_of(d));
            let seen =
                sensor("sun_sensor", &values, 1.0, 0).measure(0, &truth(0.0, q_true, [0.0; 3])).expect("the Sun");
            let AttitudeInnovation::Two(found) = geometry.innovation(&seen, q) else { panic!("two angles") };
            for (value, row) in found.value.iter().zip(found.sensitivity) {
                assert!((value / size - row[axis]).abs() < 1e-5, "{axis}: {value} for {row:?}");
            }
        }
    }

    /// Law: an update adds its information, P^-1 + H^T R^-1 H: at the boresight across the direction of the Sun the variance after n angles of deviation s is that
    /// of n + 1 numbers, 1/(1/p + n/s^2), and about it nothing is learned. Errors of 2,000 filters that start with the variance p have this spread (alpha 1e-3).
    #[test]
    fn errors_fall_as_information_adds() {
        const START: f64 = 0.01;
        const NOISE: f64 = 5e-3;
        let values: [(&str, &[f64]); 2] = [("noise_rad", &[NOISE]), ("sun_direction", &[0.0, 0.0, 1.0])];
        let noise = GyroNoise { angular_random_walk: 0.0, bias_random_walk: 0.0 };
        let model: Arc<dyn AttitudeSensor> = Arc::new(Geometry::of(&table("unit", &PARAMETERS, &values)));
        let expected = (1.0 / (START * START) + 4.0 / (NOISE * NOISE)).sqrt().recip();
        let mut errors = [Vec::new(), Vec::new(), Vec::new()];
        for run in 1..=2_000 {
            let mut draws = SensorContext {
                parameters: &table("start", &PARAMETERS, &[]),
                drawn: &crate::scene::Scene::resolve(&crate::scene::SceneInput::report()).expect("a scene"),
                period: 1.0,
                sample: crate::sampling::SampleId(run),
                seed: 9,
            }
            .normal("start", ["x", "y", "z"]);
            let q = quaternion_of(draws.scaled(0, [START; 3]));
            let mut filter = AttitudeFilter::new([1.0, 0.0, 0.0, 0.0], START, 1e-9, noise);
            let mut sun = sensor("sun_sensor", &values, 1.0, run);
            for count in 0..4 {
                let seen = sun.measure(count, &truth(0.0, q, [0.0; 3])).expect("the Sun");
                filter.update(&AttitudeObservation { values: seen, sensor: model.clone() }).expect("an innovation");
            }
            for (axis, known) in [expected, expected, START].into_iter().enumerate() {
                let deviation = filter.covariance[axis][axis].sqrt();
                // the direction is that of the estimate, which is wrong by up to four START
                assert!((deviation / known - 1.0).abs() < 2e-2, "{axis}: {deviation} for {known}");
                errors[axis].push(vector_of(hamilton(conjugate(filter.q_es), q))[axis]);
            }
        }
        assert_normal(&errors[0], expected, 1e-3);
        assert_normal(&errors[1], expected, 1e-3);
        assert_normal(&errors[2], START, 1e-3);
    }
}
