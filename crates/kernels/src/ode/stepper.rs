//! [`Stepper`]: choice and execution of steps in lanes.

use super::error_model::ErrorModel;
use super::explicit::{Carried, each};
use super::lane_slot::LoadedRun;
use super::runs::{EndedRun, Termination};
use super::step::Step;
use super::step_control::{Control, PACE_STEPS, is_out_of_reach};
use super::system::System;
use crate::math::real::Real;

/// A method with its step control.
pub trait LaneMethod: Copy {
    /// Error model.
    const ERRORS: ErrorModel;
    /// True for steps of given length, false if they follow the tolerance.
    const HAS_FIXED_STEP: bool;

    /// Steps in lanes.
    type Stepper<R: Real, const N: usize>: Stepper<R, N>;

    /// A stepper for all lanes in the arithmetic of `zero`.
    fn stepper<R: Real, const N: usize>(self, zero: R, control: &Control) -> Self::Stepper<R, N>;
}

/// State of the lanes common to all methods.
pub struct StepperLane<R, const N: usize> {
    /// State at the current time.
    pub now: Carried<R, N>,
    /// Current time, s.
    pub time: R,
    /// End of the current arc, s.
    pub arc_end: R,
    /// Start of the current arc, s.
    pub(super) arc_start: R,
    /// Attempted steps of the run before the arc.
    pub(super) before: R,
    /// Those at which [`StepperLane::gives_up`] is evaluated next.
    pub(super) judged: R,
    /// Next observation time, s.
    pub next: R,
    /// Accepted steps of the run.
    pub accepted: R,
    /// Rejected steps of the run.
    pub rejected: R,
    /// Evaluations of the right-hand side in the run.
    pub evaluations: R,
    /// Sum of the error estimates of accepted steps, in units of the tolerance.
    pub error_sum: R,
}

#[derive(Clone, Copy)]
pub struct Proposal<R: Real> {
    pub step: Step<R>,
    /// True if it ends at the end of the arc.
    pub lands: R::Mask,
}

pub struct Attempt<R: Real> {
    /// True if accepted.
    pub accepted: R::Mask,
    /// True if everything is finite.
    pub sound: R::Mask,
    /// Error in units of the tolerance, zero without an estimate.
    pub error: R,
    /// [`super::embedded::PairAttempt::rough`].
    pub rough: R,
    /// True if f is not smooth at the start of the step.
    pub from_edge: R::Mask,
}

/// Choice and execution of a method's steps in all lanes.
pub trait Stepper<R: Real, const N: usize> {
    /// An arc from `start` to `end`, s, starts in lane `lane`.
    fn start_arc(&mut self, lane: usize, start: f64, end: f64);

    /// Lane `lane` has no run; it takes steps of zero length.
    fn idle(&mut self, lane: usize);

    fn propose<Q: System<R, N>>(&mut self, system: &Q, lanes: &mut StepperLane<R, N>) -> Proposal<R>;

    /// Attempts the step to `end`.
    fn attempt<Q: System<R, N>>(
        &mut self,
        system: &Q,
        step: Step<R>,
        lanes: &mut StepperLane<R, N>,
        end: &mut Carried<R, N>,
    ) -> Attempt<R>;

    /// Prepares [`Stepper::inside`] for the lanes `inside` of the attempted step.
    #[inline(always)]
    fn prepare_inside<Q: System<R, N>>(
        &mut self,
        _system: &Q,
        _step: Step<R>,
        _end: &[R; N],
        _inside: R::Mask,
        _lanes: &mut StepperLane<R, N>,
    ) {
    }

    /// State at the end of `part`, the first part of the attempted `step`, for the lanes `inside`.
    fn inside<Q: System<R, N>>(
        &mut self,
        system: &Q,
        step: Step<R>,
        part: Step<R>,
        inside: R::Mask,
        lanes: &mut StepperLane<R, N>,
    ) -> [R; N];

    /// Chooses the length of the next step; returns the lanes that cannot continue.
    fn advance(&mut self, proposal: &Proposal<R>, attempt: &Attempt<R>) -> R::Mask;

    /// Derivatives at both ends of the last attempted step; only adaptive methods end steps at switches.
    #[inline(always)]
    fn slopes(&self) -> [&[R; N]; 2] {
        unreachable!("equal steps do not end at switches")
    }

    /// After [`Stepper::advance`]: sets the next length, s, in `_lanes`; later steps resume that of the replaced step.
    #[inline(always)]
    fn cut(&mut self, _lanes: R::Mask, _length: R) {}

    /// Steps have come `_into` lanes where f is not smooth, or out of them: there the former length is resumed.
    #[inline(always)]
    fn pass_edges(&mut self, _into: R::Mask, _out_of: R::Mask) {}

