//! [`integrate`]: driver of all methods, with runs in lanes, each with its own time, step, arc and error.
//!
//! In each cycle a [`Stepper`] attempts a step in every lane, observation points inside are recorded, and the lanes of
//! completed runs load the next. Decisions are correctly rounded arithmetic on the lane's own numbers, so that a lane
//! equals the scalar run bit for bit (`tests/determinism/lanes_runge_kutta.rs`). No allocation.

use super::explicit::Carried;
use super::lane_slot::LaneSlots;
use super::runs::{Recorder, Runs, Termination};
use super::step::Step;
use super::step_control::Control;
use super::stepper::{LaneMethod, Stepper, StepperLane, of_lane};
use super::switches::Switches;
use super::system::System;
use crate::math::real::{Mask, Real};

/// Integrates all runs to the end of their last arcs, in the arithmetic of `zero`.
///
/// The recorder gets the state at every observation time. A run ends early for the reasons of [`Termination`]. Call
/// inside [`crate::math::Isa::run`].
#[inline(always)]
pub fn integrate<M, R, Q, O, const N: usize>(method: M, zero: R, runs: &mut Q, recorder: &mut O, control: &Control)
where
    M: LaneMethod,
    R: Real,
    Q: Runs<R, N>,
    O: Recorder<Q, N>,
{
    let mut stepper = method.stepper::<R, N>(zero, control);
    let mut lanes = StepperLane::<R, N>::new(zero);
    let mut end = lanes.now;
    let mut slots = LaneSlots::new();
    for lane in 0..R::LANES {
        let loaded = slots.load_lane(lane, runs, recorder);
        lanes.start(lane, loaded, recorder.next_time(lane), &mut stepper, control);
    }
    let has_switches = !M::HAS_FIXED_STEP && runs.has_switches();
    let mut switches = Switches::new(zero, control);
    let rough_weight = M::ERRORS.rough_weight(control.tolerance.relative);
    while slots.any_occupied() {
        if has_switches {
            switches.choose(runs, &mut stepper, &mut lanes);
        }
        let proposal = stepper.propose(&*runs, &mut lanes);
        let step = proposal.step;
        let mut attempt = stepper.attempt(&*runs, step, &mut lanes, &mut end);
        if has_switches {
            switches.find(&*runs, &mut stepper, &mut lanes, step, &mut attempt, &end.state);
        }
        lanes.accepted += zero.indicator(attempt.accepted);
        lanes.rejected += zero.indicator(!attempt.accepted);
        let mut counted = attempt.error;
        if has_switches {
            // an arc of a loop, and not the light, sets the length of a step
            let rough = if runs.continues() { attempt.rough } else { counted };
            counted = R::select(runs.is_rough(zero), rough * zero.splat(rough_weight), counted);
        }
        lanes.error_sum += R::select(attempt.accepted, counted, zero);

        let limit = R::select(attempt.accepted, step.end, zero.splat(f64::NEG_INFINITY));
        if (!limit.lt(lanes.next)).any() {
            record(&*runs, &mut stepper, &mut lanes, step, limit, &end.state, recorder);
        }

        let mut failed = stepper.advance(&proposal, &attempt);
        if has_switches {
            failed = failed & !switches.cut(&mut stepper, &attempt);
        }
        lanes.time = R::select(attempt.accepted, step.end, lanes.time);
        lanes.now = Carried::select(attempt.accepted, &end, &lanes.now);

        let arrived = attempt.accepted & proposal.lands;
        let spent = !(lanes.accepted + lanes.rejected).lt(lanes.judged);
        if (arrived | failed | spent).any() {
            for lane in 0..R::LANES {
                let Some(run) = slots.run(lane) else { continue };
                let mut ended = None;
                if arrived.test(lane) {
                    let time = lanes.time.lane(lane);
                    match runs.next_arc(lane, time, &lanes.state(lane)) {
                        Some(end) => {
                            lanes.start_arc(lane, time, end, &mut stepper, control);
                            switches.start_arc(lane);
                        }
                        None => ended = Some(Termination::Completed),
                    }
                } else if failed.test(lane) {
                    let sound = attempt.sound.test(lane);
                    ended = Some(if sound { Termination::StepFloor } else { Termination::NonFinite });
                }
                if ended.is_none() && spent.test(lane) && lanes.gives_up(lane, control.max_steps) {
                    ended = Some(Termination::StepLimit);
                }
                if let Some(termination) = ended {
                    recorder.finish(&*runs, lane, run, &lanes.completion(lane, termination));
                    slots.clear(lane);
                    let loaded = slots.load_lane(lane, runs, recorder);
                    lanes.start(lane, loaded, recorder.next_time(lane), &mut stepper, control);
                    switches.start_run(lane);
                }
            }
        }
    }
}

/// Records the observation points up to `limit` in all lanes, one per lane at a time.
#[inline(always)]
fn record<R, Q, P, O, const N: usize>(
    system: &Q,
    stepper: &mut P,
    lanes: &mut StepperLane<R, N>,
    step: Step<R>,
    limit: R,
    end: &[R; N],
    recorder: &mut O,
) where
    R: Real,
    Q: System<R, N>,
    P: Stepper<R, N>,
    O: Recorder<Q, N>,
{
    let inside = lanes.next.lt(limit);
    if inside.any() {
        stepper.prepare_inside(system, step, end, inside, lanes);
    }
    loop {
        let inside = lanes.next.lt(limit);
        let reached = if inside.any() {
            let length = R::select(inside, lanes.next - step.time, step.time.zero());
            stepper.inside(system, step, step.part(length), inside, lanes)
        } else {
            *end
        };
        for lane in 0..R::LANES {
            if lanes.next.lane(lane) <= limit.lane(lane) {
                let state = if inside.test(lane) { &reached } else { end };
                recorder.record(lane, &of_lane(state, lane));
                lanes.next.set_lane(lane, recorder.next_time(lane));
            }
        }
        if !(!limit.lt(lanes.next)).any() {
            return;
        }
    }
}
