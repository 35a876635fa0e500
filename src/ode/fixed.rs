//! The march of runs in lanes with a fixed step, and the classical Runge-Kutta method.
//!
//! A stretch of length l is divided into ceil(l / step) equal steps, the last of which ends exactly on its end. An observation
//! point inside a step is reached by a step of its own from the step's start, of the fraction that it needs: as accurate as
//! the method, and it keeps what the method keeps, which an interpolating polynomial does not.

use super::explicit::{Carried, Step, each, fill_stages, poison, weighted};
use super::step_control::{Control, flag, raised};
use super::tableau::{RungeKutta4Tableau, Tableau};
use super::workspace::{LoadedRun, Workspace};
use super::{Runs, System, Tolerance};
use crate::math::{Mask, Real};
use crate::propagation::local_error;
use crate::propagation::local_error::Remainder;
use crate::run::{Grid, Trajectory};
use crate::run::{Outcome, Status, StepStatistics};

/// Steps per stretch where the campaign names no step.
const DEFAULT_STEPS: f64 = 1000.0;

/// A quotient of stretch and step that exceeds an integer by less than this share is that integer: such are rounding errors
/// of decimal fractions (0.3 / 0.1 is above 3 by one unit in the last place or below).
const WHOLE: f64 = 4.0 * f64::EPSILON;

/// A step of a fixed-step method.
pub struct Advance<R, const N: usize> {
    /// The state at its end.
    pub end: Carried<R, N>,
    /// Zero where it is sound, else not a number.
    pub poison: R,
    /// Evaluations of the right-hand side.
    pub evaluations: R,
}

/// A one-step method that takes the steps it is told.
pub trait FixedStep: Copy {
    /// What its steps leave out of the motion.
    const REMAINDER: Remainder;

    /// What a step leaves for the next, and for points inside it.
    type Memory<R: Real, const N: usize>;

    /// Nothing to remember yet.
    fn memory<R: Real, const N: usize>(zero: R) -> Self::Memory<R, N>;

    /// Takes a step; in the lanes where `fresh` is raised it is the first of a stretch.
    fn step<R: Real, Q: System<R, N>, const N: usize>(
        system: &Q,
        step: Step<R>,
        start: &Carried<R, N>,
        fresh: R,
        tolerance: Tolerance,
        memory: &mut Self::Memory<R, N>,
    ) -> Advance<R, N>;

    /// Takes the fraction `s` of the step that was taken last, which `part` describes.
    fn inside<R: Real, Q: System<R, N>, const N: usize>(
        system: &Q,
        part: Step<R>,
        s: R,
        start: &Carried<R, N>,
        tolerance: Tolerance,
        memory: &Self::Memory<R, N>,
    ) -> Advance<R, N>;
}

/// The classical Runge-Kutta method of order 4.
#[derive(Clone, Copy, Debug)]
pub struct RungeKutta4;

impl FixedStep for RungeKutta4 {
    const REMAINDER: Remainder = Remainder { order: 4, factor: 1.0 };

    /// The derivative at the start.
    type Memory<R: Real, const N: usize> = [R; N];

    #[inline(always)]
    fn memory<R: Real, const N: usize>(zero: R) -> [R; N] {
        [zero; N]
    }

    #[inline(always)]
    fn step<R: Real, Q: System<R, N>, const N: usize>(
        system: &Q,
        step: Step<R>,
        start: &Carried<R, N>,
        _fresh: R,
        tolerance: Tolerance,
        memory: &mut [R; N],
    ) -> Advance<R, N> {
        *memory = system.derivative(step.time, &start.state);
        let advance = Self::inside(system, step, step.length, start, tolerance, memory);
        Advance { evaluations: step.length.splat(4.0), ..advance }
    }

    #[inline(always)]
    fn inside<R: Real, Q: System<R, N>, const N: usize>(
        system: &Q,
        part: Step<R>,
        _s: R,
        start: &Carried<R, N>,
        _tolerance: Tolerance,
        memory: &[R; N],
    ) -> Advance<R, N> {
        let mut k = [*memory; 4];
        fill_stages::<RungeKutta4Tableau, R, Q, N, 4>(system, part, start, &mut k, (1, 4, 4));
        let end = start.advanced(part.length, &weighted(&k, &RungeKutta4Tableau::B));
        let poison = poison(&end.state, part.length.zero());
        Advance { end, poison, evaluations: part.length.splat(3.0) }
    }
}

/// Where each lane stands.
struct Places<R, const N: usize> {
    now: Carried<R, N>,
    /// Start and end of the stretch, time, next observation time, s.
    start: R,
    end: R,
    time: R,
    next: R,
    /// Length of a step, s; steps in the stretch, and steps taken in it.
    length: R,
    count: R,
    taken: R,
    /// Counts of the whole run.
    accepted: R,
    evaluations: R,
}

impl<R: Real, const N: usize> Places<R, N> {
    #[inline(always)]
    fn empty(zero: R) -> Self {
        let state = [zero; N];
        let never = zero.splat(f64::INFINITY);
        Places {
            now: Carried { state, carry: state },
            start: zero,
            end: zero,
            time: zero,
            next: never,
            length: zero,
            count: never,
            taken: zero,
            accepted: zero,
            evaluations: zero,
        }
    }

