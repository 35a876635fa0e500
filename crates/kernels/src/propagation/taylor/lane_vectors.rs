//! [`LaneVectors`]: operands of every step, all lanes together.

use crate::dynamics::gyrostat::equations::Constants;
use crate::dynamics::gyrostat::{ANGULAR_IMPULSE, IMPULSE, MOTOR_WORK, OMEGA, THRUST_WORK, WITH_MOTORS, WITH_THRUST};
use crate::math::Real;
use crate::math::vector::{lane_of, three};

/// State, time and arc constants of the lanes, in their units of time.
#[derive(Clone, Copy, Debug)]
pub struct LaneVectors<R, const N: usize> {
    pub constants: Constants<R>,
    /// Integrated components, an unevaluated sum with `state_low`.
    pub state: [R; N],
    pub state_low: [R; N],
    /// Time since the start of the arc, units, an unevaluated sum.
    pub time: R,
    pub time_low: R,
    /// Length of the arc, units; infinite if the lane is empty or waits.
    pub length: R,
    /// Next observation point of the arc, units; infinite if there is none, or during the search for a return.
    pub next_point: R,
    /// 1/unit of time, 1/s.
    pub per_unit: R,
    /// One if the arc may be flown in one step of lower order, else zero.
    pub may_be_brief: R,
}

impl<R: Real, const N: usize> LaneVectors<R, N> {
    pub fn new(zero: R) -> Self {
        LaneVectors {
            constants: Constants::zero(zero),
            state: [zero; N],
            state_low: [zero; N],
            time: zero,
            time_low: zero,
            length: zero,
            next_point: zero,
            per_unit: zero,
            may_be_brief: zero,
        }
    }

    pub fn set_state(&mut self, lane: usize, state: &[f64; N]) {
        for (i, component) in state.iter().enumerate() {
            self.state[i].set_lane(lane, *component);
            self.state_low[i].set_lane(lane, 0.0);
        }
    }

    /// Makes an empty or waiting lane step on without an end.
    pub fn idle(&mut self, lane: usize) {
        self.length.set_lane(lane, f64::INFINITY);
        self.next_point.set_lane(lane, f64::INFINITY);
        self.may_be_brief.set_lane(lane, 0.0);
    }

    #[inline(always)]
    pub fn omega(&self, lane: usize) -> [f64; 3] {
        lane_of(&three(&self.state, OMEGA), lane)
    }

    /// Components in `lane`, SI; zero if not integrated.
    pub fn components(&self, lane: usize) -> [f64; WITH_THRUST] {
        let factors = si_factors::<f64, N>(self.per_unit.lane(lane));
        let mut components = [0.0; WITH_THRUST];
        for (i, factor) in factors.into_iter().enumerate() {
            components[i] = self.state[i].lane(lane) * factor;
        }
        components
    }

    /// Changes the unit of time in `lane` from `old` to `new` seconds, both powers of two: exact.
    pub fn rescale(&mut self, lane: usize, old: f64, new: f64) {
        let (from, to) = (si_factors::<f64, N>(1.0 / old), si_factors::<f64, N>(1.0 / new));
        for i in 0..N {
            let factor = from[i] / to[i];
            self.state[i].set_lane(lane, self.state[i].lane(lane) * factor);
            self.state_low[i].set_lane(lane, self.state_low[i].lane(lane) * factor);
        }
    }
}

/// Factors from the lane's unit of time to SI, given 1/unit.
#[inline(always)]
pub fn si_factors<R: Real, const N: usize>(per_unit: R) -> [R; N] {
    let mut factors = [per_unit.splat(1.0); N];
    factors[OMEGA..OMEGA + 3].fill(per_unit);
    if N >= WITH_MOTORS {
        factors[MOTOR_WORK] = per_unit * per_unit;
    }
    if N >= WITH_THRUST {
        factors[IMPULSE..IMPULSE + 3].fill(per_unit);
        factors[ANGULAR_IMPULSE..ANGULAR_IMPULSE + 3].fill(per_unit);
        factors[THRUST_WORK] = per_unit * per_unit;
    }
    factors
}
