//! [`SensorSpec`]: a sensor of a loop, as a campaign file has it; [`Readings`]: the last measurements of all.

use super::measurement::{Reading, Values};
use super::observes::Observes;
use super::sensors;
use crate::sampling::Written;
use crate::scene::Name;

/// A sensor.
#[derive(Clone, Debug, PartialEq)]
pub struct SensorSpec {
    /// Its name.
    pub name: Name,
    /// Its kind, by its place in the list.
    pub kind: usize,
    /// Time between measurements, s.
    pub period: f64,
    /// Time from a measurement to its delivery, s.
    pub latency: f64,
    /// The keys of its table that are no parameters, as canonical text has them.
    pub written: Written,
}

impl SensorSpec {
    /// The part of the state that it observes.
    pub fn observes(&self) -> Observes {
        sensors::KINDS[self.kind].observes
    }

    /// The number of numbers of a measurement.
    pub fn width(&self) -> usize {
        sensors::KINDS[self.kind].quantities.iter().map(|quantity| quantity.components.width()).sum()
    }

    /// `values` as telemetry has them: rotations over the period of the sensor as their mean rate.
    pub fn telemetry(&self, mut values: Values) -> Values {
        let mut next = 0;
        for quantity in sensors::KINDS[self.kind].quantities {
            let end = next + quantity.components.width();
            if quantity.is_over_period {
                values[next..end].iter_mut().for_each(|value| *value /= self.period);
            }
            next = end;
        }
        values
    }
}

/// The last measurements of the sensors of a loop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Readings<'a> {
    /// The sensors, in the order of the loop.
    pub sensors: &'a [SensorSpec],
    /// By sensor; empty if no law reads them.
    pub last: &'a [Reading],
}

impl<'a> Readings<'a> {
    /// None.
    pub const NONE: Readings<'static> = Readings { sensors: &[], last: &[] };

    /// Each with its sensor.
    pub fn iter(&self) -> impl Iterator<Item = (&'a SensorSpec, &'a Reading)> + use<'a> {
        self.sensors.iter().zip(self.last)
    }
}
