//! [`RelativeOrbit`]: a free body near a point on an orbit, at any time. The offset itself is integrated by its Taylor
//! series ([`super::offset_series`]) in steps that depend on the run alone, so that a time always gives the same bits.

use super::gravity::Gravity;
use super::offset_series::OffsetSeries;
use super::orbit_path::{OrbitPath, end_of_step, state_within, step_length};
use super::orbit_state::OrbitState;
use crate::math::vector::{dot, norm, scaled};
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

    /// The state on the orbit at `time`, s, and the offset there.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::vector::difference;
    use crate::scene::Orbit;

    const MU: f64 = 3.986004418e14;

    fn ellipse() -> OrbitPath {
        OrbitPath::new(&Orbit {
            mu: MU,
            position: [7e6, 1e6, -2e5],
            velocity: [100.0, 7100.0, 2900.0],
            body_radius: 0.0,
            j2: None,
            epoch: None,
        })
    }

    const OFFSET: Offset = Offset { position: [-28.0, -14.0, 18.0], velocity: [0.05, 0.02, -0.03] };

    /// An orbit of equal energy, to rounding of these numbers.
    const CLOSED: Offset = Offset { position: [-28.0, -14.0, 18.0], velocity: [0.05030686, 0.04178697, -0.0211011] };

    /// Truth: the difference of two Kepler orbits by the formulas of [`super::super::orbit`] in 60 digits (mpmath),
    /// Kepler's equation by Newton's method. Bound: a nanometre after a day, or 1e-12 of an offset that has grown to
    /// kilometres.
    #[test]
    fn the_offset_is_the_difference_of_two_orbits() {
        #[rustfmt::skip]
        const TRUTH: [(Offset, f64, [f64; 3], [f64; 3]); 6] = [
            (OFFSET, 600.0, [-5.746590874663875, -3.4844315790967, -2.597588283981717],
                [0.030273367560720337, 0.014334995716407934, -0.036928961400195484]),
            (OFFSET, 6000.0, [132.9613321292154, 426.654900677712, 194.1893606561225],
                [-0.4551594444236615, 0.12543823472615617, 0.06795334110797918]),
            (OFFSET, 86400.0, [3651.152191414383, -4834.862017922093, -2307.783726960503],
                [6.067728554536708, 2.814884791499168, 0.6681533529707963]),
            (CLOSED, 600.0, [-4.6393348504808065, 9.281695620213329, 2.535966840742298],
                [0.03565986506188148, 0.03560489761088071, -0.028684307895607462]),
            (CLOSED, 6000.0, [-49.68176612223033, -26.876127002087927, 24.297035324176555],
                [0.08146573876276852, 0.031143314750731645, -0.017412930589289655]),
            (CLOSED, 86400.0, [-104.70176879871892, 173.508212890231, 71.11705274643319],
                [-0.1427548583800691, -0.09505743751154175, 0.016919563050400543]),
        ];
        for (start, time, position, velocity) in TRUTH {
            let (_, found) = RelativeOrbit::new(&ellipse(), start).at(time);
            let off = norm(difference(found.position, position));
            let speed = norm(difference(found.velocity, velocity));
            let allowed = 1e-9_f64.max(1e-12 * norm(position));
            assert!(off < allowed && speed < 2e-3 * allowed, "{time}: {off:e} m, {speed:e} m/s");
        }
    }
}
