//! [`SampledSensor`]: when a sensor measures and when its measurements are delivered.

use std::collections::VecDeque;

use crate::control::measurement::{Measurement, Values};
use crate::control::sensors::sensor::Sensor;
use crate::control::truth::Truth;

/// A sensor in the loop: it measures every so many ticks, and delivers a measurement a fixed number of ticks later,
/// with its age.
pub struct SampledSensor {
    sensor: Box<dyn Sensor>,
    every: u64,
    latency: u64,
    age: f64,
    /// The tick at which each measurement is delivered.
    waiting: VecDeque<(u64, Values)>,
}

impl SampledSensor {
    /// `sensor`, which measures at the ticks 0, `every`, 2 `every`, ... and delivers `latency` ticks of `tick` seconds
    /// later. `every` is at least one.
    pub fn new(sensor: Box<dyn Sensor>, every: u64, latency: u64, tick: f64) -> Self {
        SampledSensor { sensor, every, latency, age: latency as f64 * tick, waiting: VecDeque::new() }
    }

    /// What is delivered at `tick`, where the state is `truth`, by the sensor at the place `sensor`. Called once for
    /// each tick, in order.
    pub fn deliver(&mut self, sensor: usize, tick: u64, truth: &Truth) -> Option<Measurement> {
        if tick.is_multiple_of(self.every)
            && let Some(measurement) = self.sensor.measure(tick / self.every, truth)
        {
            self.waiting.push_back((tick + self.latency, measurement));
        }
        let (_, values) = self.waiting.pop_front_if(|(due, _)| *due <= tick)?;
        Some(Measurement { sensor, values, age: self.age })
    }

    /// The sensor.
    pub fn sensor(&self) -> &dyn Sensor {
        &*self.sensor
    }
}

#[cfg(test)]
mod tests {
    use super::super::bench::{sensor, truth};
    use super::*;
    use crate::control::measurement::part;
    use crate::control::rotation::{quaternion_of, vector_of};

    /// Law: what is delivered at tick k is the state `latency` ticks before, with that age; nothing before the first,
    /// and nothing of a lost sample.
    #[test]
    fn a_measurement_is_delivered_after_the_latency() {
        let limit: [(&str, &[f64]); 1] = [("max_rate_rad_s", &[0.05])];
        let mut tracker = SampledSensor::new(sensor("star_tracker", &limit, 0.2, 1), 2, 3, 0.1);
        let angle = |tick: u64| 0.01 * tick as f64;
        let mut delivered = Vec::new();
        for tick in 0..12 {
            // too fast for the sample at tick 4
            let rate = if tick == 4 { 0.06 } else { 0.04 };
            let state = truth(0.1 * tick as f64, quaternion_of([angle(tick), 0.0, 0.0]), [rate, 0.0, 0.0]);
            if let Some(Measurement { sensor: 4, values, age }) = tracker.deliver(4, tick, &state) {
                assert_eq!(age, 3.0 * 0.1);
                assert!((vector_of(part(&values, 0))[0] - angle(tick - 3)).abs() < 1e-15);
                delivered.push(tick);
            }
        }
        assert_eq!(delivered, [3, 5, 9, 11]);
    }
}
