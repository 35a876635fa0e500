//! [`Adaptive`]: embedded pairs with the step control of ode45 (Shampine & Reichelt 1997), operation by operation.

use super::embedded::Embedded;
use super::error_model::ErrorModel;
use super::explicit::{Carried, Step, chosen};
use super::step_control::{Control, factor_from_edge, shortest_step};
use super::stepper::{Attempt, LaneMethod, Proposal, Stepper, StepperLane};
use super::system::{System, Tolerance};
use crate::math::real::{Mask, Real};

/// Error of a step that is not finite: the strongest reduction.
const UNSOUND: f64 = 1e30;

/// An embedded pair whose steps follow the tolerance.
#[derive(Clone, Copy, Debug)]
pub struct Adaptive<M>(pub M);

impl<M: Embedded> LaneMethod for Adaptive<M> {
    const ERRORS: ErrorModel = ErrorModel::Estimated(M::ERRORS);
    const HAS_FIXED_STEP: bool = false;

    type Stepper<R: Real, const N: usize> = AdaptiveStepper<M, R, N>;

    #[inline(always)]
    fn stepper<R: Real, const N: usize>(self, zero: R, control: &Control) -> AdaptiveStepper<M, R, N> {
        AdaptiveStepper {
            tolerance: control.tolerance,
            stages: M::stages(zero),
            length: zero,
            longest: zero,
            attempted: zero,
            floor: zero,
            starting: zero.never(),
            continued: zero.never(),
            retry: zero.never(),
            cut: zero.never(),
            resumed: zero,
            smooth: zero,
            is_prepared: false,
        }
    }
}

pub struct AdaptiveStepper<M: Embedded, R: Real, const N: usize> {
    tolerance: Tolerance,
    stages: M::Stages<R, N>,
    /// Next and longest step, s.
    length: R,
    longest: R,
    /// Attempted step and shortest step at its time, s.
    attempted: R,
    floor: R,
    /// True at the start of an arc; true if the arc continues a run; true after a rejection of the same step.
    starting: R::Mask,
    continued: R::Mask,
    retry: R::Mask,
    /// True if the step ends at a switch; the step that it replaces, s.
    cut: R::Mask,
    resumed: R,
    /// Length of the next step before the motion came to where f is not smooth, s.
    smooth: R,
    /// True if states inside the last attempted step can be computed.
    is_prepared: bool,
}

impl<M: Embedded, R: Real, const N: usize> AdaptiveStepper<M, R, N> {
    #[inline(always)]
    fn start<Q: System<R, N>>(&mut self, system: &Q, lanes: &mut StepperLane<R, N>) {
        let (state, starting) = (&lanes.now.state, self.starting);
        let slope = system.derivative(lanes.time, state);
        let longest = (lanes.arc_end - lanes.time) * lanes.time.splat(M::CONTROLLER.longest);
        let first = M::first(&mut self.stages);
        *first = chosen(starting, &slope, first);
        self.longest = R::select(starting, longest, self.longest);
        // the motion goes on: the last arc's controller knows its step, whatever the length of the arcs
        let continued = if system.continues() { starting & self.continued } else { lanes.time.never() };
        self.longest = R::select(continued, lanes.arc_end - lanes.time, self.longest);
        let unknown = starting & !continued;
        if unknown.any() {
            let length = M::first_step(system, lanes.time, state, &slope, longest, self.tolerance);
            self.length = R::select(unknown, length, self.length);
            lanes.count(unknown, M::START_EVALUATIONS - 1.0);
        }
        lanes.count(starting, 1.0);
        self.starting = lanes.time.never();
    }
}

impl<M: Embedded, R: Real, const N: usize> Stepper<R, N> for AdaptiveStepper<M, R, N> {
    #[inline(always)]
    fn start_arc(&mut self, lane: usize, start: f64, _end: f64) {
        self.starting.set(lane, true);
        self.continued.set(lane, start > 0.0);
        self.smooth.set_lane(lane, 0.0);
        self.retry.set(lane, false);
        self.cut.set(lane, false);
    }

    #[inline(always)]
    fn idle(&mut self, lane: usize) {
        self.starting.set(lane, false);
        self.retry.set(lane, false);
        self.cut.set(lane, false);
        self.length.set_lane(lane, 0.0);
        self.longest.set_lane(lane, 0.0);
    }

