//! Observation points: of all lanes during a step, and one by one from kept series.

use super::dense::{Segment, value_at, values};
use super::jet::turn_impulse;
use super::lane_state::SeriesLane;
use super::lane_vectors::si_factors;
use super::series_ring::SeriesRing;
use super::thrust::{Push, Quadrature};
use crate::dynamics::gyrostat::equations::Constants;
use crate::dynamics::gyrostat::{ANGLE, ANGULAR_IMPULSE, ATTITUDE, WITH_THRUST};
use crate::math::prelude::*;
use crate::run::{Grid, Trajectory};

pub struct TakenStep<R, const N: usize> {
    pub constants: Constants<R>,
    /// The state at its start.
    pub begin: [R; N],
    /// The order of its series.
    pub order: usize,
    /// Its length, units.
    pub length: R,
    /// Increments by thrust over the step.
    pub push: Push<R>,
}

pub struct StepSeries<'a, R, const N: usize, const J: usize> {
    pub segment: &'a Segment<R, J>,
    pub step: &'a TakenStep<R, N>,
    pub quadrature: &'a mut Quadrature<R>,
    pub per_unit: R,
}

impl<R: Real, const N: usize, const J: usize> StepSeries<'_, R, N, J> {
    /// Components at the times `at` since the start of the arc, SI, by lane; quadrature states only with `FORCED`.
    #[inline(always)]
    pub fn components<const FORCED: bool>(&mut self, at: R, due: R::Mask) -> [[f64; WIDEST]; N] {
        let zero = at.zero();
        let StepSeries { segment, step, .. } = *self;
        let TakenStep { constants, begin, order, length, push } = step;
        let jet = &segment.jet[..=*order];
        let x = R::select(due, (at - segment.start) - segment.start_low, zero);
        let [mut found] = values(jet, [x]);
        if FORCED && N >= WITH_THRUST && N == J {
            // effects act
            turn_impulse(four(&found, ATTITUDE), &mut found);
            for i in ANGULAR_IMPULSE..ANGULAR_IMPULSE + 3 {
                found[i] += begin[i];
            }
        }
        let mut all = [zero; N];
        all[..J].copy_from_slice(&found);
        if FORCED {
            let mut turned = three(&found, ANGLE);
            for i in 0..3 {
                turned[i] -= jet[0][ANGLE + i];
            }
            let push =
                if N < WITH_THRUST || N == J { *push } else { self.quadrature.until(constants, jet, *length, push, x) };
            let growth = push.growth(constants, begin, turned, x);
            for i in J..N {
                all[i] = begin[i] + growth[i];
            }
        }
        let factors = si_factors::<R, N>(self.per_unit);
        let mut rows = [[0.0; WIDEST]; N];
        for i in 0..N {
            (all[i] * factors[i]).write(&mut rows[i]);
        }
        rows
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Until {
    EndOfArc,
    /// Before this time since the start of the arc, units.
    Time(f64),
}

/// Evaluates the points of an arc without actuation one by one from the kept series.
#[cold]
#[inline(never)]
pub fn evaluate_kept<R: Real, const N: usize, const J: usize>(
    state: &mut SeriesLane,
    lane: usize,
    ring: &SeriesRing<R, J>,
    grid: &Grid,
    trajectory: &mut Trajectory,
    until: Until,
) {
    let mut step = state.begun;
    while let Some(time) = grid.times().get(state.point) {
        let local = (time - state.start) / state.unit;
        let is_beyond = match until {
            Until::EndOfArc => !state.is_last && *time > state.end,
            Until::Time(reached) => local >= reached,
        };
        if is_beyond {
            break;
        }
        while step + 1 < ring.clock && ring.segment(step + 1).start.lane(lane) <= local {
            step += 1;
        }
        let segment = ring.segment(step);
        let x = (local - segment.start.lane(lane)) - segment.start_low.lane(lane);
        let factors = si_factors::<f64, N>(1.0 / state.unit);
        for i in 0..J {
            trajectory.column_mut(i)[state.point] = value_at(&segment.jet, i, lane, x) * factors[i];
        }
        let quadratures = state.quadratures_after::<N, J>(local);
        for i in J..N {
            trajectory.column_mut(i)[state.point] = quadratures[i - J] * factors[i];
        }
        state.point += 1;
    }
}
