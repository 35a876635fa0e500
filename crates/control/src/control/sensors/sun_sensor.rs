//! A two-axis Sun sensor: the Sun in the sensor's axes as [two angles](super::two_angles), if in view.
//!
//! On an orbit with an epoch the Sun is that of the date, out of view while the Earth covers more than half of its disc
//! (`environment.shadow`). Otherwise its direction is fixed and never covered.

use std::sync::Arc;

use super::sensor::{SensorMaker, axes, optional};
use super::two_angles::{BIAS, BORESIGHT, Direction, DirectionSensor, NOISE, TwoAngles};
use crate::loops::declared::declared;
use crate::loops::kinds::{Components, MeasuredQuantity, SensorKind};
use crate::loops::observes::Observes;
use crate::loops::vector::{norm, scaled};
use crate::scene::schema::Limit;
use crate::scene::{Orbit, Scene};

pub(super) const KIND: SensorMaker = SensorMaker {
    kind: SensorKind {
        name: "sun_sensor",
        parameters: &PARAMETERS,
        quantities: &[MeasuredQuantity::new(
            "measured_sun_angle",
            Components::Named(&["x", "y"]),
            ["rad", "rad"],
            "Angle of the Sun from the boresight of a Sun sensor, in the plane of this axis and the boresight",
        )],
        observes: Observes::Direction(|table, nominal| Arc::new(SunSensorNumbers::of(table).angles(nominal))),
        needs: None,
        replaced_by_epoch: Some("sun_direction"),
    },
    make: |context| {
        let numbers = SunSensorNumbers::of(context.parameters);
        let limits = [numbers.half_field_of_view, numbers.bias];
        Box::new(DirectionSensor::new(context, numbers.angles(context.drawn), limits))
    },
};

declared! {
    SunSensorNumbers = PARAMETERS {
        noise: f64 = NOISE;
        boresight: [f64; 3] = BORESIGHT;
        sun_direction: [f64; 3] = axes("sun_direction", "1",
            "Direction of the Sun in F_e; left out with orbit.epoch, whose date gives the direction",
            Limit::Direction).or(&[1.0, 0.0, 0.0]);
        half_field_of_view: f64 = optional("half_field_of_view_rad", "rad",
            "Angle from the boresight beyond which it sees nothing; 0: it covers everything in front of it");
        bias: f64 = BIAS;
    }
}

impl SunSensorNumbers {
    fn angles(&self, scene: &Scene) -> TwoAngles {
        let of_date = |orbit: &Orbit| Some(Direction::Sun(orbit.epoch?, orbit.body_radius, scene.environment.shadow));
        let fixed = scaled(1.0 / norm(self.sun_direction), self.sun_direction);
        let direction = scene.orbit.as_ref().and_then(of_date).unwrap_or(Direction::Fixed(fixed));
        TwoAngles::new(self.boresight, self.noise, direction)
    }
}
