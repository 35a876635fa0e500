//! A two-axis Sun sensor: the direction of the Sun in the axes of the sensor, as [two angles](super::two_angles);
//! nothing where the Sun is out of view.
//!
//! On an orbit with an epoch the Sun is that of the date, and the sensor sees nothing while the Earth covers more than
//! half of its disc: the shadow is that of `environment.shadow`. Elsewhere the Sun is in a fixed direction, and nothing
//! covers it.

use std::sync::Arc;

use super::two_angles::{AnglesInView, TwoAngles};
use crate::control::declared::declared;
use crate::control::estimators::attitude_innovation::{AttitudeInnovation, AttitudeSensor};
use crate::control::measurement::Values;
use crate::control::observes::Observes;
use crate::control::sensors::sensor::{
    Components, MeasuredQuantity, Sensor, SensorContext, SensorKind, axes, optional,
};
use crate::control::truth::Truth;
use crate::control::vector::{norm, scaled};
use crate::dynamics::environment::shadow::lit;
use crate::dynamics::environment::sun::sun_after;
use crate::scene::schema::Limit;
use crate::scene::{DeclaredTable, Epoch, LawParameter, Orbit, Scene, Shadow};

/// The share of the disc of the Sun that a sensor needs to see: its centre is then in sight.
const LEAST_LIT: f64 = 0.5;

pub(super) const KIND: SensorKind = SensorKind {
    name: "sun_sensor",
    parameters: &PARAMETERS,
    quantities: &[MeasuredQuantity::new(
        "measured_sun_angle",
        Components::Named(&["x", "y"]),
        ["rad", "rad"],
        "Angle of the Sun from the boresight of a Sun sensor, in the plane of this axis and the boresight",
    )],
    observes: Observes::Direction(|table, nominal| Arc::new(Geometry::of(table, nominal))),
    needs: None,
    replaced_by_epoch: Some("sun_direction"),
    make: |context| Box::new(SunSensor::new(context)),
};

declared! {
    /// Its numbers in campaign files.
    SunSensorNumbers = PARAMETERS {
    noise: f64 = optional("noise_rad", "rad", "Standard deviation of each angle");
    boresight: [f64; 3] = axes("boresight", "1", "Direction of the boresight in F_s", Limit::Direction).or(&[0.0,
        0.0, 1.0]);
    sun_direction: [f64; 3] = axes(
        "sun_direction",
        "1",
        "Direction of the Sun in F_e; left out with orbit.epoch, whose date gives the direction",
        Limit::Direction,
    )
    .or(&[1.0, 0.0, 0.0]);
    half_field_of_view: f64 = optional(
        "half_field_of_view_rad",
        "rad",
        "Angle from the boresight beyond which it sees nothing; 0: it covers everything in front of it",
    );
    bias: f64 = LawParameter::number("bias_rad", "rad", "Constant error of both angles", Limit::Finite).or(&[0.0]);
    }
}

/// Where a sensor and the Sun are, and how exactly it measures.
#[derive(Clone, Copy, Debug)]
struct Geometry {
    angles: TwoAngles,
    sun: Light,
}

/// Where the Sun is.
#[derive(Clone, Copy, Debug)]
enum Light {
    /// Along this unit vector in F_e.
    Fixed([f64; 3]),
    /// At its place of the date; the radius of the Earth, m, and the shape of its shadow.
    OfDate(Epoch, f64, Shadow),
}

impl Geometry {
    fn of(table: &DeclaredTable, scene: &Scene) -> Self {
        let numbers = SunSensorNumbers::of(table);
        let given = numbers.sun_direction;
        let of_date = |orbit: &Orbit| Some(Light::OfDate(orbit.epoch?, orbit.body_radius, scene.environment.shadow));
        Geometry {
            angles: TwoAngles::new(numbers.boresight, numbers.noise),
            sun: scene.orbit.as_ref().and_then(of_date).unwrap_or(Light::Fixed(scaled(1.0 / norm(given), given))),
        }
    }
}

impl Light {
    /// The unit vector to the Sun at `time`, s, in F_e.
    fn direction(&self, time: f64) -> [f64; 3] {
        match *self {
            Light::Fixed(direction) => direction,
            Light::OfDate(epoch, ..) => sun_after(epoch, time).direction,
        }
    }

    /// Whether it reaches `position` (F_e, m) at `time`, s.
    fn reaches(&self, position: [f64; 3], time: f64) -> bool {
        match *self {
            Light::Fixed(_) => true,
            Light::OfDate(epoch, radius, shadow) => lit(shadow, position, &sun_after(epoch, time), radius) >= LEAST_LIT,
        }
    }
}

