//! [`OrbitPath`]: the point on an orbit at any time, in closed form about a point mass, by Taylor series about a
//! flattened body.
//!
//! Steps depend on the orbit alone and are kept, so that a time always gives the same bits. Each is the series of
//! `orbit_series` to order 22 over e^-2 of its radius of convergence (A. Jorba & M. Zou, Experimental Mathematics 14,
//! 2005).

use std::sync::{Arc, OnceLock};

use fearless_simd::Simd;

use super::gravity::Gravity;
use super::orbit::KeplerOrbit;
use super::orbit_series::OrbitSeries;
use super::orbit_state::OrbitState;
use crate::math::isa::{Isa, Work};
use crate::math::prelude::*;
use crate::math::sums::two_sum;
use crate::scene::Orbit;

/// Order of the series.
const ORDER: usize = 22;

/// Steps of the first block; each block has twice as many as the one before.
const FIRST_BLOCK: usize = 8;

/// Limit of blocks, beyond the steps of any run.
const MOST_BLOCKS: usize = 28;

/// The path of a point on an orbit.
#[derive(Clone, Debug)]
pub struct OrbitPath {
    /// The osculating two-body orbit at time zero.
    start: KeplerOrbit<f64>,
    /// Steps about a flattened body.
    steps: Option<Arc<Steps>>,
}

/// Steps about a flattened body in blocks, each computed on first use.
type Steps = [OnceLock<Box<[Step]>>; MOST_BLOCKS];

#[derive(Clone, Debug)]
struct Step {
    /// Start, a sum of two numbers, and length, s.
    time: [f64; 2],
    length: f64,
    /// Coefficients of the position, F_e, m, in s.
    coefficients: [[f64; 3]; ORDER + 2],
    /// Rounding errors of position and velocity at the start.
    low: [[f64; 3]; 2],
}

impl OrbitPath {
    /// The path of `orbit`.
    pub fn new(orbit: &Orbit) -> Self {
        let start = KeplerOrbit::new(orbit);
        OrbitPath { start, steps: no_steps(&start) }
    }

    /// Changes to `orbit`; an equal orbit keeps its steps.
    pub fn reset(&mut self, orbit: &Orbit) {
        let start = KeplerOrbit::new(orbit);
        let is_same = start.start() == self.start.start() && start.gravity() == self.start.gravity();
        if !is_same {
            self.steps = no_steps(&start);
        }
        self.start = start;
    }

    /// The gravity of the central body.
    pub fn gravity(&self) -> Gravity<f64> {
        self.start.gravity()
    }

    /// The osculating two-body orbit at time zero.
    pub fn at_start(&self) -> &KeplerOrbit<f64> {
        &self.start
    }

    /// The state at `time` >= 0, s.
    pub fn state(&self, time: f64) -> OrbitState<f64> {
        Isa::best().run(StateAt(self, [time, 0.0]))
    }

    /// [`OrbitPath::state`] at a sum of two numbers, by the instruction set of the caller.
    #[inline(always)]
    pub fn state_at(&self, time: [f64; 2]) -> OrbitState<f64> {
        let Some(steps) = &self.steps else { return self.start.state_at(time) };
        if !time[0].is_finite() {
            return OrbitState::unknown(0.0);
        }
        for index in 0..MOST_BLOCKS {
            let block = self.block(steps, index);
            let next = block.partition_point(|step| step.time[0] <= time[0]);
            let own = next.checked_sub(1).and_then(|index| block.get(index)).unwrap_or(&block[0]);
            if next < block.len() || own.within(time) <= own.length {
                return own.state_at(time);
            }
        }
        OrbitState::unknown(0.0)
    }

    /// Block `index`, computed after those before.
    #[inline(always)]
    fn block<'s>(&self, steps: &'s Steps, index: usize) -> &'s [Step] {
        steps[index].get_or_init(|| Isa::best().run(Block { path: self, steps, index }))
    }

    /// [`OrbitPath::state_at`] in all lanes.
    #[inline(always)]
    pub fn states_at<R: Real>(&self, time: [R; 2]) -> OrbitState<R> {
        match self.steps {
            None => self.start.in_lanes(time[0].zero()).state_at(time),
            Some(_) => {
                let mut states = OrbitState::unknown(time[0]);
                for lane in 0..R::LANES {
                    states.set_lane(lane, &self.state_at(time.map(|part| part.lane(lane))));
                }
                states
            }
        }
    }
}

