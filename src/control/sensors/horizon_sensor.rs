//! A horizon sensor: nadir in the sensor's axes as [two angles](super::two_angles), if in view. Filters compare it with
//! nadir of the nominal orbit.

use std::sync::Arc;

use super::sensor::{Components, MeasuredQuantity, Need, SensorKind, axes, optional};
use super::two_angles::{Believed, Direction, DirectionSensor, TwoAngles};
use crate::control::declared::declared;
use crate::control::observes::Observes;
use crate::control::truth::Truth;
use crate::control::vector::{norm, scaled};
use crate::dynamics::orbit_path::OrbitPath;
use crate::scene::LawParameter;
use crate::scene::schema::Limit;

pub(super) const KIND: SensorKind = SensorKind {
    name: "horizon_sensor",
    parameters: &PARAMETERS,
    quantities: &[MeasuredQuantity::new(
        "measured_nadir_angle",
        Components::Named(&["x", "y"]),
        ["rad", "rad"],
        "Angle of nadir from the boresight of a horizon sensor, in the plane of this axis and the boresight",
    )],
    observes: Observes::Direction(|table, nominal| {
        let nadir = Nadir(nominal.orbit.as_ref().map(OrbitPath::new));
        Arc::new(Believed(HorizonSensorNumbers::of(table).angles(), nadir))
    }),
    needs: Some(Need::Orbit),
    replaced_by_epoch: None,
    make: |context| {
        let numbers = HorizonSensorNumbers::of(context.parameters);
        let limits = [numbers.half_field_of_view, numbers.bias];
        Box::new(DirectionSensor::new(context, Believed(numbers.angles(), Nadir(None)), limits))
    },
};

declared! {
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

impl HorizonSensorNumbers {
    fn angles(&self) -> TwoAngles {
        TwoAngles::new(self.boresight, self.noise)
    }
}

/// Nadir; filters expect that of the nominal orbit.
#[derive(Debug)]
struct Nadir(Option<OrbitPath>);

/// Unit vector of nadir at the position `r_e`, F_e.
fn nadir(r_e: [f64; 3]) -> [f64; 3] {
    scaled(-1.0 / norm(r_e), r_e)
}

impl Direction for Nadir {
    fn expected(&self, time: f64) -> [f64; 3] {
        self.0.as_ref().map_or([0.0; 3], |orbit| nadir(orbit.state(time).position))
    }

    fn actual(&self, truth: &Truth) -> Option<[f64; 3]> {
        Some(nadir(truth.body.r_co_e))
    }
}