impl AttitudeSensor for Geometry {
    fn innovation(&self, values: &Values, q_es: [f64; 4], time: f64) -> AttitudeInnovation {
        self.angles.innovation(values, self.angles.in_sensor(self.sun.direction(time), q_es))
    }
}

struct SunSensor {
    angles: AnglesInView,
    sun: Light,
}

impl SunSensor {
    fn new(context: &SensorContext<'_>) -> Self {
        let numbers = SunSensorNumbers::of(context.parameters);
        let Geometry { angles, sun } = Geometry::of(context.parameters, context.drawn);
        SunSensor { angles: AnglesInView::new(context, angles, numbers.half_field_of_view, numbers.bias), sun }
    }
}

impl Sensor for SunSensor {
    fn measure(&mut self, count: u64, truth: &Truth) -> Option<Values> {
        let is_lit = self.sun.reaches(truth.body.r_co_e, truth.time);
        let seen = || self.angles.measure(count, self.sun.direction(truth.time), truth.body.q_es);
        is_lit.then(seen).flatten()
    }
}

#[cfg(test)]
mod tests {
    use super::super::bench::{assert_normal, on_orbit, sensor_in, table, truth};
    use super::*;
    use crate::control::estimators::attitude_filter::{AttitudeFilter, AttitudeObservation};
    use crate::control::estimators::delayed::Filter;
    use crate::control::measurement::part;
    use crate::control::observes::GyroNoise;
    use crate::control::rotation::{from_s3_to, quaternion_of, vector_of};
    use crate::control::small_matrix::{multiplied, transposed};
    use crate::control::vector::{
        conjugate, cross, dcm_from_quaternion, difference, dot, hamilton, product, transposed_product,
    };
    use crate::math::vector::quaternion_from_dcm;
    use crate::scene::SceneInput;

    const SUN: [f64; 3] = [0.6, 0.0, -0.8];
    const BORESIGHT: [f64; 3] = [2.0, 1.0, -2.0];

    /// A scene without an orbit: the Sun is where the key has it.
    fn plain() -> Scene {
        Scene::resolve(&SceneInput::report()).expect("a valid scene")
    }

    /// Law: on an orbit with an epoch the sensor sees the Sun of the date and nothing in the shadow of the Earth, of
    /// both shapes, and filters expect it there, whatever the key has. 2026-11-24T00:00:00Z is day 9823.5 of J2000; the
    /// Sun is by the Almanac's formula, written here a second time.
    #[test]
    fn on_a_dated_orbit_it_sees_the_sun_of_the_date() {
        let sun_e = |time: f64| {
            let n = 9823.5 + time / 86_400.0;
            let [l, g] = [280.460 + 0.985_647_4 * n, 357.528 + 0.985_600_3 * n].map(f64::to_radians);
            let longitude = l + (1.915 * g.sin() + 0.020 * (2.0 * g).sin()).to_radians();
            let tilt = (23.439 - 4e-7 * n).to_radians();
            [longitude.cos(), tilt.cos() * longitude.sin(), tilt.sin() * longitude.sin()]
        };
        let values: [(&str, &[f64]); 1] = [("boresight", &BORESIGHT)];
        for shadow in Shadow::ALL {
            let mut scene = on_orbit();
            scene.environment.shadow = shadow;
            for time in [0.0, 40_000.0] {
                let sun = sun_e(time);
                let across = cross(sun, [0.0, 0.0, 1.0]).map(|x| x / norm(cross(sun, [0.0, 0.0, 1.0])));
                // the boresight is near the Sun
                let c_es = from_s3_to(sun);
                let turned = multiplied(&c_es, &transposed(&from_s3_to(BORESIGHT)));
                let q = hamilton(quaternion_from_dcm(turned), quaternion_of([0.1, 0.2, -0.1]));
                // on the day side, behind the Earth, and beside its shadow: its radius is 6378 km
                for (along, beside, is_seen) in
                    [(7e6, 0.0, true), (-7e6, 0.0, false), (-7e6, 6.2e6, false), (-7e6, 6.6e6, true), (0.0, 7e6, true)]
                {
                    let mut at = truth(time, q, [0.0; 3]);
                    at.body.r_co_e = std::array::from_fn(|i| along * sun[i] + beside * across[i]);
                    let seen = sensor_in(&scene, "sun_sensor", &values, 1.0, 0).measure(0, &at);
                    assert_eq!(seen.is_some(), is_seen, "{shadow:?} {along} {beside}");
                    let Some(seen) = seen else { continue };
                    let [a, b] = part::<2>(&seen, 0);
                    let u = [libm::tan(a), libm::tan(b), 1.0];
                    let found = product(from_s3_to(BORESIGHT), scaled(1.0 / norm(u), u));
                    let sun_s = transposed_product(dcm_from_quaternion(q), sun);
                    // two orders of the same sums of 1e4 deg: an ulp of these is 3e-14 rad
                    assert!(norm(difference(found, sun_s)) < 1e-12, "{found:?} for {sun_s:?}");
                    let geometry = Geometry::of(&table("unit", &PARAMETERS, &values), &scene);
                    let AttitudeInnovation::Two(right) = geometry.innovation(&seen, q, time) else { panic!("two") };
                    assert!(right.value.iter().all(|error| error.abs() < 1e-14), "{right:?}");
                    // a day later the Sun is a degree on
                    let AttitudeInnovation::Two(late) = geometry.innovation(&seen, q, time + 86_400.0) else {
                        panic!("two")
                    };
                    assert!(late.value.iter().any(|error| error.abs() > 5e-3), "{late:?}");
                }
            }
        }
    }

