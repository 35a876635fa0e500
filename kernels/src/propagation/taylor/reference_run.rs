//! [`Integration`]: one run of a reference solution, whichever method integrates it; [`ReferenceOrbit`]: the orbit
//! beside it.

use super::step::StepRule;
use crate::dynamics::actuation::ActuationLaw;
use crate::dynamics::gravity::Gravity;
use crate::dynamics::gyrostat::{Gyrostat, IMPULSE, IMPULSE_INTEGRAL, THRUST_WORK, WITH_THRUST};
use crate::dynamics::orbit_path::OrbitPath;
use crate::dynamics::orbit_series::OrbitSeries;
use crate::dynamics::orbit_state::OrbitState;
use crate::math::double_double::DoubleDouble;
use crate::math::vector::{difference, norm, scaled, sum};
use crate::run::Grid;
use crate::scene::Scene;

/// A run that takes more steps than this is given up: at some 20 steps a turn, fifty thousand turns.
pub const MOST_STEPS: u64 = 1_000_000;

/// Every component that a gyrostat has: one kernel for all scenes.
pub(super) const N: usize = WITH_THRUST;

/// One run from its start to the end of its grid.
pub(super) struct Integration<'a, 'l> {
    pub(super) run: &'a mut Gyrostat<DoubleDouble>,
    /// The same run in `f64`, for its unit of time: a power of two near the time scale of the motion.
    pub(super) coarse: &'a mut Gyrostat<f64>,
    /// `None` where nothing acts on the body.
    pub(super) scene: Option<&'a Scene>,
    /// `None` where the scene's schedule is flown.
    pub(super) law: Option<&'a mut (dyn ActuationLaw + 'l)>,
    pub(super) grid: &'a Grid,
    pub(super) rule: StepRule,
}

/// The orbit of a run, integrated beside it: no closed form, so that it can judge one.
pub(super) struct ReferenceOrbit {
    pub(super) mass: DoubleDouble,
    pub(super) gravity: Gravity<DoubleDouble>,
    pub(super) start: OrbitState<DoubleDouble>,
    /// Where the spacecraft may leave the orbit: its position and velocity relative to it at time zero, m and m/s.
    pub(super) offset: Option<[[DoubleDouble; 3]; 2]>,
    /// At the start of the step.
    pub(super) place: OrbitState<DoubleDouble>,
    /// The unit of time, s.
    pub(super) unit: DoubleDouble,
}

impl ReferenceOrbit {
    /// `orbit`, on which `run` starts or beside it.
    pub(super) fn new(run: &Gyrostat<DoubleDouble>, orbit: &OrbitPath) -> Self {
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

    /// Starts a step in a unit of time of `unit` seconds: the gravity, and where the spacecraft is.
    pub(super) fn begin(&mut self, unit: f64) -> (Gravity<DoubleDouble>, OrbitState<DoubleDouble>) {
        self.unit = DoubleDouble::exact(unit);
        (self.gravity, self.place)
    }

    /// The state `within` units of time after the start of the step, whose series is `along`, SI.
    pub(super) fn at(&self, along: &OrbitSeries<DoubleDouble>, within: DoubleDouble) -> OrbitState<DoubleDouble> {
        let place = along.at(within);
        OrbitState { velocity: scaled(DoubleDouble::exact(1.0) / self.unit, place.velocity), ..place }
    }

    /// Adds what gravity does to the components at `time`, s, where c is at `place`: its impulse, the integral of that,
    /// and its work.
    pub(super) fn complete(&self, time: f64, place: &OrbitState<DoubleDouble>, values: &mut [DoubleDouble; N]) {
        let (mut start, mut place) = (self.start, *place);
        if let Some(offset) = self.offset {
            let inverse_mass = DoubleDouble::exact(1.0) / self.mass;
            let now = [IMPULSE_INTEGRAL, IMPULSE].map(|first| scaled(inverse_mass, three(values, first)));
            (start, place) = (start.displaced(offset), place.displaced(now));
            // those components are the relative motion, which is in both places now
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

/// Three components from `first` on.
pub(super) fn three(y: &[DoubleDouble; N], first: usize) -> [DoubleDouble; 3] {
    [y[first], y[first + 1], y[first + 2]]
}
