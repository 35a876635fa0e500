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

    /// The measurement that the sensor at the place `sensor` delivers at `tick` in the state `truth`. Called once for
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
