//! [`Accuracy`]: limits of error of a completed run.

use super::group::Group;
use super::headlines::{DEBRIS_STATE_ERROR_ESTIMATE, STATE_ERROR_ESTIMATE};
use super::reduction::ErrorStatistic;
use super::request::Request;
use super::table::{ColumnId, Series, error_id};

/// Estimated error of the rotational state of spacecraft or debris (rad, or relative to the largest rate) of an
/// `inaccurate` run; under a law also of pilots whose outcomes are compared ([`super::loop_error`]).
pub const INACCURATE_STATE: f64 = 0.1;
/// Relative error of a balance (energy, momentum) of an `inaccurate` run.
pub const INACCURATE_BALANCE: f64 = 1e-2;

/// Relative errors of the balances; their maximum is the conservation error of a run.
pub const BALANCES: [ColumnId; 5] = [
    error_id(Group::EnergyConservation, Series::EnergyError, ErrorStatistic::Max),
    error_id(Group::MomentumConservation, Series::LinearMomentumError, ErrorStatistic::Max),
    error_id(Group::MomentumConservation, Series::AngularMomentumError, ErrorStatistic::Max),
    error_id(Group::MomentumConservation, Series::DebrisLinearError, ErrorStatistic::Max),
    error_id(Group::MomentumConservation, Series::DebrisAngularError, ErrorStatistic::Max),
];

/// Estimated errors of the rotational states of spacecraft and debris.
pub const STATE_ERRORS: [ColumnId; 2] = [STATE_ERROR_ESTIMATE, DEBRIS_STATE_ERROR_ESTIMATE];

/// The requested columns of errors, with their limits.
#[derive(Clone, Debug)]
pub struct Accuracy {
    limits: Vec<AccuracyLimit>,
}

#[derive(Clone, Copy, Debug)]
struct AccuracyLimit {
    index: usize,
    name: &'static str,
    limit: f64,
}

impl AccuracyLimit {
    #[inline]
    fn holds(&self, row: &[f64]) -> bool {
        // false for NaN
        row[self.index] < self.limit
    }
}

impl Accuracy {
    /// The columns in rows of `request`.
    pub fn new(request: &Request) -> Self {
        let balances = BALANCES.into_iter().map(|id| (id, INACCURATE_BALANCE));
        let states = STATE_ERRORS.into_iter().map(|id| (id, INACCURATE_STATE));
        let limit =
            |(id, limit): (ColumnId, f64)| Some(AccuracyLimit { index: request.position(id)?, name: id.name(), limit });
        Accuracy { limits: balances.chain(states).filter_map(limit).collect() }
    }

    /// True if none of the columns is requested.
    pub fn is_blind(&self) -> bool {
        self.limits.is_empty()
    }

    /// True if every column of `row` is below its limit, except for the spacecraft's state unless that `is_judged`.
    #[inline]
    pub fn holds(&self, row: &[f64], is_judged: bool) -> bool {
        let is_left_out = |limit: &AccuracyLimit| !is_judged && limit.name == STATE_ERROR_ESTIMATE.name();
        self.limits.iter().all(|limit| limit.holds(row) || is_left_out(limit))
    }

    /// The columns of `row` beyond their limits, in words.
    pub fn reason(&self, row: &[f64]) -> String {
        let beyond = self.limits.iter().filter(|limit| !limit.holds(row));
        let words = beyond.map(|AccuracyLimit { index, name, limit }| match row[*index] {
            value if value.is_nan() => format!("{name} is not a number"),
            value => format!("{name} is {value:.1e}, which is {limit} or more"),
        });
        words.collect::<Vec<_>>().join("; ")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::observables::request::tests::request;

    /// Law: an error at its limit, or NaN, is inaccurate.
    #[test]
    fn what_is_not_a_number_is_not_accurate() {
        let groups = [Group::EnergyConservation, Group::MomentumConservation, Group::Numerics];
        let request = request(&groups, true, true, &[]);
        let accuracy = Accuracy::new(&request);
        let right = vec![1e-3; request.columns().len()];
        assert!(accuracy.holds(&right, true) && accuracy.reason(&right).is_empty());
        for error in BALANCES {
            let error_at = request.position(error).expect("a column of the groups");
            for (value, holds) in [(0.0099, true), (0.01, false), (f64::NAN, false)] {
                let mut row = right.clone();
                row[error_at] = value;
                assert_eq!(accuracy.holds(&row, true), holds, "{} {value}", error.name());
                assert_eq!(accuracy.reason(&row).contains(error.name()), !holds);
            }
        }
        for id in STATE_ERRORS {
            let mut row = right.clone();
            row[request.position(id).expect("a column of the group")] = 0.1;
            assert!(!accuracy.holds(&row, true) && accuracy.reason(&row).contains("0.1 or more"), "{}", id.name());
        }
    }
}