    /// Seats a run that has just come, or leaves the lane idle: then it makes steps of no length that never arrive.
    #[inline(always)]
    fn seat(&mut self, lane: usize, arrival: Option<LoadedRun<N>>, next: f64, control: &Control) {
        let Some(run) = arrival else {
            self.length.set_lane(lane, 0.0);
            self.count.set_lane(lane, f64::INFINITY);
            self.accepted.set_lane(lane, f64::NEG_INFINITY);
            self.next.set_lane(lane, f64::INFINITY);
            return;
        };
        for n in 0..N {
            self.now.state[n].set_lane(lane, run.state[n]);
            self.now.carry[n].set_lane(lane, 0.0);
        }
        self.accepted.set_lane(lane, 0.0);
        self.evaluations.set_lane(lane, 0.0);
        self.next.set_lane(lane, next);
        self.enter(lane, 0.0, run.end, control);
    }

    /// A new stretch.
    #[inline(always)]
    fn enter(&mut self, lane: usize, start: f64, end: f64, control: &Control) {
        let length = end - start;
        let steps = control.step.map_or(DEFAULT_STEPS, |step| length / step);
        let count = (steps * (1.0 - WHOLE)).ceil().max(1.0);
        self.start.set_lane(lane, start);
        self.time.set_lane(lane, start);
        self.end.set_lane(lane, end);
        self.length.set_lane(lane, length / count);
        self.count.set_lane(lane, count);
        self.taken.set_lane(lane, 0.0);
    }
}

/// Marches all runs with steps of `control.step`; else as [`super::adaptive::march`].
///
/// A run whose state stops being finite, or whose implicit stages are not found, ends as [`Status::NonFinite`].
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
    M: FixedStep,
    R: Real,
    Q: Runs<R, N>,
    F: FnMut(&Q, usize, usize, &Trajectory, &Outcome),
{
    let one = zero.splat(1.0);
    let most = zero.splat(control.max_steps as f64);
    let mut places = Places::<R, N>::empty(zero);
    let mut memory = M::memory::<R, N>(zero);
    workspace.open();
    for lane in 0..R::LANES {
        let arrival = workspace.load(lane, runs, grid, &mut finish);
        places.seat(lane, arrival, workspace.next_time(lane, grid), control);
    }
    while workspace.is_occupied() {
        let taken = places.taken + one;
        let arrived = one - flag(taken.lt(places.count), zero);
        let end = R::select(raised(arrived), places.end, taken.mul_add(places.length, places.start));
        let step = Step { time: places.time, end, length: places.length };
        let fresh = flag(places.taken.lt(one), zero);
        let advance = M::step(&*runs, step, &places.now, fresh, control.tolerance, &mut memory);
        let sound = flag(advance.poison.lt(one), zero);
        places.evaluations += advance.evaluations;

        let limit = R::select(raised(sound), end, zero.splat(f64::NEG_INFINITY));
        while raised(one - flag(limit.lt(places.next), zero)).any() {
            let inside = flag(places.next.lt(limit), zero);
            let mut reached = advance.end;
            if raised(inside).any() {
                let length = R::select(raised(inside), places.next - step.time, zero);
                let part = Step { time: step.time, end: step.time + length, length };
                let s = length / step.length;
                let point = M::inside(&*runs, part, s, &places.now, control.tolerance, &memory);
                places.evaluations = inside.mul_add(point.evaluations, places.evaluations);
                reached = Carried::select(raised(inside), &point.end, &reached);
            }
            for lane in 0..R::LANES {
                if places.next.lane(lane) <= limit.lane(lane) {
                    workspace.write(
                        lane,
                        &each::<f64, N>(
                            0.0,
                            #[inline(always)]
                            |n| reached.state[n].lane(lane),
                        ),
                    );
                    places.next.set_lane(lane, workspace.next_time(lane, grid));
                }
            }
        }

        places.now = Carried::select(raised(sound), &advance.end, &places.now);
        places.time = R::select(raised(sound), end, places.time);
        places.taken = taken;
        places.accepted += sound;

        let spent = one - flag(places.accepted.lt(most), zero);
        if raised(arrived + (one - sound) + spent).any() {
            for lane in 0..R::LANES {
                if !workspace.has_run(lane) {
                    continue;
                }
                let time = places.time.lane(lane);
                let mut status = None;
                if sound.lane(lane) < 0.5 {
                    status = Some(Status::NonFinite);
                } else if arrived.lane(lane) > 0.5 {
                    let state = each::<f64, N>(
                        0.0,
                        #[inline(always)]
                        |n| places.now.state[n].lane(lane),
                    );
                    match runs.next_arc(lane, time, &state) {
                        Some(end) => places.enter(lane, time, end, control),
                        None => status = Some(Status::Done),
                    }
                }
                if status.is_none() && spent.lane(lane) > 0.5 {
                    status = Some(Status::StepLimit);
                }
                if let Some(status) = status {
                    let effort = StepStatistics {
                        steps: places.accepted.lane(lane) as u64,
                        rejected: 0,
                        evaluations: places.evaluations.lane(lane) as u64,
                    };
                    workspace.close(
                        lane,
                        &*runs,
                        status,
                        time,
                        (effort, local_error::rounding(effort.steps)),
                        &mut finish,
                    );
                    let arrival = workspace.load(lane, runs, grid, &mut finish);
                    places.seat(lane, arrival, workspace.next_time(lane, grid), control);
                }
            }
        }
    }
}