/// [`OrbitPath::state_at`].
struct StateAt<'a>(&'a OrbitPath, [f64; 2]);

impl Work for StateAt<'_> {
    type Output = OrbitState<f64>;

    #[inline(always)]
    fn run<S: Simd>(self, _simd: S) -> OrbitState<f64> {
        self.0.state_at(self.1)
    }
}

/// Computation of a block of steps.
struct Block<'a> {
    path: &'a OrbitPath,
    steps: &'a Steps,
    index: usize,
}

impl Work for Block<'_> {
    type Output = Box<[Step]>;

    #[inline(always)]
    fn run<S: Simd>(self, _simd: S) -> Box<[Step]> {
        let Block { path: OrbitPath { start, .. }, steps, index } = self;
        let mut series = OrbitSeries::new(0.0, ORDER);
        let before = index.checked_sub(1).and_then(|before| steps[before].get()?.last());
        let mut next = before.map_or(([0.0; 2], start.start(), [[0.0; 3]; 2]), Step::end);
        let mut block = Vec::with_capacity(FIRST_BLOCK << index);
        for _ in 0..FIRST_BLOCK << index {
            let (time, state, low) = next;
            let step = Step::from(&mut series, start.gravity(), time, state, low);
            next = step.end();
            block.push(step);
        }
        block.into_boxed_slice()
    }
}

fn no_steps(start: &KeplerOrbit<f64>) -> Option<Arc<Steps>> {
    start.gravity().oblateness.map(|_| Arc::new([const { OnceLock::new() }; MOST_BLOCKS]))
}

impl Step {
    /// The step from `state` (position and velocity, F_e, m and m/s) at `time`, with rounding errors `low`.
    #[inline(always)]
    fn from(
        series: &mut OrbitSeries<f64>,
        gravity: Gravity<f64>,
        time: [f64; 2],
        [position, velocity]: [[f64; 3]; 2],
        low: [[f64; 3]; 2],
    ) -> Self {
        series.begin(gravity, position, velocity);
        (0..ORDER).for_each(|n| series.extend(n));
        let mut coefficients = [[0.0; 3]; ORDER + 2];
        coefficients.copy_from_slice(series.position());
        let distance = norm(position);
        let length = [ORDER, ORDER + 1]
            .into_iter()
            .fold(f64::INFINITY, |shortest: f64, n| shortest.min(step_length(n, distance, coefficients[n])));
        Step { time, length, coefficients, low }
    }

    /// Its end: time, state and rounding errors.
    #[inline(always)]
    fn end(&self) -> End {
        end_of_step(&self.coefficients, self.low, self.time, self.length)
    }

    #[inline(always)]
    fn within(&self, [time, low]: [f64; 2]) -> f64 {
        (time - self.time[0]) + (low - self.time[1])
    }

    #[inline(always)]
    fn state_at(&self, time: [f64; 2]) -> OrbitState<f64> {
        let [position, velocity] = state_within(&self.coefficients, self.low, self.within(time));
        OrbitState { position, velocity, distance: norm(position) }
    }
}

/// End of a step: time, state and its rounding errors.
type End = ([f64; 2], [[f64; 3]; 2], [[f64; 3]; 2]);

/// End of the step of `length` seconds from `time` with the rounding errors `low`.
#[inline(always)]
pub(super) fn end_of_step(coefficients: &[[f64; 3]], mut low: [[f64; 3]; 2], time: [f64; 2], length: f64) -> End {
    let changes = change(coefficients, low[1], length);
    let mut state = [coefficients[0], coefficients[1]];
    for ((state, change), low) in state.iter_mut().zip(changes).zip(&mut low) {
        for i in 0..3 {
            (state[i], low[i]) = two_sum(state[i], change[i] + low[i]);
        }
    }
    let (time, rest) = two_sum(time[0], length + time[1]);
    ([time, rest], state, low)
}

/// Position and velocity `within` seconds after the start of a step with the rounding errors `low`.
#[inline(always)]
pub(super) fn state_within(coefficients: &[[f64; 3]], low: [[f64; 3]; 2], within: f64) -> [[f64; 3]; 2] {
    let [position, velocity] = change(coefficients, low[1], within);
    [sum(coefficients[0], sum(position, low[0])), sum(coefficients[1], sum(velocity, low[1]))]
}

