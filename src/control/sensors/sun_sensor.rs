//! A two-axis Sun sensor: the Sun in the sensor's axes as [two angles](super::two_angles), if in view.
//!
//! On an orbit with an epoch the Sun is that of the date, out of view while the Earth covers more than half of its disc
//! (`environment.shadow`). Otherwise its direction is fixed and never covered.

use std::sync::Arc;

use super::sensor::{Components, MeasuredQuantity, SensorKind, axes, optional};
use super::two_angles::{Believed, Direction, DirectionSensor, TwoAngles};
use crate::control::declared::declared;
use crate::control::observes::Observes;
use crate::control::truth::Truth;
use crate::control::vector::{norm, scaled};
use crate::dynamics::environment::shadow::lit;
use crate::dynamics::environment::sun::sun_after;
use crate::scene::schema::Limit;
use crate::scene::{Epoch, LawParameter, Orbit, Scene, Shadow};

/// Visible share of the Sun's disc that a sensor needs: its centre is then in sight.
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
    observes: Observes::Direction(|table, nominal| Arc::new(SunSensorNumbers::of(table).believed(nominal))),
    needs: None,
    replaced_by_epoch: Some("sun_direction"),
    make: |context| {
        let numbers = SunSensorNumbers::of(context.parameters);
        let limits = [numbers.half_field_of_view, numbers.bias];
        Box::new(DirectionSensor::new(context, numbers.believed(context.drawn), limits))
    },
};

declared! {
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

/// Sunlight.
#[derive(Clone, Copy, Debug)]
enum Light {
    /// Along this unit vector in F_e.
    Fixed([f64; 3]),
    /// By the date; radius of the Earth and shape of its shadow.
    OfDate(Epoch, f64, Shadow),
}

impl SunSensorNumbers {
    fn believed(&self, scene: &Scene) -> Believed<Light> {
        let of_date = |orbit: &Orbit| Some(Light::OfDate(orbit.epoch?, orbit.body_radius, scene.environment.shadow));
        let fixed = scaled(1.0 / norm(self.sun_direction), self.sun_direction);
        let light = scene.orbit.as_ref().and_then(of_date).unwrap_or(Light::Fixed(fixed));
        Believed(TwoAngles::new(self.boresight, self.noise), light)
    }
}

impl Direction for Light {
    fn expected(&self, time: f64) -> [f64; 3] {
        match *self {
            Light::Fixed(direction) => direction,
            Light::OfDate(epoch, ..) => sun_after(epoch, time).direction,
        }
    }

    fn actual(&self, truth: &Truth) -> Option<[f64; 3]> {
        let is_lit = match *self {
            Light::Fixed(_) => true,
            Light::OfDate(epoch, radius, shadow) => {
                lit(shadow, truth.body.r_co_e, &sun_after(epoch, truth.time), radius) >= LEAST_LIT
            }
        };
        is_lit.then(|| self.expected(truth.time))
    }
}
