//! [`FinishedRun`]: values of a run not reduced from a series.

use super::conditioning::ErrorEstimate;
use super::exchange::Exchange;
use super::table::DirectValue;
use crate::math::symmetric::principal_axes;
use crate::run::{Outcome, StateField, StateTable};
use crate::scene::MassProperties;

/// Error of the rotational state, rad or relative to the rate, by rounding of the input above which a run is ill
/// conditioned.
const MEANINGLESS: f64 = 1e-3;

pub struct FinishedRun<'a> {
    pub table: &'a StateTable,
    pub outcome: &'a Outcome,
    pub time_reached: f64,
    pub filled: usize,
    pub times: &'a [f64],
    /// Last point with finite rotational states; `None` if the final state is not observed.
    pub final_point: Option<usize>,
    pub exchange: Exchange,
    pub estimate: ErrorEstimate,
    pub debris_estimate: ErrorEstimate,
    pub mass: &'a MassProperties,
    pub moments: [f64; 3],
}

/// Principal moments of inertia about the centre of mass with locked wheels, ascending, kg m^2.
pub fn principal_moments(mass: &MassProperties) -> [f64; 3] {
    let (mut moments, _) = principal_axes(mass.inertia);
    moments.sort_by(f64::total_cmp);
    moments
}

/// Last of the first `filled` points of `table` with finite rotational states.
pub fn final_point(table: &StateTable, filled: usize) -> Option<usize> {
    let finite = |point: &usize| {
        table.at::<3>(StateField::Rate, *point).iter().all(|x| x.is_finite())
            && table.at::<4>(StateField::Attitude, *point).iter().all(|x| x.is_finite())
            && (0..table.wheels()).all(|wheel| table.column(StateField::WheelRates, wheel)[*point].is_finite())
    };
    (0..filled).rev().find(finite)
}

/// 1 if rounding of the input alone may change the result, else 0.
fn is_ill_conditioned(estimate: &ErrorEstimate) -> f64 {
    f64::from(u8::from(estimate.amplification * f64::EPSILON > MEANINGLESS))
}

impl FinishedRun<'_> {
    #[inline]
    pub fn value(&self, value: DirectValue, wheel: usize) -> f64 {
        use DirectValue::*;
        match value {
            WorkThrusters => self.last(StateField::Work, 0),
            WorkMotors => self.last(StateField::Work, 1),
            Correlation => self.exchange.correlations[wheel],
            ExchangeFrequency => self.exchange.frequency,
            TimeReached => self.time_reached,
            TimeFinal => self.final_point.map_or(f64::NAN, |point| self.times[point]),
            AttitudeW => self.final_state(StateField::Attitude, 0),
            AttitudeX => self.final_state(StateField::Attitude, 1),
            AttitudeY => self.final_state(StateField::Attitude, 2),
            AttitudeZ => self.final_state(StateField::Attitude, 3),
            RateX => self.final_state(StateField::Rate, 0),
            RateY => self.final_state(StateField::Rate, 1),
            RateZ => self.final_state(StateField::Rate, 2),
            WheelRate => self.final_state(StateField::WheelRates, wheel),
            Steps => self.outcome.effort.steps as f64,
            Rejected => self.outcome.effort.rejected as f64,
            Evaluations => self.outcome.effort.evaluations as f64,
            StateError => self.estimate.error,
            Amplification => self.estimate.amplification,
            IllConditioned => is_ill_conditioned(&self.estimate),
            DebrisStateError => self.debris_estimate.error,
            DebrisAmplification => self.debris_estimate.amplification,
            DebrisIllConditioned => is_ill_conditioned(&self.debris_estimate),
            Mass => self.mass.total,
            CenterX => self.mass.center[0],
            CenterY => self.mass.center[1],
            CenterZ => self.mass.center[2],
            SmallestMoment => self.moments[0],
            MiddleMoment => self.moments[1],
            LargestMoment => self.moments[2],
        }
    }

    fn last(&self, field: StateField, component: usize) -> f64 {
        self.filled.checked_sub(1).map_or(f64::NAN, |last| self.table.column(field, component)[last])
    }

    #[inline]
    fn final_state(&self, field: StateField, component: usize) -> f64 {
        self.final_point.map_or(f64::NAN, |point| self.table.column(field, component)[point])
    }
}
