//! [`Runs`] and [`Recorder`]: source of runs and sink of their states, implemented by the caller of an integrator.

use crate::math::real::Real;
use crate::ode::system::System;

/// Runs to integrate; the lane of a completed run loads the next.
///
/// A run consists of arcs, smooth but for [`super::switches`]. Integration restarts exactly at every boundary.
pub trait Runs<R: Real, const N: usize>: System<R, N> {
    /// Number of runs.
    fn count(&self) -> usize;

    /// Loads run `run` into lane `lane` and returns its state at time zero.
    fn load(&mut self, lane: usize, run: usize) -> [f64; N];

    /// Prepares lane `lane` for the arc from `state` at `time`, s: zero, or the end of the previous arc. Returns its
    /// end, s, later than `time`; `None` at the end of the run.
    fn next_arc(&mut self, lane: usize, time: f64, state: &[f64; N]) -> Option<f64>;

    /// Sets the branches for `_time`, s, and `_state` in `_lanes` until the next call; with [`System::has_switches`].
    #[inline(always)]
    fn choose_branches(&mut self, _lanes: R::Mask, _time: R, _state: &[R; N]) {}
}

/// Receives the states of the runs `Q` at their observation times.
pub trait Recorder<Q, const N: usize> {
    /// Run `run` starts in lane `lane`.
    fn begin(&mut self, lane: usize, run: usize);

    /// Next observation time of lane `lane`, s; infinite after the last.
    fn next_time(&self, lane: usize) -> f64;

    /// Stores the state of lane `lane` at its next observation time.
    fn record(&mut self, lane: usize, state: &[f64; N]);

    /// Run `run` in lane `lane` has ended and is still loaded in `runs`. The order of runs depends on the number of
    /// lanes.
    fn finish(&mut self, runs: &Q, lane: usize, run: usize, completion: &EndedRun);
}

/// Reason for the end of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Termination {
    /// At the end of its last arc.
    #[default]
    Completed,
    /// After the maximum number of steps.
    StepLimit,
    /// The required step is below the resolution of the time.
    StepFloor,
    /// A state became infinite or NaN, or an implicit method did not converge.
    NonFinite,
}

/// Result of a run; by default of one without arcs.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EndedRun {
    /// Reason for its end.
    pub termination: Termination,
    /// Time reached, s.
    pub time: f64,
    /// Accepted steps.
    pub accepted: u64,
    /// Rejected steps.
    pub rejected: u64,
    /// Evaluations of the right-hand side.
    pub evaluations: u64,
    /// Sum of the error estimates of accepted steps in units of the tolerance; zero without estimates.
    pub error_sum: f64,
}
