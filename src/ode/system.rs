//! What an integrator asks of a kernel: a right-hand side in lanes, and runs to put into them.

use crate::math::Real;

/// A first-order system y' = f(t, y) of `N` components, in lanes.
pub trait System<R: Real, const N: usize> {
    /// f(t, y).
    fn derivative(&self, time: R, state: &[R; N]) -> [R; N];

    /// The size of a step's local error in units of the tolerance: the step passes where it is at most one.
    ///
    /// `error` is the difference of the embedded solutions, `old` and `new` the states at both ends. Each kernel scales its
    /// components by what they mean; the reference kernel does as ode45 does. It must be homogeneous in `error` (twice the
    /// error, twice the ratio): the choice of a first step also asks for the size of a derivative, or of a state, in it.
    fn error_ratio(&self, error: &[R; N], old: &[R; N], new: &[R; N], tolerance: Tolerance) -> R;
}

/// Runs that wait for a lane. A lane that has finished is loaded with the next.
pub trait Runs<R: Real, const N: usize>: System<R, N> {
    /// Number of runs.
    fn count(&self) -> usize;

    /// Puts run `run` into lane `lane` and returns its state at time zero.
    fn load(&mut self, lane: usize, run: usize) -> [f64; N];

    /// Starts the next arc of the run in lane `lane` at `time`, where its state is `state`, and returns the time at which the arc
    /// ends, s, after `time`; `None` where the run is at its end.
    ///
    /// Within an arc the right-hand side is analytic; integration restarts exactly at every boundary. The arcs cover the time from
    /// zero without a gap.
    fn next_arc(&mut self, lane: usize, time: f64, state: &[f64; N]) -> Option<f64>;
}

/// Relative and absolute tolerance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerance {
    /// Relative to the size of the component (or of the vector that it belongs to).
    pub relative: f64,
    /// Absolute, in the unit of the component (or in units of the vector's natural scale).
    pub absolute: f64,
}
