//! A two-axis Sun sensor: the direction of the Sun in the axes of the sensor, as [two angles](super::two_angles); nothing where the Sun is out of view.

use std::sync::Arc;

use super::two_angles::{AnglesInView, TwoAngles};
use super::{Components, MeasuredQuantity, Sensor, SensorContext, SensorKind, axes, optional};
use crate::control::declared::declared;
use crate::control::estimators::attitude_innovation::AttitudeInnovation;
use crate::control::measurement::{AttitudeSensor, Observes, Values};
use crate::control::truth::Truth;
use crate::control::vector::{norm, scaled};
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
    observes: Observes::Direction(|table, _| Arc::new(Geometry::of(table))),
    needs: None,
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
        "Angle from the boresight beyond which it sees nothing; 0: it covers everything in front of it",
    );
    bias: f64 = optional("bias_rad", "rad", "Constant error of both angles");
    }
}

/// Where a sensor and the Sun are, and how exactly it measures.
#[derive(Clone, Copy, Debug)]
struct Geometry {
    angles: TwoAngles,
    /// Unit vector to the Sun in F_e.
    sun_e: [f64; 3],
}

impl Geometry {
    fn of(table: &DeclaredTable) -> Self {
        let numbers = SunSensorNumbers::of(table);
        let sun = numbers.sun_direction;
        Geometry { angles: TwoAngles::new(numbers.boresight, numbers.noise), sun_e: scaled(1.0 / norm(sun), sun) }
    }
}

impl AttitudeSensor for Geometry {
    fn innovation(&self, values: &Values, q_es: [f64; 4], _time: f64) -> AttitudeInnovation {
        self.angles.innovation(values, self.angles.in_sensor(self.sun_e, q_es))
    }
}

struct SunSensor {
    angles: AnglesInView,
    sun_e: [f64; 3],
}

impl SunSensor {
    fn new(context: &SensorContext<'_>) -> Self {
        let numbers = SunSensorNumbers::of(context.parameters);
        let Geometry { angles, sun_e } = Geometry::of(context.parameters);
        SunSensor { angles: AnglesInView::new(context, angles, numbers.half_field_of_view, numbers.bias), sun_e }
    }
}

impl Sensor for SunSensor {
    fn measure(&mut self, count: u64, truth: &Truth) -> Option<Values> {
        self.angles.measure(count, self.sun_e, truth.body.q_es)
    }
}

#[cfg(test)]
mod tests {
    use super::super::bench::{assert_normal, sensor, table, truth};
    use super::*;
    use crate::control::estimators::attitude_filter::{AttitudeFilter, AttitudeObservation};
    use crate::control::estimators::delayed::Filter;
    use crate::control::measurement::part;
    use crate::control::rotation::{from_s3_to, quaternion_of, vector_of};
    use crate::control::sensors::rate_gyro::GyroNoise;
    use crate::control::vector::{
        conjugate, cross, dcm_from_quaternion, difference, dot, hamilton, product, transposed_product,
    };

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
            let AttitudeInnovation::Two(found) = geometry.innovation(&seen, q, 0.0) else { panic!("two angles") };
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
                filter
                    .update(&AttitudeObservation { values: seen, sensor: model.clone(), time: 0.0 })
                    .expect("an innovation");
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
