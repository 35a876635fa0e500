//! A horizon sensor: the direction of nadir in the axes of the sensor, as [two angles](super::two_angles); nothing
//! where nadir is out of view.
//!
//! Nadir is the direction from the centre of mass to the centre of the central body, which a sensor finds from the
//! horizon about it. Filters compare it with the nadir of the nominal orbit.

use std::sync::Arc;

use super::two_angles::{AnglesInView, TwoAngles};
use crate::control::declared::declared;
use crate::control::estimators::attitude_innovation::{AttitudeInnovation, AttitudeSensor};
use crate::control::measurement::Values;
use crate::control::observes::Observes;
use crate::control::sensors::sensor::{
    Components, MeasuredQuantity, Need, Sensor, SensorContext, SensorKind, axes, optional,
};
use crate::control::truth::Truth;
use crate::control::vector::{norm, scaled};
use crate::dynamics::orbit_path::OrbitPath;
use crate::scene::schema::Limit;
use crate::scene::{DeclaredTable, LawParameter, Scene};

pub(super) const KIND: SensorKind = SensorKind {
    name: "horizon_sensor",
    parameters: &PARAMETERS,
    quantities: &[MeasuredQuantity::new(
        "measured_nadir_angle",
        Components::Named(&["x", "y"]),
        ["rad", "rad"],
        "Angle of nadir from the boresight of a horizon sensor, in the plane of this axis and the boresight",
    )],
    observes: Observes::Direction(|table, nominal| Arc::new(Geometry::of(table, nominal))),
    needs: Some(Need::Orbit),
    replaced_by_epoch: None,
    make: |context| Box::new(HorizonSensor::new(context)),
};

declared! {
    /// Its numbers in campaign files.
    HorizonSensorNumbers = PARAMETERS {
    noise: f64 = optional("noise_rad", "rad", "Standard deviation of each angle");
    boresight: [f64; 3] = axes("boresight", "1", "Direction of the boresight in F_s", Limit::Direction).or(&[0.0,
        0.0, 1.0]);
    half_field_of_view: f64 = optional(
        "half_field_of_view_rad",
        "rad",
        "Angle from the boresight beyond which it does not find nadir; 0: it covers everything in front of it",
    );
    bias: f64 = LawParameter::number("bias_rad", "rad", "Constant error of both angles", Limit::Finite).or(&[0.0]);
    }
}

/// Nadir from the position `r_e`, F_e; of length one.
fn nadir(r_e: [f64; 3]) -> [f64; 3] {
    scaled(-1.0 / norm(r_e), r_e)
}

/// A sensor as the filters believe it: on the nominal orbit.
#[derive(Debug)]
struct Geometry {
    angles: TwoAngles,
    orbit: Option<OrbitPath>,
}

impl Geometry {
    fn of(table: &DeclaredTable, nominal: &Scene) -> Self {
        let numbers = HorizonSensorNumbers::of(table);
        let angles = TwoAngles::new(numbers.boresight, numbers.noise);
        Geometry { angles, orbit: nominal.orbit.as_ref().map(OrbitPath::new) }
    }
}

impl AttitudeSensor for Geometry {
    fn innovation(&self, values: &Values, q_es: [f64; 4], time: f64) -> AttitudeInnovation {
        // without an orbit there is no direction, and nothing is learned
        let nadir_e = self.orbit.as_ref().map_or([0.0; 3], |orbit| nadir(orbit.state(time).position));
        self.angles.innovation(values, self.angles.in_sensor(nadir_e, q_es))
    }
}

struct HorizonSensor(AnglesInView);

impl HorizonSensor {
    fn new(context: &SensorContext<'_>) -> Self {
        let numbers = HorizonSensorNumbers::of(context.parameters);
        let angles = TwoAngles::new(numbers.boresight, numbers.noise);
        HorizonSensor(AnglesInView::new(context, angles, numbers.half_field_of_view, numbers.bias))
    }
}

impl Sensor for HorizonSensor {
    fn measure(&mut self, count: u64, truth: &Truth) -> Option<Values> {
        self.0.measure(count, nadir(truth.body.r_co_e), truth.body.q_es)
    }
}

