//! Textbook problems as runs in lanes, integrated as scalars or in lanes.

#![allow(dead_code)] // Every test file uses its own part.

use fearless_simd::Simd;
pub use spindrift::ode::{Adaptive, Fixed, LaneMethod};
use spindrift::{
    math::{Isa, Lanes, Real, isa::Work},
    ode::{
        explicit::Step,
        switches::{beside, dip},
    },
};
use spindrift::{
    ode::{Control, Dop853, DormandPrince, GaussLegendre, RungeKutta4, Runs, System, Tolerance, integrate},
    propagation::trajectory_recorder::{LaneTrajectory, TrajectoryRecorder},
    run::{Grid, Outcome, Trajectory},
};

/// A right-hand side with `P` parameters; `arc` counts the arcs, and of a law with a switch it is its side, 1 or -1.
pub trait Law<const N: usize, const P: usize>: Copy {
    /// True if it has a switch.
    const SWITCHES: bool = false;

    fn derivative<R: Real>(time: R, state: &[R; N], parameters: &[R; P], arc: R) -> [R; N];

    /// The switch function.
    #[inline(always)]
    fn switch<R: Real>(time: R, _state: &[R; N], _parameters: &[R; P]) -> R {
        time.zero()
    }
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
    law: L,
    cases: Vec<Case<N, P>>,
    loaded: [usize; 8],
    parameters: [R; P],
    arc: R,
    side: R,
}

impl<R: Real, L: Law<N, P>, const N: usize, const P: usize> System<R, N> for Bank<R, L, N, P> {
    #[inline(always)]
    fn derivative(&self, time: R, state: &[R; N]) -> [R; N] {
        L::derivative(time, state, &self.parameters, if L::SWITCHES { self.side } else { self.arc })
    }

    #[inline(always)]
    fn has_switches(&self) -> bool {
        L::SWITCHES
    }

    #[inline(always)]
    fn margin(&self, time: R, state: &[R; N]) -> R {
        self.side * L::switch(time, state, &self.parameters)
    }

    #[inline(always)]
    fn dip(&self, step: Step<R>, ends: [[&[R; N]; 2]; 2]) -> R {
        let (times, [after, before]) = beside(step, ends);
        let states = [ends[0][0], &after, &before, ends[1][0]];
        dip([0, 1, 2, 3].map(|k| self.margin(times[k], states[k])))
    }

    /// ode45: max |e_i| / max(|y_i|, |y'_i|, atol/rtol) / rtol.
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

    #[inline(always)]
    fn choose_branches(&mut self, lanes: R::Mask, time: R, state: &[R; N]) {
        let (zero, one) = (time.zero(), time.splat(1.0));
        self.side =
            R::select(lanes, R::select(zero.lt(L::switch(time, state, &self.parameters)), one, -one), self.side);
    }
}

/// What became of a run.
#[derive(Clone)]
pub struct Journey<const N: usize> {
    pub points: Vec<[f64; N]>,
    pub outcome: Outcome,
}

impl<const N: usize> Journey<N> {
    pub fn bits(&self) -> (Vec<[u64; N]>, Outcome) {
        (self.points.iter().map(|point| point.map(f64::to_bits)).collect(), self.outcome)
    }
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
    let mut bank = Bank { law, cases: cases.to_vec(), loaded: [0; 8], parameters: [zero; P], arc: zero, side: zero };
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

/// Integrates all cases one by one.
pub fn scalar<M: LaneMethod, L: Law<N, P>, const N: usize, const P: usize>(
    method: M,
    law: L,
    cases: &[Case<N, P>],
    grid: &Grid,
    control: &Control,
) -> Vec<Journey<N>> {
    integrated((method, law), 0.0_f64, cases, grid, control)
}

/// One case by every Runge-Kutta method: those with an error estimate first.
pub fn by_every_method<L: Law<N, P>, const N: usize, const P: usize>(
    law: L,
    case: Case<N, P>,
    grid: &Grid,
    control: &Control,
) -> [(&'static str, Journey<N>); 4] {
    let case = &[case];
    [
        ("Dormand-Prince", scalar(Adaptive(DormandPrince), law, case, grid, control).remove(0)),
        ("DOP853", scalar(Adaptive(Dop853), law, case, grid, control).remove(0)),
        ("Runge-Kutta 4", scalar(Fixed(RungeKutta4), law, case, grid, control).remove(0)),
        ("Gauss-Legendre", scalar(Fixed(GaussLegendre), law, case, grid, control).remove(0)),
    ]
}

/// Integrates all cases in lanes.
pub fn lanes<M: LaneMethod, L: Law<N, P>, const N: usize, const P: usize>(
    isa: Isa,
    method: M,
    law: L,
    cases: &[Case<N, P>],
    grid: &Grid,
    control: &Control,
) -> Vec<Journey<N>> {
    struct Integration<'a, M, L, const N: usize, const P: usize>(M, L, &'a [Case<N, P>], &'a Grid, &'a Control);
    impl<M: LaneMethod, L: Law<N, P>, const N: usize, const P: usize> Work for Integration<'_, M, L, N, P> {
        type Output = Vec<Journey<N>>;
        #[inline(always)]
        fn run<S: Simd>(self, simd: S) -> Vec<Journey<N>> {
            integrated((self.0, self.1), Lanes::broadcast(simd, 0.0), self.2, self.3, self.4)
        }
    }
    isa.run(Integration(method, law, cases, grid, control))
}

