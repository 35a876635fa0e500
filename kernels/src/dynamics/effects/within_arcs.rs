//! The effects that change within an arc: none ([`NoEffects`]), or those of a run on an orbit ([`OnOrbit`]).

use super::gravity_gradient::{GradientSeries, GravityGradient};
use crate::dynamics::gyrostat::Gyrostat;
use crate::dynamics::orbit::KeplerOrbit;
use crate::math::Real;

/// The effects that change within an arc, of one run per lane.
pub trait WithinArcs<R: Real>: Copy {
    /// Whether there are any.
    const ACT: bool;

    /// Those of empty lanes; `zero` says how many.
    fn none(zero: R) -> Self;

    /// Puts those of `run` into lane `lane`.
    fn set_lane(&mut self, lane: usize, run: &Gyrostat<f64>);

    /// Their torque at `time` (s) at the attitude `q_eb`, in B, N m.
    fn torque(&self, time: R, q_eb: [R; 4]) -> [R; 3];

    /// Their Taylor series from `time` (s) on, begun in `memory`, in a unit of time of `unit` seconds; `None` where there are none.
    fn series<'m>(&self, time: R, unit: R, memory: &'m mut GradientSeries<R>) -> Option<&'m mut GradientSeries<R>>;
}

/// No effect changes within an arc.
#[derive(Clone, Copy, Debug)]
pub struct NoEffects;

impl<R: Real> WithinArcs<R> for NoEffects {
    const ACT: bool = false;

    fn none(_zero: R) -> Self {
        NoEffects
    }

    fn set_lane(&mut self, _lane: usize, _run: &Gyrostat<f64>) {}

    #[inline(always)]
    fn torque(&self, time: R, _q_eb: [R; 4]) -> [R; 3] {
        [time.zero(); 3]
    }

    #[inline(always)]
    fn series<'m>(&self, _time: R, _unit: R, _memory: &'m mut GradientSeries<R>) -> Option<&'m mut GradientSeries<R>> {
        None
    }
}

/// The effects on a spacecraft in an orbit.
#[derive(Clone, Copy, Debug)]
pub struct OnOrbit<R> {
    orbit: KeplerOrbit<R>,
    gradient: GravityGradient<R>,
}

impl<R: Real> WithinArcs<R> for OnOrbit<R> {
    const ACT: bool = true;

    fn none(zero: R) -> Self {
        OnOrbit { orbit: KeplerOrbit::blank().in_lanes(zero), gradient: GravityGradient::none(zero) }
    }

    fn set_lane(&mut self, lane: usize, run: &Gyrostat<f64>) {
        self.orbit.set_lane(lane, &run.orbit.unwrap_or_else(KeplerOrbit::blank));
        self.gradient.set_lane(lane, &run.gradient.unwrap_or_else(|| GravityGradient::none(0.0)));
    }

    #[inline(always)]
    fn torque(&self, time: R, q_eb: [R; 4]) -> [R; 3] {
        let place = self.orbit.state(time);
        self.gradient.torque(q_eb, place.position, place.distance)
    }

    #[inline(always)]
    fn series<'m>(&self, time: R, unit: R, memory: &'m mut GradientSeries<R>) -> Option<&'m mut GradientSeries<R>> {
        memory.begin(&self.gradient, self.orbit.mu(), &self.orbit.state(time), unit);
        Some(memory)
    }
}
