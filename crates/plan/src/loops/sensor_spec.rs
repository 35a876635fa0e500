//! [`SensorSpec`]: a sensor of a loop in a campaign file; [`Readings`]: the last measurements of all sensors.

use super::kinds::SensorKind;
use super::measurement::{Reading, Values};
use crate::sampling::Written;
use crate::scene::Name;

#[derive(Clone, Debug, PartialEq)]
pub struct SensorSpec {
    pub name: Name,
    pub kind: &'static SensorKind,
    /// Index of the kind in the list of makers.
    pub maker: usize,
    /// Time between measurements, s.
    pub period: f64,
    /// Delay from measurement to delivery, s.
    pub latency: f64,
    /// Keys of its table other than parameters, in canonical form.
    pub written: Written,
}

impl SensorSpec {
    /// Number of values in a measurement.
    pub fn width(&self) -> usize {
        self.kind.quantities.iter().map(|quantity| quantity.components.width()).sum()
    }

    /// `values` for telemetry: rotations over the sensor's period become mean rates.
    pub fn telemetry(&self, mut values: Values) -> Values {
        let mut next = 0;
        for quantity in self.kind.quantities {
            let end = next + quantity.components.width();
            if quantity.is_over_period {
                values[next..end].iter_mut().for_each(|value| *value /= self.period);
            }
            next = end;
        }
        values
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Readings<'a> {
    pub sensors: &'a [SensorSpec],
    /// By sensor; empty if no law reads them.
    pub last: &'a [Reading],
}

impl<'a> Readings<'a> {
    pub const NONE: Readings<'static> = Readings { sensors: &[], last: &[] };

    pub fn iter(&self) -> impl Iterator<Item = (&'a SensorSpec, &'a Reading)> + use<'a> {
        self.sensors.iter().zip(self.last)
    }
}