/// A control with equal relative and absolute tolerance.
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

/// A spring on each side of zero: y'' = -w^2 y above, and -4 w^2 y below, with w the parameter.
#[derive(Clone, Copy)]
pub struct TwoSprings;
impl Law<2, 1> for TwoSprings {
    const SWITCHES: bool = true;

    #[inline(always)]
    fn derivative<R: Real>(time: R, y: &[R; 2], p: &[R; 1], side: R) -> [R; 2] {
        let rate = R::select(time.zero().lt(side), p[0], p[0] + p[0]);
        [y[1], -(rate * rate * y[0])]
    }

    #[inline(always)]
    fn switch<R: Real>(_time: R, y: &[R; 2], _p: &[R; 1]) -> R {
        y[0]
    }
}

/// A rate while a function of time, number p of [`GATES`], is above zero: one, or the function itself for `p` < 1,
/// which is then cos t - (1 - p). A cosine in parallel sets the length of the steps. For scalars.
#[derive(Clone, Copy)]
pub struct Gated;

/// A function of time, s.
pub type OfTime = fn(f64) -> f64;

/// Difficult switch functions: zero to rounding, touches zero, has a kink, steep, always wrong; and the most steps over
/// 20 s.
pub const GATES: [(OfTime, u64); 5] = [
    (|t| 1e-15 * (1e5 * t).sin(), 100),
    (|t| 1.0 - t.cos(), 200),
    (|t| (t - 3.0).abs() - 1e-9, 200),
    (|t| 1e6 * t.sin(), 500),
    (|t| if t == 0.0 { 1.0 } else { (1e3 * t).sin() }, 40_000),
];

impl Law<2, 1> for Gated {
    const SWITCHES: bool = true;

    fn derivative<R: Real>(time: R, y: &[R; 2], p: &[R; 1], side: R) -> [R; 2] {
        let is_pulse = p[0].lane(0) < 1.0;
        let rate = if is_pulse { Self::switch(time, y, p) } else { time.splat(1.0) };
        [R::select(time.zero().lt(side), rate, time.zero()), time.splat(time.lane(0).cos())]
    }

    fn switch<R: Real>(time: R, _y: &[R; 2], p: &[R; 1]) -> R {
        let (t, p) = (time.lane(0), p[0].lane(0));
        time.splat(if p < 1.0 { t.cos() - (1.0 - p) } else { GATES[p as usize - 1].0(t) })
    }
}

/// Euler's equations of the free rigid body with the moments of inertia as parameters (Hairer, Lubich & Wanner 2006,
/// IV.1.3).
#[derive(Clone, Copy)]
pub struct RigidBody;
impl Law<3, 3> for RigidBody {
    #[inline(always)]
    fn derivative<R: Real>(_time: R, y: &[R; 3], i: &[R; 3], _arc: R) -> [R; 3] {
        let w = [y[0] / i[0], y[1] / i[1], y[2] / i[2]];
        spindrift::math::vector::cross(*y, w)
    }
}

/// Hairer, Lubich & Wanner 2006, section IV.1 (example 1.7).
pub const RIGID_BODY: ([f64; 3], [f64; 3]) = ([0.899_3, 0.0, 0.437_4], [2.0, 1.0, 2.0 / 3.0]);

/// The restricted three-body problem (Hairer, Norsett & Wanner 1993, (0.1)) with the smaller mass as the parameter.
#[derive(Clone, Copy)]
pub struct ThreeBody;
impl Law<4, 1> for ThreeBody {
    #[inline(always)]
    fn derivative<R: Real>(_time: R, y: &[R; 4], p: &[R; 1], _arc: R) -> [R; 4] {
        let [x, z, u, v] = *y;
        let (mu, nu) = (p[0], x.splat(1.0) - p[0]);
        let (a, b) = (nu / cube(x + mu, z), mu / cube(x - nu, z));
        let two = x.splat(2.0);
        [u, v, x + two * v - a * (x + mu) - b * (x - nu), z - two * u - a * z - b * z]
    }
}

/// The cube of the distance (x, z).
#[inline(always)]
fn cube<R: Real>(x: R, z: R) -> R {
    let square = x.mul_add(x, z * z);
    square * square.sqrt()
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
