//! [`RelativeOrbit`]: a free body near a point on an orbit, at any time. The offset itself is integrated by its Taylor
//! series (`offset_series`) in steps that depend on the run alone.

use super::gravity::Gravity;
use super::offset_series::OffsetSeries;
use super::orbit_path::{OrbitPath, end_of_step, state_within, step_length};
use super::orbit_state::OrbitState;
use crate::math::prelude::*;
use crate::scene::orbit::Offset;

/// Order of the series, as in [`super::orbit_path`].
const ORDER: usize = 22;

/// Motion of a free body near an orbit.
#[derive(Clone, Debug)]
pub struct RelativeOrbit {
    orbit: OrbitPath,
    start: Offset,
    series: OffsetSeries<f64>,
    /// Coefficients of the offset: F_e, m, in s.
    offset: Vec<[f64; 3]>,
    /// The step: start as a sum of two numbers, and length, s.
    time: [f64; 2],
    length: f64,
    /// Rounding errors of position and velocity at the start of the step.
    low: [[f64; 3]; 2],
}

impl RelativeOrbit {
    /// A body at `start` from the point on `orbit` at time zero.
    pub fn new(orbit: &OrbitPath, start: Offset) -> Self {
        let mut relative = RelativeOrbit {
            orbit: orbit.clone(),
            start,
            series: OffsetSeries::new(0.0, ORDER),
            offset: vec![[0.0; 3]; ORDER + 3],
            time: [0.0; 2],
            length: 0.0,
            low: [[0.0; 3]; 2],
        };
        relative.reset(orbit, start);
        relative
    }

    /// Changes to another body, in the same memory.
    pub fn reset(&mut self, orbit: &OrbitPath, start: Offset) {
        (self.orbit, self.start) = (orbit.clone(), start);
        self.rewind();
    }

    /// The gravity of the central body.
    pub fn gravity(&self) -> Gravity<f64> {
        self.orbit.gravity()
    }

    fn rewind(&mut self) {
        (self.time, self.low) = ([0.0; 2], [[0.0; 3]; 2]);
        self.step_from([self.start.position, self.start.velocity]);
    }

    /// The state on the orbit at `time`, s, and the offset.
    pub fn at(&mut self, time: f64) -> (OrbitState<f64>, Offset) {
        if time < self.time[0] {
            self.rewind();
        }
        let within = |orbit: &Self| (time - orbit.time[0]) - orbit.time[1];
        while within(self) > self.length {
            let state;
            (self.time, state, self.low) = end_of_step(&self.offset, self.low, self.time, self.length);
            self.step_from(state);
        }
        let [position, velocity] = state_within(&self.offset, self.low, within(self));
        (self.orbit.state(time), Offset { position, velocity })
    }

    /// Starts the series at position and velocity of the offset.
    fn step_from(&mut self, [position, velocity]: [[f64; 3]; 2]) {
        let place = self.orbit.state_at(self.time);
        self.series.begin(self.orbit.gravity(), place.position, place.velocity);
        (self.offset[0], self.offset[1]) = (position, velocity);
        for n in 0..=ORDER {
            let tide = self.series.extend(n, self.offset[n]);
            self.offset[n + 2] = scaled(1.0 / ((n + 1) * (n + 2)) as f64, tide);
        }
        self.length = self.step_length(place.distance);
    }

    /// Step that the series of orbit and offset allow, s.
    fn step_length(&self, distance: f64) -> f64 {
        let along = self.series.orbit().position();
        // the offset may pass through zero: its size some minutes later
        let size = norm(self.offset[0]) + dot(self.offset[1], self.offset[1]).sqrt() * (distance / norm(along[1]));
        [ORDER - 1, ORDER].into_iter().fold(f64::INFINITY, |shortest: f64, n| {
            shortest.min(step_length(n, distance, along[n])).min(step_length(n, size, self.offset[n]))
        })
    }
}
