//! A magnetometer: the Earth's magnetic field in F_s, with noise, bias, errors of scale and misalignment.
//!
//! The field is that of `[environment]` at the true place. That of torque rods and wheels beside it is not in it: a
//! real one is read while rods are off, or has its bias corrected. Filters compare it with the field on the nominal
//! orbit.

use std::sync::Arc;

use crate::control::declared::declared;
use crate::control::estimators::attitude_innovation::{AttitudeInnovation, AttitudeSensor, Innovation};
use crate::control::measurement::{Values, part, values};
use crate::control::observes::Observes;
use crate::control::rotation::{from_s3_to, quaternion_of};
use crate::control::sensors::sensor::{
    AXES, MeasuredQuantity, Need, NormalErrors, Sensor, SensorContext, SensorKind, XYZ, axes,
};
use crate::control::small_matrix::{diagonal, multiplied, transposed};
use crate::control::truth::Truth;
use crate::control::vector::{cross, dcm_from_quaternion, dot, sum, transposed_product};
use crate::dynamics::magnetic_field::MagneticField;
use crate::dynamics::orbit_path::OrbitPath;
use crate::scene::schema::Limit;
use crate::scene::{DeclaredTable, Scene};

pub(super) const KIND: SensorKind = SensorKind {
    name: "magnetometer",
    parameters: &PARAMETERS,
    quantities: &[MeasuredQuantity::new(
        "measured_field_s",
        XYZ,
        ["T", "t"],
        "Magnetic field measured by a magnetometer, in F_s",
    )],
    observes: Observes::Field(|table, nominal| Arc::new(Believed::of(table, nominal))),
    needs: Some(Need::MagneticField),
    replaced_by_epoch: None,
    make: |context| Box::new(Magnetometer::new(context)),
};

declared! {
    /// Its numbers in campaign files.
    MagnetometerNumbers = PARAMETERS {
    noise: [f64; 3] = axes("noise_t", "T", "Standard deviation of each component", Limit::NotNegative);
    bias: [f64; 3] = axes("bias_t", "T", "Constant error of each component", Limit::Finite);
    scale: [f64; 3] = axes("scale", "1", "Ratio of measured to true component along each of its axes",
        Limit::Finite).or(&[1.0; 3]);
    misalignment: [f64; 3] = axes("misalignment_rad", "rad", "Rotation vector from the body to its axes, in F_s",
        Limit::Finite);
    }
}

/// A magnetometer as the filters believe it: in the field on the nominal orbit, without fixed errors.
#[derive(Debug)]
struct Believed {
    /// `None` without a field: nothing is learned.
    field: Option<(OrbitPath, MagneticField<f64>)>,
    noise: [f64; 3],
}

impl Believed {
    fn of(table: &DeclaredTable, nominal: &Scene) -> Self {
        let orbit = nominal.orbit.as_ref().map(OrbitPath::new);
        Believed { field: orbit.zip(MagneticField::of(nominal)), noise: MagnetometerNumbers::of(table).noise }
    }
}

impl AttitudeSensor for Believed {
    /// The innovation is across the measured field m, as that of [`super::two_angles`]: e_i = b_i . (m - B) = -b_i . B
    /// for two unit vectors b across m, where B is the field in F_s as estimated; the length of B says nothing of the
    /// attitude. With B' = B x d for a small error d of the attitude, b . (B x d) = (b x B) . d.
    fn innovation(&self, values: &Values, q_es: [f64; 4], time: f64) -> AttitudeInnovation {
        let field_e = self.field.as_ref().map_or([0.0; 3], |(orbit, field)| field.at(time, orbit.state(time).position));
        let field_s = transposed_product(dcm_from_quaternion(q_es), field_e);
        let [across, other, _] = transposed(&from_s3_to(part(values, 0)));
        let across = [across, other];
        let variances = diagonal(self.noise.map(|sigma| sigma * sigma));
        AttitudeInnovation::Two(Innovation {
            value: across.map(|b| -dot(b, field_s)),
            sensitivity: across.map(|b| cross(b, field_s)),
            covariance: multiplied(&multiplied(&across, &variances), &transposed(&across)),
        })
    }
}

struct Magnetometer {
    field: Option<MagneticField<f64>>,
    numbers: MagnetometerNumbers,
    /// Its axes -> F_s.
    c_sm: [[f64; 3]; 3],
    noise: NormalErrors<3>,
}

impl Magnetometer {
    fn new(context: &SensorContext<'_>) -> Self {
        let numbers = MagnetometerNumbers::of(context.parameters);
        Magnetometer {
            field: MagneticField::of(context.drawn),
            numbers,
            c_sm: dcm_from_quaternion(quaternion_of(numbers.misalignment)),
            noise: context.normal("noise", AXES),
        }
    }
}

