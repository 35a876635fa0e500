//! Where runs come from ([`Runs`]) and where their states go ([`Recorder`]): what the caller of an integrator provides.

use crate::math::real::Real;
use crate::ode::system::System;

/// Runs to be integrated. A lane whose run has ended is loaded with the next one.
///
/// A run consists of arcs; within each arc the right-hand side is smooth but for its switches ([`super::switches`]).
/// Integration restarts at every boundary, exactly there.
pub trait Runs<R: Real, const N: usize>: System<R, N> {
    /// Number of runs.
    fn count(&self) -> usize;

    /// Puts run `run` into lane `lane` and returns its state at time zero.
    fn load(&mut self, lane: usize, run: usize) -> [f64; N];

    /// Prepares lane `lane` for the arc that starts at `time`, s, from `state`, and returns the end of the arc, s,
    /// which is later than `time`; `None` if `time` is the end of the run. Called at time zero and at the end of every
    /// arc.
    fn next_arc(&mut self, lane: usize, time: f64, state: &[f64; N]) -> Option<f64>;

    /// Takes the branches that are right at `time`, s, and `state` in the lanes `lanes`, until it is called again; only
    /// where [`System::has_switches`].
    #[inline(always)]
    fn choose_branches(&mut self, _lanes: R::Mask, _time: R, _state: &[R; N]) {}
}

/// Receives the states of the runs `Q` at their observation times.
pub trait Recorder<Q, const N: usize> {
    /// Run `run` starts in lane `lane`.
    fn begin(&mut self, lane: usize, run: usize);

    /// The next observation time of lane `lane`, s; infinite after the last.
    fn next_time(&self, lane: usize) -> f64;

    /// Stores the state of lane `lane` at its next observation time.
    fn record(&mut self, lane: usize, state: &[f64; N]);

    /// Run `run` in lane `lane` has ended; `runs` still has it loaded. Runs end in an order that depends on the number
    /// of lanes; what is reported of each does not.
    fn finish(&mut self, runs: &Q, lane: usize, run: usize, completion: &EndedRun);
}

/// Why a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Termination {
    /// At the end of its last arc.
    Completed,
    /// After the maximum number of steps.
    StepLimit,
    /// The step that the tolerance requires is below the resolution of the time.
    StepFloor,
    /// A state became infinite or not a number, or the stages of an implicit method did not converge.
    NonFinite,
}

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EndedRun {
    /// Why.
    pub termination: Termination,
    /// The time that was reached, s.
    pub time: f64,
    /// Accepted steps.
    pub accepted: u64,
    /// Rejected steps.
    pub rejected: u64,
    /// Evaluations of the right-hand side.
    pub evaluations: u64,
    /// Error estimates of the accepted steps in units of the tolerance, added; zero for methods without an estimate.
    pub error_sum: f64,
}
