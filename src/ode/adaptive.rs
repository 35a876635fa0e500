//! The march of runs in lanes with steps that follow the tolerance.
//!
//! Every lane has its own time, step, stretch, error and verdict; one that has arrived hands its run over and takes the next
//! at once. All decisions are correctly rounded arithmetic on the lane's own numbers, so that lane i equals the scalar run
//! bit for bit (`tests/lanes_runge_kutta.rs`). The order of things within a step is ode45's (Shampine & Reichelt 1997).

use super::embedded::Embedded;
use super::explicit::{Carried, Step, chosen, each};
use super::step_control::{Control, flag, raised, shortest_step};
use super::workspace::{LoadedRun, Workspace};
use super::{Runs, System};
use crate::math::{Mask, Real};
use crate::run::{Grid, Trajectory};
use crate::run::{Outcome, Status, StepStatistics};

/// What counts as the error of a step in which something is not finite: the strongest cut that a controller knows.
const POISONED: f64 = 1e30;

/// Where each lane stands.
struct Places<R, const N: usize> {
    now: Carried<R, N>,
    /// Time, end of the stretch, next observation time, s.
    time: R,
    end: R,
    next: R,
    /// Length of the step to try, and of the longest, s.
    length: R,
    longest: R,
    /// Flags: at the start of a stretch; after a rejection of the same step.
    starting: R,
    retry: R,
    /// Counts.
    accepted: R,
    rejected: R,
    evaluations: R,
    /// Errors of the accepted steps in units of the tolerance, added up.
    error: R,
}

impl<R: Real, const N: usize> Places<R, N> {
    #[inline(always)]
    fn empty(zero: R) -> Self {
        let state = [zero; N];
        Places {
            now: Carried { state, carry: state },
            time: zero,
            end: zero.splat(f64::INFINITY),
            next: zero.splat(f64::INFINITY),
            length: zero,
            longest: zero,
            starting: zero,
            retry: zero,
            accepted: zero,
            rejected: zero,
            evaluations: zero,
            error: zero,
        }
    }

    /// Seats a run that has just come, or leaves the lane idle: then it makes steps of no length that never arrive.
    #[inline(always)]
    fn seat(&mut self, lane: usize, arrival: Option<LoadedRun<N>>, next: f64) {
        let end = match &arrival {
            Some(run) => run.end,
            None => f64::INFINITY,
        };
        if let Some(run) = &arrival {
            for n in 0..N {
                self.now.state[n].set_lane(lane, run.state[n]);
                self.now.carry[n].set_lane(lane, 0.0);
            }
        }
        self.time.set_lane(lane, 0.0);
        self.accepted.set_lane(lane, 0.0);
        self.rejected.set_lane(lane, if arrival.is_some() { 0.0 } else { f64::NEG_INFINITY });
        self.evaluations.set_lane(lane, 0.0);
        self.error.set_lane(lane, 0.0);
        self.enter(lane, end);
        if arrival.is_none() {
            self.starting.set_lane(lane, 0.0);
            self.length.set_lane(lane, 0.0);
            self.longest.set_lane(lane, 0.0);
        }
        self.next.set_lane(lane, if arrival.is_some() { next } else { f64::INFINITY });
    }

    /// A new stretch.
    #[inline(always)]
    fn enter(&mut self, lane: usize, end: f64) {
        self.end.set_lane(lane, end);
        self.starting.set_lane(lane, 1.0);
        self.retry.set_lane(lane, 0.0);
    }

    #[inline(always)]
    fn effort(&self, lane: usize) -> StepStatistics {
        StepStatistics {
            steps: self.accepted.lane(lane) as u64,
            rejected: self.rejected.lane(lane) as u64,
            evaluations: self.evaluations.lane(lane) as u64,
        }
    }
}

