//! A horizon sensor: nadir in the sensor's axes as [two angles](super::two_angles), if in view. Filters compare it with
//! nadir of the nominal orbit.

use std::sync::Arc;

use super::sensor::{SensorMaker, optional};
use super::two_angles::{BIAS, BORESIGHT, Direction, DirectionSensor, NOISE, TwoAngles};
use crate::dynamics::orbit_path::OrbitPath;
use crate::loops::declared::declared;
use crate::loops::kinds::{Components, MeasuredQuantity, Need, SensorKind};
use crate::loops::observes::Observes;

pub(super) const KIND: SensorMaker = SensorMaker {
    kind: SensorKind {
        name: "horizon_sensor",
        parameters: &PARAMETERS,
        quantities: &[MeasuredQuantity::new(
            "measured_nadir_angle",
            Components::Named(&["x", "y"]),
            ["rad", "rad"],
            "Angle of nadir from the boresight of a horizon sensor, in the plane of this axis and the boresight",
        )],
        observes: Observes::Direction(|table, nominal| {
            Arc::new(HorizonSensorNumbers::of(table).angles(nominal.orbit.as_ref().map(OrbitPath::new)))
        }),
        needs: Some(Need {
            is_met: |scene| scene.orbit.is_some(),
            refusal: ["another kind without an [orbit]", "add an [orbit] table, or delete this one"],
        }),
        replaced_by_epoch: None,
    },
    make: |context| {
        let numbers = HorizonSensorNumbers::of(context.parameters);
        let limits = [numbers.half_field_of_view, numbers.bias];
        Box::new(DirectionSensor::new(context, numbers.angles(None), limits))
    },
};

declared! {
    HorizonSensorNumbers = PARAMETERS {
        noise: f64 = NOISE;
        boresight: [f64; 3] = BORESIGHT;
        half_field_of_view: f64 = optional("half_field_of_view_rad", "rad",
            "Angle from the boresight beyond which it does not find nadir; 0: it covers everything in front of it");
        bias: f64 = BIAS;
    }
}

impl HorizonSensorNumbers {
    fn angles(&self, orbit: Option<OrbitPath>) -> TwoAngles {
        TwoAngles::new(self.boresight, self.noise, Direction::Nadir(orbit))
    }
}