impl Sensor for Magnetometer {
    fn measure(&mut self, count: u64, truth: &Truth) -> Option<Values> {
        let field_e = self.field?.at(truth.time, truth.body.r_co_e);
        let field_s = transposed_product(dcm_from_quaternion(truth.body.q_es), field_e);
        let [x, y, z] = transposed_product(self.c_sm, field_s);
        let [along_x, along_y, along_z] = self.numbers.scale;
        let errors = sum(self.numbers.bias, self.noise.scaled(count, self.numbers.noise));
        Some(values(&[&sum([along_x * x, along_y * y, along_z * z], errors)]))
    }
}

#[cfg(test)]
mod tests {
    use super::super::bench::{assert_normal, on_orbit, sensor, table, truth};
    use super::*;
    use crate::control::vector::{difference, hamilton, norm};

    const PLACE: [f64; 3] = [3.1e6, -4.7e6, 4.2e6];
    const TIME: f64 = 40.0;

    fn measured(numbers: &[(&str, &[f64])], sample: u64, count: u64, q: [f64; 4]) -> [f64; 3] {
        let mut truth = truth(TIME, q, [0.0; 3]);
        truth.body.r_co_e = PLACE;
        part(&sensor("magnetometer", numbers, 1.0, sample).measure(count, &truth).expect("a field"), 0)
    }

    /// Law: without errors it is the field at the place and time, turned into the body; each error does what its key
    /// says.
    #[test]
    fn it_measures_the_field() {
        let q = quaternion_of([0.3, -0.2, 0.5]);
        let field_e = MagneticField::of(&on_orbit()).expect("a field").at(TIME, PLACE);
        let true_s: [f64; 3] = transposed_product(dcm_from_quaternion(q), field_e);
        let off = |found: [f64; 3], expected: [f64; 3]| norm(difference(found, expected)) / norm(true_s);
        assert!(off(measured(&[], 0, 0, q), true_s) < 1e-15);
        let biased = measured(&[("bias_t", &[1e-6, 2e-6, -3e-6])], 0, 0, q);
        assert!(off(biased, sum(true_s, [1e-6, 2e-6, -3e-6])) < 1e-15);
        let scaled = measured(&[("scale", &[1.1, 1.0, 0.8])], 0, 0, q);
        assert!(off(scaled, [1.1 * true_s[0], true_s[1], 0.8 * true_s[2]]) < 1e-15);
        // axes turned by a quarter about s3: its first axis is s2
        let turned = measured(&[("misalignment_rad", &[0.0, 0.0, std::f64::consts::FRAC_PI_2])], 0, 0, q);
        assert!(off(turned, [true_s[1], -true_s[0], true_s[2]]) < 1e-15);
    }

    /// Law: each component has noise of its own with its deviation (4,000 samples, alpha 1e-3 each); the nominal run
    /// has none.
    #[test]
    fn each_component_has_noise() {
        let q = [1.0, 0.0, 0.0, 0.0];
        let exact = measured(&[], 0, 0, q);
        let noise: [(&str, &[f64]); 1] = [("noise_t", &[1e-7, 2e-7, 3e-7])];
        assert_eq!(measured(&noise, 0, 7, q), exact);
        let errors: Vec<[f64; 3]> = (0..4_000).map(|count| difference(measured(&noise, 3, count, q), exact)).collect();
        for (axis, deviation) in [1e-7, 2e-7, 3e-7].into_iter().enumerate() {
            assert_normal(&errors.iter().map(|error| error[axis]).collect::<Vec<_>>(), deviation, 1e-3);
        }
    }

    /// Law: the innovation of an attitude that is wrong by a small rotation d is H d, to second order, in the field of
    /// the nominal orbit at the time of the measurement.
    #[test]
    fn the_sensitivity_is_the_derivative() {
        let nominal = on_orbit();
        let believed = Believed::of(&table("unit", &PARAMETERS, &[]), &nominal);
        let place = OrbitPath::new(nominal.orbit.as_ref().expect("an orbit")).state(TIME).position;
        let (q, size) = (quaternion_of([0.3, -0.2, 0.5]), 1e-6);
        for axis in 0..3 {
            let mut d = [0.0; 3];
            d[axis] = size;
            let mut truth = truth(TIME, hamilton(q, quaternion_of(d)), [0.0; 3]);
            truth.body.r_co_e = place;
            let seen = sensor("magnetometer", &[], 1.0, 0).measure(0, &truth).expect("a field");
            let AttitudeInnovation::Two(found) = believed.innovation(&seen, q, TIME) else { panic!("a direction") };
            for (value, row) in found.value.iter().zip(found.sensitivity) {
                assert!((value / size - row[axis]).abs() < 1e-5 * 3e-5, "{axis}: {value} for {row:?}");
            }
        }
    }
}
