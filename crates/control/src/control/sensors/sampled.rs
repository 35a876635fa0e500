//! [`SampledSensor`]: sampling and delivery of a sensor's measurements.

use std::collections::VecDeque;

use super::sensor::Sensor;
use crate::control::truth::Truth;
use crate::loops::measurement::{Measurement, Values};

/// A sensor that measures every `every` ticks and delivers a fixed number of ticks later.
pub struct SampledSensor {
    pub sensor: Box<dyn Sensor>,
    /// Ticks between measurements.
    pub every: u64,
    latency: u64,
    age: f64,
    /// Measurements with the ticks of their delivery.
    waiting: VecDeque<(u64, Values)>,
}

impl SampledSensor {
    /// `sensor` at the ticks 0, `every` >= 1, 2 `every`, ..., delivered `latency` ticks of `tick` seconds later.
    pub fn new(sensor: Box<dyn Sensor>, every: u64, latency: u64, tick: f64) -> Self {
        SampledSensor { sensor, every, latency, age: latency as f64 * tick, waiting: VecDeque::new() }
    }

    /// The measurement that the sensor, at the index `sensor`, delivers at `tick`; call in order, at each
    /// tick at which it measures or delivers.
    pub fn deliver(&mut self, sensor: usize, tick: u64, truth: &Truth) -> Option<Measurement> {
        if tick.is_multiple_of(self.every)
            && let Some(measurement) = self.sensor.measure(tick / self.every, truth)
        {
            self.waiting.push_back((tick + self.latency, measurement));
        }
        let (_, values) = self.waiting.pop_front_if(|(due, _)| *due <= tick)?;
        Some(Measurement { sensor, values, age: self.age })
    }
}
