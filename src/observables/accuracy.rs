//! [`Accuracy`]: whether the numbers of a run that reached its end can be used at all.

use super::Group;
use super::headlines::{DEBRIS_STATE_ERROR_ESTIMATE, STATE_ERROR_ESTIMATE};
use super::reduction::ErrorStatistic;
use super::request::Request;
use super::table::{ColumnId, Series, error_id};

/// The smallest estimated error of the rotational state of spacecraft or debris (rad, or relative to the largest rate) of a run that is
/// `inaccurate`.
pub const INACCURATE_STATE: f64 = 0.1;
/// The smallest relative error of a balance - energy, linear or angular momentum - of a run that is `inaccurate`.
pub const INACCURATE_BALANCE: f64 = 1e-2;

/// The relative errors of the balances of spacecraft and debris: their maximum is the conservation error of a run.
pub const BALANCES: [ColumnId; 5] = [
    error_id(Group::EnergyConservation, Series::EnergyError, ErrorStatistic::Max),
    error_id(Group::MomentumConservation, Series::LinearMomentumError, ErrorStatistic::Max),
    error_id(Group::MomentumConservation, Series::AngularMomentumError, ErrorStatistic::Max),
    error_id(Group::MomentumConservation, Series::DebrisLinearError, ErrorStatistic::Max),
    error_id(Group::MomentumConservation, Series::DebrisAngularError, ErrorStatistic::Max),
];

/// The estimated errors of the rotational states of spacecraft and debris.
pub const STATE_ERRORS: [ColumnId; 2] = [STATE_ERROR_ESTIMATE, DEBRIS_STATE_ERROR_ESTIMATE];

/// The columns of a row that say how accurate its run is, and what they must stay below. Columns of groups that are not requested judge
/// nothing.
#[derive(Clone, Debug)]
pub struct Accuracy {
    /// Index in the row, name, limit.
    limits: Vec<(usize, &'static str, f64)>,
}

impl Accuracy {
    /// The columns of `request`.
    pub fn new(request: &Request) -> Self {
        let balances = BALANCES.into_iter().map(|id| (id, INACCURATE_BALANCE));
        let states = STATE_ERRORS.into_iter().map(|id| (id, INACCURATE_STATE));
        let all = balances.chain(states);
        let limits = all.filter_map(|(id, limit)| Some((request.position(id)?, id.name(), limit))).collect();
        Accuracy { limits }
    }

    /// Whether no column says how accurate a run is: the groups are not requested.
    pub fn is_blind(&self) -> bool {
        self.limits.is_empty()
    }

    /// Whether every column of `row` is below its limit, or is not a number: a balance of nothing.
    #[inline]
    pub fn holds(&self, row: &[f64]) -> bool {
        !self.limits.iter().any(|(index, _, limit)| row[*index] >= *limit)
    }

    /// Which columns of `row` are not below their limits, in words.
    pub fn reason(&self, row: &[f64]) -> String {
        let beyond = self.limits.iter().filter(|(index, _, limit)| row[*index] >= *limit);
        let words: Vec<String> = beyond
            .map(|(index, name, limit)| format!("{name} is {:.1e}, which is {limit} or more", row[*index]))
            .collect();
        words.join("; ")
    }
}
