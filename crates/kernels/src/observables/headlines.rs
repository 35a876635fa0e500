//! [`HEADLINES`]: columns of a summary.

use super::group::Group;
use super::reduction::{ChangeStatistic, ErrorStatistic, Reduction, ValueStatistic};
use super::request::Request;
use super::table::{ColumnId, DirectValue, Series, direct_id, error_id, series_id};

/// Estimated error of the rotational state.
pub const STATE_ERROR_ESTIMATE: ColumnId = direct_id(Group::Numerics, DirectValue::StateError);

/// Estimated error of the debris' rotation.
pub const DEBRIS_STATE_ERROR_ESTIMATE: ColumnId = direct_id(Group::Numerics, DirectValue::DebrisStateError);

/// Columns of a summary, in order; a column of wheels stands for one per wheel.
pub const HEADLINES: &[ColumnId] = &{
    use Group::{Attitude, Constraints, EnergiesCom, EnergyConservation, Exchange, MomentumConservation, Numerics};
    [
        error_id(EnergyConservation, Series::EnergyError, ErrorStatistic::Max),
        error_id(EnergyConservation, Series::EnergyError, ErrorStatistic::Slope),
        error_id(MomentumConservation, Series::LinearMomentumError, ErrorStatistic::Max),
        error_id(MomentumConservation, Series::AngularMomentumError, ErrorStatistic::Max),
        error_id(MomentumConservation, Series::DebrisLinearError, ErrorStatistic::Max),
        error_id(MomentumConservation, Series::DebrisAngularError, ErrorStatistic::Max),
        error_id(Attitude, Series::Orthonormality, ErrorStatistic::Max),
        error_id(Constraints, Series::ResidualKinematic, ErrorStatistic::Max),
        error_id(Constraints, Series::ResidualCollocation, ErrorStatistic::Max),
        error_id(Constraints, Series::ResidualAttitude, ErrorStatistic::Max),
        error_id(EnergiesCom, Series::ComError, ErrorStatistic::Max),
        series_id(Exchange, Series::ComBody, Reduction::Value(ValueStatistic::PeakToPeak)),
        series_id(Exchange, Series::ComWheel, Reduction::Value(ValueStatistic::PeakToPeak)),
        series_id(Exchange, Series::ComBody, Reduction::Fraction),
        series_id(Exchange, Series::ComWheel, Reduction::Fraction),
        series_id(Exchange, Series::ComWheel, Reduction::Change(ChangeStatistic::Gross)),
        direct_id(Group::StepStatistics, DirectValue::Steps),
        STATE_ERROR_ESTIMATE,
        DEBRIS_STATE_ERROR_ESTIMATE,
        direct_id(Numerics, DirectValue::Amplification),
        direct_id(Numerics, DirectValue::IllConditioned),
    ]
};

/// Positions of [`HEADLINES`] in a row.
pub fn headlines(request: &Request) -> Vec<usize> {
    let of_wheels = |id: &ColumnId| {
        let wheels = if id.is_of_wheel() { request.wheels.len() } else { 1 };
        (0..wheels).filter_map(|wheel| request.position(id.of_wheel(wheel))).collect::<Vec<_>>()
    };
    HEADLINES.iter().flat_map(of_wheels).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::observables::table;

    #[test]
    fn headlines_are_columns() {
        for id in HEADLINES {
            assert!(table::all().any(|column| column.id() == *id), "{id:?}");
        }
    }
}
