//! Textbook problems, integrated run by run.

use spindrift::math::Real;
pub use spindrift::ode::{Adaptive, Fixed, LaneMethod};
use spindrift::ode::{Control, Runs, System, Tolerance, integrate};
use spindrift::propagation::trajectory_recorder::{LaneTrajectory, TrajectoryRecorder};
use spindrift::run::{Grid, Outcome, Trajectory};

/// A right-hand side with `P` parameters; `arc` counts the arcs.
pub trait Law<const N: usize, const P: usize>: Copy {
    fn derivative<R: Real>(time: R, state: &[R; N], parameters: &[R; P], arc: R) -> [R; N];
}

/// One run: initial state, parameters, ends of its arcs.
#[derive(Clone)]
pub struct Case<const N: usize, const P: usize> {
    pub state: [f64; N],
    pub parameters: [f64; P],
    pub ends: Vec<f64>,
}

/// Runs of one law.
pub struct Bank<R, L, const N: usize, const P: usize> {
    _law: L,
    cases: Vec<Case<N, P>>,
    loaded: [usize; 8],
    parameters: [R; P],
    arc: R,
}

impl<R: Real, L: Law<N, P>, const N: usize, const P: usize> System<R, N> for Bank<R, L, N, P> {
    #[inline(always)]
    fn derivative(&self, time: R, state: &[R; N]) -> [R; N] {
        L::derivative(time, state, &self.parameters, self.arc)
    }

    #[inline(always)]
    fn error_ratio(&self, error: &[R; N], old: &[R; N], new: &[R; N], tolerance: Tolerance) -> R {
        let zero = error[0].zero();
        let threshold = zero.splat(tolerance.absolute / tolerance.relative);
        let mut largest = zero;
        for n in 0..N {
            largest = (error[n].abs() / old[n].abs().larger(new[n].abs()).larger(threshold)).larger(largest);
        }
        largest / zero.splat(tolerance.relative)
    }
}

impl<R: Real, L: Law<N, P>, const N: usize, const P: usize> Runs<R, N> for Bank<R, L, N, P> {
    fn count(&self) -> usize {
        self.cases.len()
    }
    fn load(&mut self, lane: usize, run: usize) -> [f64; N] {
        self.loaded[lane] = run;
        for (slot, value) in self.parameters.iter_mut().zip(self.cases[run].parameters) {
            slot.set_lane(lane, value);
        }
        self.cases[run].state
    }
    fn next_arc(&mut self, lane: usize, time: f64, _state: &[f64; N]) -> Option<f64> {
        let ends = &self.cases[self.loaded[lane]].ends;
        let arc = ends.iter().position(|end| *end > time)?;
        self.arc.set_lane(lane, arc as f64);
        Some(ends[arc])
    }
}

/// What became of a run.
#[derive(Clone)]
pub struct Journey<const N: usize> {
    pub points: Vec<[f64; N]>,
    pub outcome: Outcome,
}

#[inline(always)] // Else it is compiled without the instructions of the chosen set.
fn integrated<M, R, L, const N: usize, const P: usize>(
    (method, law): (M, L),
    zero: R,
    cases: &[Case<N, P>],
    grid: &Grid,
    control: &Control,
) -> Vec<Journey<N>>
where
    M: LaneMethod,
    R: Real,
    L: Law<N, P>,
{
    let mut bank = Bank { _law: law, cases: cases.to_vec(), loaded: [0; 8], parameters: [zero; P], arc: zero };
    let mut lanes = LaneTrajectory::for_lanes(R::LANES, N, grid.points());
    let mut journeys: Vec<Option<Journey<N>>> = vec![None; cases.len()];
    let finish = |bank: &Bank<R, L, N, P>, lane: usize, run: usize, trajectory: &Trajectory, outcome: &Outcome| {
        assert_eq!(bank.loaded[lane], run, "the lane still holds the run that is completed");
        let points = (0..trajectory.points()).map(|point| trajectory.at(point)).collect();
        let former = journeys[run].replace(Journey { points, outcome: *outcome });
        assert!(former.is_none(), "every run is completed once");
    };
    let mut recorder = TrajectoryRecorder::new(grid, &mut lanes, M::ERRORS, control.tolerance.relative, finish);
    integrate(method, zero, &mut bank, &mut recorder, control);
    journeys.into_iter().map(|journey| journey.expect("every run is completed")).collect()
}

pub fn scalar<M: LaneMethod, L: Law<N, P>, const N: usize, const P: usize>(
    method: M,
    law: L,
    cases: &[Case<N, P>],
    grid: &Grid,
    control: &Control,
) -> Vec<Journey<N>> {
    integrated((method, law), 0.0_f64, cases, grid, control)
}

pub fn control(tolerance: f64, step: f64) -> Control {
    Control {
        tolerance: Tolerance { relative: tolerance, absolute: tolerance },
        step: Some(step),
        max_steps: 1_000_000,
    }
}

/// y'' = -w^2 y with w the parameter.
#[derive(Clone, Copy)]
pub struct Oscillator;
impl Law<2, 1> for Oscillator {
    #[inline(always)]
    fn derivative<R: Real>(_time: R, y: &[R; 2], p: &[R; 1], _arc: R) -> [R; 2] {
        [p[0] * y[1], -(p[0] * y[0])]
    }
}

/// y'' = (1 - y^2) y' - y.
#[derive(Clone, Copy)]
pub struct VanDerPol;
impl Law<2, 0> for VanDerPol {
    #[inline(always)]
    fn derivative<R: Real>(_time: R, y: &[R; 2], _p: &[R; 0], _arc: R) -> [R; 2] {
        [y[1], (y[0].splat(1.0) - y[0] * y[0]) * y[1] - y[0]]
    }
}

/// y' = p.
#[derive(Clone, Copy)]
pub struct Slope;
impl Law<1, 1> for Slope {
    #[inline(always)]
    fn derivative<R: Real>(_time: R, _y: &[R; 1], p: &[R; 1], _arc: R) -> [R; 1] {
        *p
    }
}

/// y' = y^2: y(0) = 1 has a pole at t = 1.
#[derive(Clone, Copy)]
pub struct BlowUp;
impl Law<1, 0> for BlowUp {
    #[inline(always)]
    fn derivative<R: Real>(_time: R, y: &[R; 1], _p: &[R; 0], _arc: R) -> [R; 1] {
        [y[0] * y[0]]
    }
}

/// y' = sqrt(y): no number left of zero, and so none for y(0) < 0.
#[derive(Clone, Copy)]
pub struct NotANumber;
impl Law<1, 0> for NotANumber {
    #[inline(always)]
    fn derivative<R: Real>(_time: R, y: &[R; 1], _p: &[R; 0], _arc: R) -> [R; 1] {
        [y[0].sqrt()]
    }
}

/// y' = (s + 1) (3 t^2): in arc s, a quadrature whose right-hand side jumps at every boundary; it takes the absolute
/// time.
#[derive(Clone, Copy)]
pub struct Switched;
impl Law<1, 0> for Switched {
    #[inline(always)]
    fn derivative<R: Real>(time: R, _y: &[R; 1], _p: &[R; 0], arc: R) -> [R; 1] {
        [(arc + time.splat(1.0)) * (time.splat(3.0) * (time * time))]
    }
}
