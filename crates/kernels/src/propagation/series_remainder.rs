//! [`Remainders`]: errors of methods without an error estimate, from the Taylor series of the motion.

use super::local_error::{rounding, rounding_of_turns};
use super::taylor::jet::{Reciprocals, Scratch, expand};
use crate::dynamics::effects::ChangingSeries;
use crate::dynamics::gyrostat::equations::Constants;
use crate::dynamics::gyrostat::{ATTITUDE, Gyrostat, IMPULSE, IMPULSE_INTEGRAL, OMEGA, WITH_ATTITUDE, WITH_THRUST};
use crate::math::vector::{scaled, sum, three};
use crate::ode::Remainder;
use crate::run::{Grid, LocalErrors, Outcome, Trajectory};

/// Most points of a run at which the series is expanded.
const EXPANSIONS: usize = 16;

const N: usize = WITH_ATTITUDE;

#[derive(Clone, Debug)]
pub struct Remainders {
    method: Remainder,
    reciprocals: Reciprocals<f64>,
    scratch: Box<Scratch<f64>>,
    jet: Vec<[f64; N]>,
    effects: Option<Box<ChangingSeries<f64>>>,
}

impl Remainders {
    pub fn new(method: Remainder) -> Self {
        Remainders {
            method,
            reciprocals: Reciprocals::new(0.0, method.order + 1),
            scratch: Box::new(Scratch::new(0.0)),
            jet: vec![[0.0; N]; method.order + 2],
            effects: None,
        }
    }

    /// Error sums of a run of equal steps, from the series at some observation points.
    pub fn sum(&mut self, run: &Gyrostat<f64>, states: &Trajectory, grid: &Grid, outcome: &Outcome) -> LocalErrors {
        let (points, steps) = (outcome.points, outcome.effort.steps);
        if points == 0 || steps == 0 {
            return rounding(steps);
        }
        let step = outcome.time / steps as f64;
        let stride = points.div_ceil(EXPANSIONS);
        let (mut turning, mut changing, mut count, mut largest) = (0.0, 0.0, 0.0, 0.0_f64);
        for point in (0..points).step_by(stride) {
            self.expand(run, grid.times()[point], states, point);
            let [state, .., next] = &self.jet[..] else { return rounding(steps) };
            let size = |v: &[f64]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
            largest = largest.max(size(&state[OMEGA..OMEGA + 3]));
            turning += 2.0 * size(&next[ATTITUDE..ATTITUDE + 4]);
            changing += size(&next[OMEGA..OMEGA + 3]);
            count += 1.0;
        }
        let term = libm::pow(step, self.method.order as f64 + 1.0);
        let all = self.method.factor * term * steps as f64 / count;
        let errors = rounding_of_turns(steps, largest * outcome.time);
        LocalErrors { truncation: all * changing, attitude: errors.attitude + all * turning, ..errors }
    }

    /// Expands the motion through point `point` of `states` at `time`, s; thrust does not bend the orbit within a step.
    fn expand(&mut self, run: &Gyrostat<f64>, time: f64, states: &Trajectory, point: usize) {
        let arc = run.arc_index_at(time);
        let mut constants = Constants::of(run, arc, 1.0);
        let since = time - run.arcs[arc].arc.start;
        constants.momentum = sum(constants.momentum, scaled(since, constants.momentum_rate));
        self.jet[0] = states.at::<N>(point);
        let order = self.method.order + 1;
        let effects = (!run.effects.is_empty()).then(|| {
            let series = self.effects.get_or_insert_with(|| Box::new(ChangingSeries::new(0.0, order)));
            let place = run.orbit.as_ref().map(|orbit| {
                let mut place = orbit.state(time);
                if run.offset.is_some() {
                    let all = states.at::<WITH_THRUST>(point);
                    let offset = [IMPULSE_INTEGRAL, IMPULSE].map(|first| scaled(1.0 / run.mass, three(&all, first)));
                    place = place.displaced(offset);
                }
                (orbit.gravity(), place)
            });
            let mut acting = run.effects;
            acting.begin_arc(|| run.rods_b(&run.arcs[arc].arc));
            series.begin(&acting, place.as_ref(), false, time, 1.0);
            &mut **series
        });
        expand::<f64, N, true>(&constants, &self.reciprocals, order, &mut self.scratch, effects, &mut self.jet);
    }
}