    /// Law: the tangents of the angles and one are the direction of the Sun, whatever the attitude; the Sun is seen
    /// within the field of view and nowhere else.
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
            let seen = sensor_in(&plain(), "sun_sensor", &values, 1.0, 0).measure(0, &truth(0.0, q, [0.0; 3]));
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

    /// Law: both angles have noise of their own with its deviation, about the bias: 4,000 samples, alpha 1e-3 each,
    /// seed 5.
    #[test]
    fn each_angle_has_noise() {
        let values: [(&str, &[f64]); 3] =
            [("noise_rad", &[2e-3]), ("sun_direction", &[0.2, -0.1, 1.0]), ("bias_rad", &[0.01])];
        let mut noisy = sensor_in(&plain(), "sun_sensor", &values, 1.0, 3);
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
        let geometry = Geometry::of(&table("unit", &PARAMETERS, &values), &plain());
        let q = quaternion_of([0.2, -0.3, 0.1]);
        let size = 1e-6;
        for axis in 0..3 {
            let mut d = [0.0; 3];
            d[axis] = size;
            let q_true = hamilton(q, quaternion_of(d));
            let seen = sensor_in(&plain(), "sun_sensor", &values, 1.0, 0)
                .measure(0, &truth(0.0, q_true, [0.0; 3]))
                .expect("the Sun");
            let AttitudeInnovation::Two(found) = geometry.innovation(&seen, q, 0.0) else { panic!("two angles") };
            for (value, row) in found.value.iter().zip(found.sensitivity) {
                assert!((value / size - row[axis]).abs() < 1e-5, "{axis}: {value} for {row:?}");
            }
        }
    }

    /// Law: an update adds its information, P^-1 + H^T R^-1 H: at the boresight across the direction of the Sun the
    /// variance after n angles of deviation s is that of n + 1 numbers, 1/(1/p + n/s^2), and about it nothing is
    /// learned. Errors of 2,000 filters that start with the variance p have this spread (alpha 1e-3).
    #[test]
    fn errors_fall_as_information_adds() {
        const START: f64 = 0.01;
        const NOISE: f64 = 5e-3;
        let values: [(&str, &[f64]); 2] = [("noise_rad", &[NOISE]), ("sun_direction", &[0.0, 0.0, 1.0])];
        let noise = GyroNoise { angular_random_walk: 0.0, bias_random_walk: 0.0 };
        let model: Arc<dyn AttitudeSensor> = Arc::new(Geometry::of(&table("unit", &PARAMETERS, &values), &plain()));
        let expected = (1.0 / (START * START) + 4.0 / (NOISE * NOISE)).sqrt().recip();
        let mut errors = [Vec::new(), Vec::new(), Vec::new()];
        let scene = plain();
        for run in 1..=2_000 {
            let mut draws = SensorContext {
                parameters: &table("start", &PARAMETERS, &[]),
                drawn: &scene,
                period: 1.0,
                sample: crate::sampling::SampleId(run),
                seed: 9,
            }
            .normal("start", ["x", "y", "z"]);
            let q = quaternion_of(draws.scaled(0, [START; 3]));
            let mut filter = AttitudeFilter::new([1.0, 0.0, 0.0, 0.0], START, 1e-9, noise);
            let mut sun = sensor_in(&scene, "sun_sensor", &values, 1.0, run);
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