    /// A step within bounds, or to the end of the arc if that is near.
    #[inline(always)]
    fn propose<Q: System<R, N>>(&mut self, system: &Q, lanes: &mut StepperLane<R, N>) -> Proposal<R> {
        if self.starting.any() {
            self.start(system, lanes);
        }
        self.floor = shortest_step(lanes.time);
        let length = self.length.larger(self.floor).smaller(self.longest);
        let remaining = lanes.arc_end - lanes.time;
        let beyond = (length * length.splat(M::CONTROLLER.landing)).lt(remaining);
        let lands = !(beyond | self.retry | self.cut);
        self.attempted = R::select(lands, remaining, length);
        let end = R::select(lands, lanes.arc_end, lanes.time + self.attempted);
        Proposal { step: Step { time: lanes.time, end, length: end - lanes.time }, lands }
    }

    #[inline(always)]
    fn attempt<Q: System<R, N>>(
        &mut self,
        system: &Q,
        step: Step<R>,
        lanes: &mut StepperLane<R, N>,
        end: &mut Carried<R, N>,
    ) -> Attempt<R> {
        let one = step.time.splat(1.0);
        self.is_prepared = false;
        let attempt = M::attempt(system, step, &lanes.now, self.tolerance, &mut self.stages, end);
        lanes.evaluations += one.splat(M::EVALUATIONS);
        let sound = attempt.poison.lt(one);
        let error = R::select(sound, attempt.ratio, one.splat(UNSOUND));
        Attempt { accepted: !one.lt(error), sound, error, rough: attempt.rough, from_edge: step.time.never() }
    }

    #[inline(always)]
    fn prepare_inside<Q: System<R, N>>(
        &mut self,
        system: &Q,
        step: Step<R>,
        end: &[R; N],
        inside: R::Mask,
        lanes: &mut StepperLane<R, N>,
    ) {
        if !self.is_prepared {
            self.is_prepared = true;
            let (start, stages) = (&lanes.now, &mut self.stages);
            step.time.apart(
                #[inline(always)]
                || M::prepare_inside(system, step, start, end, stages),
            );
        }
        lanes.count(inside, M::DENSE_EVALUATIONS);
    }

    #[inline(always)]
    fn inside<Q: System<R, N>>(
        &mut self,
        system: &Q,
        step: Step<R>,
        part: Step<R>,
        inside: R::Mask,
        lanes: &mut StepperLane<R, N>,
    ) -> [R; N] {
        lanes.count(inside, M::POINT_EVALUATIONS);
        M::inside(system, step, part.length / step.length, &lanes.now, &self.stages)
    }

    #[inline(always)]
    fn advance(&mut self, proposal: &Proposal<R>, attempt: &Attempt<R>) -> R::Mask {
        let (accepted, rejected) = (attempt.accepted, !attempt.accepted);
        let mut factor = M::CONTROLLER.factor(attempt.error, accepted, self.retry);
        let rough = attempt.from_edge & rejected;
        if rough.any() {
            factor = R::select(rough, factor_from_edge(attempt.error), factor);
        }
        // a step that an arc's end has shortened does not shorten the steps of the next arc
        let shortened = proposal.lands & accepted & !factor.lt(factor.splat(M::CONTROLLER.growth));
        let least = R::select(shortened, self.length, R::select(accepted, factor.zero(), self.floor));
        self.length = (self.attempted * factor).larger(least);
        self.retry = rejected;
        let last = *M::ends(&self.stages)[1];
        let first = M::first(&mut self.stages);
        *first = chosen(accepted, &last, first);
        if self.cut.any() {
            self.length = R::select(self.cut & accepted, self.length.larger(self.resumed), self.length);
            self.cut = self.cut & rejected;
        }
        rejected & !self.floor.lt(self.attempted)
    }

    #[inline(always)]
    fn slopes(&self) -> [&[R; N]; 2] {
        M::ends(&self.stages)
    }

    #[inline(always)]
    fn cut(&mut self, lanes: R::Mask, length: R) {
        self.resumed = R::select(lanes & !self.cut, self.attempted, self.resumed);
        self.length = R::select(lanes, length, self.length);
        self.retry = self.retry & !lanes;
        self.cut = self.cut | lanes;
    }

    #[inline(always)]
    fn pass_edges(&mut self, into: R::Mask, out_of: R::Mask) {
        self.smooth = R::select(into, self.length, self.smooth);
        self.length = R::select(out_of, self.length.larger(self.smooth), self.length);
    }

    #[inline(always)]
    fn limit(&mut self, longest: R) {
        self.length = self.length.smaller(longest);
    }

    #[inline(always)]
    fn renew<Q: System<R, N>>(&mut self, system: &Q, renewed: R::Mask, lanes: &mut StepperLane<R, N>) {
        let slope = system.derivative(lanes.time, &lanes.now.state);
        let first = M::first(&mut self.stages);
        *first = chosen(renewed, &slope, first);
        lanes.count(renewed, 1.0);
    }
}
