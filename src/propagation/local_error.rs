//! What errors a method reckons to have made on its way: the sum behind [`LocalErrors`].
//!
//! Relative errors of the rotational state (of omega over |omega|, of the attitude in rad), step by step, added up as if they
//! all pointed the same way; plus rounding, which walks at random (H. Brouwer, Astron. J. 46, 1937).

use super::taylor::jet::{Reciprocals, Scratch, expand};
use crate::dynamics::gyrostat::equations::Constants;
use crate::dynamics::gyrostat::{ATTITUDE, Gyrostat, OMEGA, WITH_ATTITUDE};
use crate::math::vector::{scaled, sum};
use crate::run::{Grid, Trajectory};
use crate::run::{LocalErrors, Outcome};

/// Error model of a method that estimates the error of each step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepErrors {
    /// Factor between estimate and error at a tolerance of one.
    pub factor: f64,
    /// One over the order of the estimate plus one: the step is carried on with a formula of one order more than the estimate is of
    /// (local extrapolation), so that its error is smaller by the step, and that is the tolerance to this power.
    pub extrapolation: f64,
    /// Error of dense output in units of the tolerance; steps that follow do not start from it.
    pub dense: f64,
    /// Whether errors of other states feed back into omega.
    pub feeds_back: bool,
}

impl StepErrors {
    /// The sums for steps whose estimates add up to `ratios` tolerances.
    pub fn sum(&self, ratios: f64, tolerance: f64, steps: u64) -> LocalErrors {
        let error = self.factor * libm::pow(tolerance, self.extrapolation) * tolerance * ratios;
        let LocalErrors { rounding, attitude, .. } = rounding(steps);
        LocalErrors {
            truncation: error,
            rounding,
            feedback: if self.feeds_back { error } else { 0.0 },
            attitude: attitude + error + self.dense * tolerance,
        }
    }
}

/// Share of a rounding by which a compensated step errs: measured over the campaigns of `tests/error_estimate.rs`.
const WALK: f64 = 0.15;

/// Rounding of constants and states, and of the sum over `steps` compensated steps.
pub fn rounding(steps: u64) -> LocalErrors {
    rounding_of_turns(steps, f64::INFINITY)
}

/// The same where the steps together turn by `angle`, rad: what is rounded is the change over a step.
fn rounding_of_turns(steps: u64, angle: f64) -> LocalErrors {
    let steps = steps as f64;
    let share = if angle < steps { angle / steps } else { 1.0 };
    let walked = f64::EPSILON * (1.0 + WALK * share * steps.sqrt());
    LocalErrors { rounding: walked, attitude: walked, ..LocalErrors::default() }
}

/// Error model of a method that takes the steps it is told: the first term that its steps leave out of the motion's own series.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Remainder {
    /// Order of the method.
    pub order: usize,
    /// The error of a step over the term of order + 1 of the solution's series at its start.
    pub factor: f64,
}

/// Points of a run at which the series is expanded, at most.
const EXPANSIONS: usize = 16;

/// Components: rate and attitude.
const N: usize = WITH_ATTITUDE;

/// A [`Remainder`] with the memory to evaluate it.
#[derive(Clone, Debug)]
pub struct Remainders {
    method: Remainder,
    reciprocals: Reciprocals<f64>,
    scratch: Box<Scratch<f64>>,
    jet: Vec<[f64; N]>,
}

impl Remainders {
    /// Memory for runs by a method.
    pub fn new(method: Remainder) -> Self {
        Remainders {
            method,
            reciprocals: Reciprocals::new(0.0, method.order + 1),
            scratch: Box::new(Scratch::new(0.0)),
            jet: vec![[0.0; N]; method.order + 2],
        }
    }

    /// The sums for a run of equal steps, from the series at up to sixteen of its observation points.
    pub fn sum(&mut self, run: &Gyrostat<f64>, states: &Trajectory, grid: &Grid, outcome: &Outcome) -> LocalErrors {
        let (points, steps) = (outcome.points, outcome.effort.steps);
        if points == 0 || steps == 0 {
            return rounding(steps);
        }
        let step = outcome.time / steps as f64;
        let stride = points.div_ceil(EXPANSIONS);
        let (mut turning, mut changing, mut count, mut largest) = (0.0, 0.0, 0.0, 0.0_f64);
        for point in (0..points).step_by(stride) {
            self.expand(run, grid.times()[point], states.at::<N>(point));
            let [state, .., next] = &self.jet[..] else { return rounding(steps) };
            let size = |v: &[f64]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
            largest = largest.max(size(&state[OMEGA..OMEGA + 3]));
            turning += 2.0 * size(&next[ATTITUDE..ATTITUDE + 4]);
            changing += size(&next[OMEGA..OMEGA + 3]);
            count += 1.0;
        }
        let term = libm::pow(step, self.method.order as f64 + 1.0);
        let all = self.method.factor * term * steps as f64 / count;
        let LocalErrors { rounding, attitude, .. } = rounding_of_turns(steps, largest * outcome.time);
        let truncation = if largest > 0.0 { all * changing / largest } else { 0.0 };
        LocalErrors { truncation, rounding, feedback: 0.0, attitude: attitude + all * turning }
    }

    /// The series of the motion through `state` at `time`, in seconds.
    fn expand(&mut self, run: &Gyrostat<f64>, time: f64, state: [f64; N]) {
        let arc = run.arc_index_at(time);
        let mut constants = Constants::of(run, arc, 1.0);
        let since = time - run.arcs[arc].arc.start;
        constants.momentum = sum(constants.momentum, scaled(since, constants.momentum_rate));
        self.jet[0] = state;
        let order = self.method.order + 1;
        expand::<f64, N, true>(&constants, &self.reciprocals, order, &mut self.scratch, &mut self.jet);
    }
}
