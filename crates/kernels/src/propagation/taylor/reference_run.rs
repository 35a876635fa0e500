//! [`Integration`]: one run of a reference solution by either method; [`ReferenceOrbit`]: its orbit.

use super::step::StepRule;
use crate::dynamics::actuation::ActuationLaw;
use crate::dynamics::gravity::Gravity;
use crate::dynamics::gyrostat::{Gyrostat, IMPULSE, IMPULSE_INTEGRAL, THRUST_WORK, WITH_THRUST};
use crate::dynamics::orbit_path::OrbitPath;
use crate::dynamics::orbit_series::OrbitSeries;
use crate::dynamics::orbit_state::OrbitState;
use crate::math::double_double::DoubleDouble;
use crate::math::prelude::*;
use crate::run::Grid;
use crate::scene::Scene;

/// Limit of steps: some 20 steps per turn, fifty thousand turns.
pub const MOST_STEPS: u64 = 1_000_000;

/// All components of a gyrostat: one kernel for all scenes.
pub const N: usize = WITH_THRUST;

pub struct Integration<'a, 'l> {
    pub run: &'a mut Gyrostat<DoubleDouble>,
    /// The run in `f64`, for its unit of time: a power of two near the time scale of the motion.
    pub coarse: &'a mut Gyrostat<f64>,
    /// `None` if nothing acts on the body.
    pub scene: Option<&'a Scene>,
    /// `None` for the scene's schedule.
    pub law: Option<&'a mut (dyn ActuationLaw + 'l)>,
    pub grid: &'a Grid,
    pub rule: StepRule,
}

/// The orbit of a run, integrated with it instead of by the closed form that it judges.
pub struct ReferenceOrbit {
    pub mass: DoubleDouble,
    pub gravity: Gravity<DoubleDouble>,
    pub start: OrbitState<DoubleDouble>,
    /// Position and velocity relative to the orbit at time zero, m and m/s, if the spacecraft may leave it.
    pub offset: Option<[[DoubleDouble; 3]; 2]>,
    pub place: OrbitState<DoubleDouble>,
    pub unit: DoubleDouble,
}

impl ReferenceOrbit {
    /// `orbit`, on or near which `run` starts.
    pub fn new(run: &Gyrostat<DoubleDouble>, orbit: &OrbitPath) -> Self {
        let [position, velocity] = orbit.at_start().start().map(|vector| vector.map(DoubleDouble::exact));
        let start = OrbitState { position, velocity, distance: norm(position) };
        ReferenceOrbit {
            mass: run.mass,
            gravity: orbit.gravity().in_lanes(run.mass),
            start,
            offset: run.offset,
            place: start,
            unit: DoubleDouble::exact(1.0),
        }
    }

    /// Starts a step in a unit of time of `unit` seconds: gravity and position.
    pub fn begin(&mut self, unit: f64) -> (Gravity<DoubleDouble>, OrbitState<DoubleDouble>) {
        self.unit = DoubleDouble::exact(unit);
        (self.gravity, self.place)
    }

    /// State `within` units after the start of the step with the series `along`, SI.
    pub fn at(&self, along: &OrbitSeries<DoubleDouble>, within: DoubleDouble) -> OrbitState<DoubleDouble> {
        let place = along.at(within);
        OrbitState { velocity: scaled(DoubleDouble::exact(1.0) / self.unit, place.velocity), ..place }
    }

    /// Adds gravity's impulse, its integral and work to the components at `time`, s, with c at `place`.
    pub fn complete(&self, time: f64, place: &OrbitState<DoubleDouble>, values: &mut [DoubleDouble; N]) {
        let (mut start, mut place) = (self.start, *place);
        if let Some(offset) = self.offset {
            let inverse_mass = DoubleDouble::exact(1.0) / self.mass;
            let now = [IMPULSE_INTEGRAL, IMPULSE].map(|first| scaled(inverse_mass, three(values, first)));
            (start, place) = (start.displaced(offset), place.displaced(now));
            // these components describe the relative motion, which both positions include now
            values[IMPULSE..IMPULSE_INTEGRAL + 3].fill(DoubleDouble::exact(0.0));
        }
        let line = sum(start.position, scaled(DoubleDouble::exact(time), start.velocity));
        let gained = scaled(self.mass, difference(place.velocity, start.velocity));
        let moved = scaled(self.mass, difference(place.position, line));
        for i in 0..3 {
            values[IMPULSE + i] += gained[i];
            values[IMPULSE_INTEGRAL + i] += moved[i];
        }
        values[THRUST_WORK] += self.gravity.work_on(self.mass, &start, &place);
    }
}