#[cfg(test)]
mod tests {
    use super::super::bench::{on_orbit, sensor, table, truth};
    use super::*;
    use crate::control::measurement::part;
    use crate::control::rotation::quaternion_of;
    use crate::control::vector::{dcm_from_quaternion, difference, hamilton, product};

    const BORESIGHT: [f64; 3] = [1.0, 2.0, 2.0];

    /// Law: the angles are those of the direction to the centre of the central body, wherever the spacecraft is: about
    /// a boresight along nadir both are zero, and a turn about s2 by a moves nadir by a; nadir behind the sensor is not
    /// seen.
    #[test]
    fn the_angles_are_those_of_nadir() {
        for r_e in [[7e6, 0.0, 0.0], [-3e6, 4e6, 5e6]] {
            let seen = |turn: [f64; 3], boresight: [f64; 3]| {
                let q = quaternion_of(turn);
                let mut at = truth(0.0, q, [0.0; 3]);
                at.body.r_co_e = product(dcm_from_quaternion(q), r_e.map(|x: f64| -x));
                sensor("horizon_sensor", &[("boresight", &boresight)], 1.0, 0)
                    .measure(0, &at)
                    .map(|seen| part(&seen, 0))
            };
            // nadir is r_e in F_s, whatever the turn
            let [a, b]: [f64; 2] = seen([0.3, -0.8, 0.4], r_e).expect("nadir");
            assert!(a.abs() < 4e-15 && b.abs() < 4e-15, "{a} {b}");
            assert!(seen([0.3, -0.8, 0.4], r_e.map(|x| -x)).is_none());
        }
        let mut at = truth(0.0, quaternion_of([0.0, 0.2, 0.0]), [0.0; 3]);
        at.body.r_co_e = [0.0, 0.0, -7e6];
        let [a, b] = part(&sensor("horizon_sensor", &[], 1.0, 0).measure(0, &at).expect("nadir"), 0);
        assert!((a + 0.2_f64).abs() < 1e-15 && f64::abs(b) < 1e-15, "{a} {b}");
    }

    /// Law: the innovation of an attitude that is wrong by a small rotation d is H d, to second order, with the nadir
    /// of the time of the measurement; with that of another time it is not.
    #[test]
    fn the_sensitivity_is_the_derivative() {
        let nominal = on_orbit();
        let geometry = Geometry::of(&table("unit", &PARAMETERS, &[("boresight", &BORESIGHT)]), &nominal);
        let orbit = OrbitPath::new(nominal.orbit.as_ref().expect("an orbit"));
        let (time, size) = (700.0, 1e-6);
        // the boresight is a fifth of a radian from nadir
        let down = nadir(orbit.state(time).position);
        let turned = |from: [f64; 3], to: [f64; 3]| {
            let [a, b] = [from, to].map(crate::control::rotation::from_s3_to);
            crate::math::vector::quaternion_from_dcm(crate::control::small_matrix::multiplied(
                &b,
                &crate::control::small_matrix::transposed(&a),
            ))
        };
        let q = hamilton(turned(BORESIGHT, down), quaternion_of([0.2, 0.0, -0.1]));
        for axis in 0..3 {
            let mut d = [0.0; 3];
            d[axis] = size;
            let mut at = truth(time, hamilton(q, quaternion_of(d)), [0.0; 3]);
            at.body.r_co_e = orbit.state(time).position;
            let seen = sensor("horizon_sensor", &[("boresight", &BORESIGHT)], 1.0, 0).measure(0, &at).expect("nadir");
            let AttitudeInnovation::Two(found) = geometry.innovation(&seen, q, time) else { panic!("two angles") };
            let AttitudeInnovation::Two(late) = geometry.innovation(&seen, q, time + 1.0) else { panic!("two angles") };
            for (value, row) in found.value.iter().zip(found.sensitivity) {
                assert!((value / size - row[axis]).abs() < 1e-5, "{axis}: {value} for {row:?}");
            }
            assert!(
                norm(difference([late.value[0], late.value[1], 0.0], [found.value[0], found.value[1], 0.0])) > 5e-4
            );
        }
    }
}