    /// After [`Stepper::advance`]: limits the next length to `_longest`, s.
    #[inline(always)]
    fn limit(&mut self, _longest: R) {}

    /// Updates the derivative at the current time in the lanes `_renewed`, where branches have changed.
    #[inline(always)]
    fn renew<Q: System<R, N>>(&mut self, _system: &Q, _renewed: R::Mask, _lanes: &mut StepperLane<R, N>) {}
}

impl<R: Real, const N: usize> StepperLane<R, N> {
    #[inline(always)]
    pub(super) fn new(zero: R) -> Self {
        let state = [zero; N];
        StepperLane {
            now: Carried { state, carry: state },
            time: zero,
            arc_end: zero.splat(f64::INFINITY),
            arc_start: zero,
            before: zero,
            judged: zero,
            next: zero.splat(f64::INFINITY),
            accepted: zero,
            rejected: zero,
            evaluations: zero,
            error_sum: zero,
        }
    }

    /// Counts `evaluations` of the right-hand side in `lanes`.
    #[inline(always)]
    pub(super) fn count(&mut self, lanes: R::Mask, evaluations: f64) {
        let zero = self.evaluations.zero();
        self.evaluations += R::select(lanes, zero.splat(evaluations), zero);
    }

    #[inline(always)]
    pub(super) fn state(&self, lane: usize) -> [f64; N] {
        of_lane(&self.now.state, lane)
    }

    /// Starts the run `loaded`, first observed at `next`, in lane `lane`; without a run the lane is idle.
    #[inline(always)]
    pub(super) fn start<P: Stepper<R, N>>(
        &mut self,
        lane: usize,
        loaded: Option<LoadedRun<N>>,
        next: f64,
        stepper: &mut P,
        control: &Control,
    ) {
        self.time.set_lane(lane, 0.0);
        self.accepted.set_lane(lane, 0.0);
        self.evaluations.set_lane(lane, 0.0);
        self.error_sum.set_lane(lane, 0.0);
        let Some(run) = loaded else {
            // never reaches a limit of steps, an observation point or the end of an arc
            self.rejected.set_lane(lane, f64::NEG_INFINITY);
            self.arc_end.set_lane(lane, f64::INFINITY);
            self.next.set_lane(lane, f64::INFINITY);
            stepper.idle(lane);
            return;
        };
        for n in 0..N {
            self.now.state[n].set_lane(lane, run.state[n]);
            self.now.carry[n].set_lane(lane, 0.0);
        }
        self.rejected.set_lane(lane, 0.0);
        self.next.set_lane(lane, next);
        self.start_arc(lane, 0.0, run.end, stepper, control);
    }

    #[inline(always)]
    pub(super) fn start_arc<P: Stepper<R, N>>(
        &mut self,
        lane: usize,
        start: f64,
        end: f64,
        stepper: &mut P,
        control: &Control,
    ) {
        let before = self.attempts(lane);
        self.arc_start.set_lane(lane, start);
        self.arc_end.set_lane(lane, end);
        self.before.set_lane(lane, before);
        self.judged.set_lane(lane, (before + PACE_STEPS as f64).min(control.max_steps as f64));
        stepper.start_arc(lane, start, end);
    }

    #[inline(always)]
    pub(super) fn attempts(&self, lane: usize) -> f64 {
        self.accepted.lane(lane) + self.rejected.lane(lane)
    }

    /// True if the run in lane `lane` has used up its steps, or will before the end of its arc.
    #[cold]
    pub(super) fn gives_up(&mut self, lane: usize, max_steps: u64) -> bool {
        let (attempts, before) = (self.attempts(lane), self.before.lane(lane));
        if attempts >= max_steps as f64 {
            return true;
        }
        if attempts < before + PACE_STEPS as f64 {
            return false; // the next arc has just begun
        }
        self.judged.set_lane(lane, max_steps as f64);
        let start = self.arc_start.lane(lane);
        is_out_of_reach(max_steps - before as u64, self.time.lane(lane) - start, self.arc_end.lane(lane) - start)
    }

    #[inline(always)]
    pub(super) fn completion(&self, lane: usize, termination: Termination) -> EndedRun {
        EndedRun {
            termination,
            time: self.time.lane(lane),
            accepted: self.accepted.lane(lane) as u64,
            rejected: self.rejected.lane(lane) as u64,
            evaluations: self.evaluations.lane(lane) as u64,
            error_sum: self.error_sum.lane(lane),
        }
    }
}

#[inline(always)]
pub(super) fn of_lane<R: Real, const N: usize>(state: &[R; N], lane: usize) -> [f64; N] {
    each!(0.0, |n| state[n].lane(lane))
}
