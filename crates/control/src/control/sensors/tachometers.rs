//! Tachometers of the wheels: their rates relative to the body.

use super::sensor::{NormalErrors, Sensor, SensorMaker, optional};
use crate::control::truth::Truth;
use crate::loops::declared::declared;
use crate::loops::kinds::{Components, MeasuredQuantity, SensorKind};
use crate::loops::measurement::{Values, values};
use crate::loops::observes::Observes;
use crate::scene::schema::Limit;
use crate::scene::{LawParameter, MAX_WHEELS};

pub(super) const KIND: SensorMaker = SensorMaker {
    kind: SensorKind {
        name: "tachometers",
        parameters: &PARAMETERS,
        quantities: &[MeasuredQuantity::new(
            "measured_rate",
            Components::Wheels,
            ["rad/s", "rad_s"],
            "Rate of this wheel measured by its tachometer",
        )],
        observes: Observes::WheelRates,
        needs: None,
        replaced_by_epoch: None,
    },
    make: |context| {
        let names: [String; MAX_WHEELS] = std::array::from_fn(|wheel| (wheel + 1).to_string());
        let TachometerNumbers { noise, scale } = TachometerNumbers::of(context.parameters);
        let mut deviations = [0.0; MAX_WHEELS];
        deviations[..context.drawn.mass.wheels.len()].fill(noise);
        let noise = context.normal("noise", std::array::from_fn(|wheel| names[wheel].as_str()));
        Box::new(Tachometers { deviations, scale, noise })
    },
};

declared! {
    TachometerNumbers = PARAMETERS {
        noise: f64 = optional("noise_rad_s", "rad/s", "Standard deviation of each rate");
        scale: f64 = LawParameter::number("scale", "1", "Ratio of measured to true rate", Limit::Finite).or(&[1.0]);
    }
}

struct Tachometers {
    deviations: [f64; MAX_WHEELS],
    scale: f64,
    noise: NormalErrors<MAX_WHEELS>,
}

impl Sensor for Tachometers {
    fn measure(&mut self, count: u64, truth: &Truth) -> Option<Values> {
        let errors = self.noise.scaled(count, self.deviations);
        let rates: [f64; MAX_WHEELS] =
            std::array::from_fn(|wheel| self.scale * truth.wheel_rates[wheel] + errors[wheel]);
        Some(values(&[&rates]))
    }
}