/// Marches all runs to the end of their stretches and hands each to `finish(runs, lane, run, trajectory, outcome)`.
///
/// `zero` says which kind of number is meant. The trajectory holds the components that the method integrates at the times
/// of `grid`: point zero is the initial state itself, a point at the end of a step the step's own state, any other dense
/// output; what was not reached is not a number. `finish` is called in the order of arrival, which depends on the number of
/// lanes; what it is called with does not. Call inside [`crate::math::Isa::run`].
///
/// # Panics
/// Where `workspace` was made for fewer lanes or components, or for another number of points.
#[inline(always)]
pub fn march<M, R, Q, F, const N: usize>(
    _method: M,
    zero: R,
    runs: &mut Q,
    grid: &Grid,
    control: &Control,
    workspace: &mut Workspace,
    mut finish: F,
) where
    M: Embedded,
    R: Real,
    Q: Runs<R, N>,
    F: FnMut(&Q, usize, usize, &Trajectory, &Outcome),
{
    let one = zero.splat(1.0);
    let most = zero.splat(control.max_steps as f64);
    let mut places = Places::<R, N>::empty(zero);
    let mut stages = M::stages::<R, N>(zero);
    workspace.open();
    for lane in 0..R::LANES {
        let arrival = workspace.load(lane, runs, grid, &mut finish);
        places.seat(lane, arrival, workspace.next_time(lane, grid));
    }
    while workspace.is_occupied() {
        if raised(places.starting).any() {
            start::<M, R, Q, N>(runs, &mut places, &mut stages, control);
        }

        // The step to try: within its bounds, and on to the end of the stretch where that is near.
        let floor = shortest_step(places.time);
        let length = places.length.larger(floor).smaller(places.longest);
        let remaining = places.end - places.time;
        let beyond = (length * zero.splat(M::CONTROLLER.landing)).lt(remaining);
        let landing = (one - flag(beyond, zero)) * (one - places.retry);
        let attempted = R::select(raised(landing), remaining, length);
        let end = R::select(raised(landing), places.end, places.time + attempted);
        let step = Step { time: places.time, end, length: end - places.time };

        let attempt = M::attempt(&*runs, step, &places.now, control.tolerance, &mut stages);
        let sound = attempt.poison.lt(one);
        let ratio = R::select(sound, attempt.ratio, zero.splat(POISONED));
        let accepted = one - flag(one.lt(ratio), zero);
        let refused = one - accepted;
        let verdict = raised(accepted);

        places.accepted += accepted;
        places.rejected += refused;
        places.error += R::select(verdict, ratio, zero);
        places.evaluations += zero.splat(M::EVALUATIONS);

        // Observation points up to the end of the step.
        let limit = R::select(verdict, end, zero.splat(f64::NEG_INFINITY));
        if raised(one - flag(limit.lt(places.next), zero)).any() {
            let inside = flag(places.next.lt(limit), zero);
            if raised(inside).any() {
                M::prepare_inside(&*runs, step, &places.now, &attempt.end.state, &mut stages);
                places.evaluations = inside.mul_add(zero.splat(M::DENSE_EVALUATIONS), places.evaluations);
            }
            observe::<M, R, Q, N>(&*runs, &mut places, step, limit, &attempt.end.state, &stages, workspace, grid);
        }

        // The next step.
        let factor = M::CONTROLLER.factor(ratio, accepted, places.retry);
        places.length = (attempted * factor).larger(R::select(verdict, zero, floor));
        places.time = R::select(verdict, end, places.time);
        places.now = Carried::select(verdict, &attempt.end, &places.now);
        let last = *M::last(&stages);
        let first = M::first(&mut stages);
        *first = chosen(verdict, &last, first);

        // Arrivals and troubles, lane by lane.
        let arrived = accepted * landing;
        let stuck = refused * (one - flag(floor.lt(attempted), zero));
        let spent = one - flag((places.accepted + places.rejected).lt(most), zero);
        places.retry = refused;
        if raised(arrived + stuck + spent).any() {
            let healthy = flag(sound, zero);
            for lane in 0..R::LANES {
                if !workspace.has_run(lane) {
                    continue;
                }
                let time = places.time.lane(lane);
                let mut status = None;
                if arrived.lane(lane) > 0.5 {
                    let state = each::<f64, N>(
                        0.0,
                        #[inline(always)]
                        |n| places.now.state[n].lane(lane),
                    );
                    match runs.next_arc(lane, time, &state) {
                        Some(end) => places.enter(lane, end),
                        None => status = Some(Status::Done),
                    }
                } else if stuck.lane(lane) > 0.5 {
                    status = Some(if healthy.lane(lane) > 0.5 { Status::StepFloor } else { Status::NonFinite });
                }
                if status.is_none() && spent.lane(lane) > 0.5 {
                    status = Some(Status::StepLimit);
                }
                if let Some(status) = status {
                    let effort = places.effort(lane);
                    let errors = M::ERRORS.sum(places.error.lane(lane), control.tolerance.relative, effort.steps);
                    workspace.close(lane, &*runs, status, time, (effort, errors), &mut finish);
                    let arrival = workspace.load(lane, runs, grid, &mut finish);
                    places.seat(lane, arrival, workspace.next_time(lane, grid));
                }
            }
        }
    }
}

/// The derivative and the first step of the lanes at the start of a stretch.
#[inline(always)]
fn start<M, R, Q, const N: usize>(
    system: &Q,
    places: &mut Places<R, N>,
    stages: &mut M::Stages<R, N>,
    control: &Control,
) where
    M: Embedded,
    R: Real,
    Q: System<R, N>,
{
    let starting = raised(places.starting);
    let state = &places.now.state;
    let slope = system.derivative(places.time, state);
    let longest = (places.end - places.time) * places.time.splat(M::CONTROLLER.longest);
    let length = M::first_step(system, places.time, state, &slope, longest, control.tolerance);
    let first = M::first(stages);
    *first = chosen(starting, &slope, first);
    places.longest = R::select(starting, longest, places.longest);
    places.length = R::select(starting, length, places.length);
    let evaluations = places.time.splat(M::START_EVALUATIONS);
    places.evaluations = places.starting.mul_add(evaluations, places.evaluations);
    places.starting = places.starting.zero();
}

/// Writes the observation points up to `limit`, of all lanes together, one point of each at a time.
#[inline(always)]
#[expect(clippy::too_many_arguments, reason = "a hot inner function: one struct more would be taken apart at once")]
fn observe<M, R, Q, const N: usize>(
    system: &Q,
    places: &mut Places<R, N>,
    step: Step<R>,
    limit: R,
    end: &[R; N],
    stages: &M::Stages<R, N>,
    workspace: &mut Workspace,
    grid: &Grid,
) where
    M: Embedded,
    R: Real,
    Q: System<R, N>,
{
    loop {
        let fraction = (places.next - step.time) / step.length;
        let inside = M::inside(system, step, fraction, &places.now, stages);
        let mut due = false;
        for lane in 0..R::LANES {
            let (next, limit) = (places.next.lane(lane), limit.lane(lane));
            if next <= limit {
                let state = if next < limit { &inside } else { end };
                if next < limit {
                    let evaluations = places.evaluations.lane(lane) + M::POINT_EVALUATIONS;
                    places.evaluations.set_lane(lane, evaluations);
                }
                workspace.write(
                    lane,
                    &each::<f64, N>(
                        0.0,
                        #[inline(always)]
                        |n| state[n].lane(lane),
                    ),
                );
                let next = workspace.next_time(lane, grid);
                places.next.set_lane(lane, next);
                due |= next <= limit;
            }
        }
        if !due {
            return;
        }
    }
}