/// Change of position and velocity until `within` seconds after the start of a step; `low` is the velocity's rounding
/// error.
#[inline(always)]
fn change(coefficients: &[[f64; 3]], low: [f64; 3], within: f64) -> [[f64; 3]; 2] {
    let (mut position, mut velocity) = ([0.0_f64; 3], [0.0_f64; 3]);
    for (n, coefficients) in coefficients.iter().enumerate().skip(2).rev() {
        for i in 0..3 {
            position[i] = position[i].mul_add(within, coefficients[i]);
            velocity[i] = velocity[i].mul_add(within, n as f64 * coefficients[i]);
        }
    }
    let position = scaled(within, sum(coefficients[1], sum(low, scaled(within, position))));
    [position, scaled(within, velocity)]
}

/// Step that the coefficient `term` of order `n` allows a quantity of size `size`: e^-2 of the radius of convergence.
pub(super) fn step_length(n: usize, size: f64, term: [f64; 3]) -> f64 {
    let term = norm(term);
    let radius = if term > 0.0 { libm::pow(size / term, 1.0 / n as f64) } else { f64::INFINITY };
    libm::exp(-2.0) * radius
}

/// Paths, one run per lane.
#[derive(Clone, Debug)]
pub struct PathsInLanes<R> {
    start: KeplerOrbit<R>,
    /// Paths about flattened bodies.
    oblate: [Option<OrbitPath>; WIDEST],
    has_oblate: bool,
    /// True if a path is about a point mass.
    has_others: bool,
}

impl<R: Real> PathsInLanes<R> {
    /// Arbitrary circles for empty lanes.
    pub fn blank(zero: R) -> Self {
        PathsInLanes {
            start: KeplerOrbit::blank().in_lanes(zero),
            oblate: [const { None }; WIDEST],
            has_oblate: false,
            has_others: false,
        }
    }

    /// Copies a path into a lane.
    pub fn set_lane(&mut self, lane: usize, path: &OrbitPath) {
        self.start.set_lane(lane, &path.start);
        self.oblate[lane] = path.steps.is_some().then(|| path.clone());
        self.has_oblate = self.oblate.iter().any(Option::is_some);
        self.has_others |= path.steps.is_none();
    }

    /// The gravity of the central bodies.
    #[inline(always)]
    pub fn gravity(&self) -> Gravity<R> {
        self.start.gravity()
    }

    /// One in lanes whose two-body orbit is a circle, else zero.
    #[inline(always)]
    pub fn circle(&self) -> R {
        self.start.circle()
    }

    /// [`OrbitPath::state_at`] in all lanes.
    #[inline(always)]
    pub fn state_at(&self, time: [R; 2]) -> OrbitState<R> {
        let mut states = match self.has_others {
            true => self.start.state_at(time),
            // empty lanes
            false => OrbitState::at_rest(self.start.start()[0]),
        };
        if self.has_oblate {
            for lane in 0..R::LANES {
                if let Some(path) = &self.oblate[lane] {
                    states.set_lane(lane, &path.state_at(time.map(|part| part.lane(lane))));
                }
            }
        }
        states
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn oblate(velocity: [f64; 3]) -> Orbit {
        Orbit {
            mu: 3.986004418e14,
            position: [7e6, 1e6, -2e5],
            velocity,
            body_radius: 6_378_137.0,
            j2: Some(1.08262668e-3),
            epoch: None,
        }
    }

    /// Law: a path is a function of time alone, also after it was another one.
    #[test]
    fn the_path_is_a_function_of_the_time() {
        let orbit = oblate([100.0, 7100.0, 2900.0]);
        let (late_first, early_first) = (OrbitPath::new(&orbit), OrbitPath::new(&orbit));
        let times = [0.0, 17.0, 2_999.0, 39_999.0, 400_000.0];
        let late: Vec<_> = times.iter().rev().map(|time| late_first.state(*time)).collect();
        let early: Vec<_> = times.iter().map(|time| early_first.state(*time)).collect();
        assert!(late.iter().rev().eq(early.iter()) && early.iter().all(|state| state.distance.is_finite()));
        assert!(late_first.state(f64::NAN).distance.is_nan());
        let mut path = late_first.clone();
        path.reset(&orbit);
        assert_eq!(path.state(17.0), late_first.state(17.0));
        path.reset(&oblate([100.0, 7100.5, 2900.0]));
        assert_ne!(path.state(17.0), late_first.state(17.0));
    }
}
