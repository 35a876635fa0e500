//! [`FailingSensor`]: a sensor that fails during the run.

use super::sensor::{Sensor, SensorContext, SensorMaker};
use crate::control::tick_times::SAME_TIME;
use crate::control::truth::Truth;
use crate::loops::measurement::Values;
use crate::scene::{DeclaredTable, FailureInput, SensorOutput};

/// From the first sample at or after its failure, the sensor is silent, repeats its last measurement, or measures with
/// another bias and the same noise.
pub struct FailingSensor {
    sensor: Box<dyn Sensor>,
    /// The sensor with its later bias, which measures from the start to share the memory.
    biased: Option<Box<dyn Sensor>>,
    at: f64,
    output: Option<SensorOutput>,
    last: Option<Values>,
    has_failed: bool,
}

impl FailingSensor {
    pub fn new(maker: &SensorMaker, context: &SensorContext<'_>, failure: &FailureInput) -> Self {
        let biased = failure.output.is_none().then(|| {
            let parameters = &biased(context.parameters, failure);
            (maker.make)(&SensorContext { parameters, ..*context })
        });
        FailingSensor {
            sensor: (maker.make)(context),
            biased,
            at: failure.at_s - SAME_TIME * context.period,
            output: failure.output,
            last: None,
            has_failed: false,
        }
    }
}

/// The parameters `healthy` with the bias change of `failure`.
fn biased(healthy: &DeclaredTable, failure: &FailureInput) -> DeclaredTable {
    let mut table = healthy.clone();
    for (key, change) in [("bias_rad_s", failure.bias_rad_s), ("bias_rad", failure.bias_rad)] {
        let place = table.declared.0.iter().position(|parameter| parameter.facts.key == key);
        if let (Some(numbers), Some(change)) = (place.and_then(|place| table.numbers_mut(place)), change) {
            numbers.iter_mut().zip(change).for_each(|(number, change)| *number += change);
        }
    }
    table
}

impl Sensor for FailingSensor {
    fn measure(&mut self, count: u64, truth: &Truth) -> Option<Values> {
        let healthy = self.sensor.measure(count, truth);
        let biased = self.biased.as_mut().and_then(|sensor| sensor.measure(count, truth));
        self.has_failed = truth.time >= self.at;
        if !self.has_failed {
            self.last = healthy.or(self.last);
            return healthy;
        }
        match self.output {
            Some(SensorOutput::Silent) => None,
            Some(SensorOutput::Frozen) => self.last,
            None => biased,
        }
    }

    fn bias_s(&self) -> Option<[f64; 3]> {
        self.biased.as_ref().filter(|_| self.has_failed).unwrap_or(&self.sensor).bias_s()
    }
}
