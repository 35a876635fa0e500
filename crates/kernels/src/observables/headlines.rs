//! [`HEADLINES`]: columns of a summary.

use super::group::Group;
use super::reduction::{ChangeStatistic, ErrorStatistic, Reduction, ValueStatistic};
use super::request::Request;
use super::table::{ColumnId, DirectValue, Series, direct_id, series_id};

/// Estimated error of the rotational state.
pub const STATE_ERROR_ESTIMATE: ColumnId = direct_id(Group::Numerics, DirectValue::StateError);

/// Estimated error of the debris' rotation.
pub const DEBRIS_STATE_ERROR_ESTIMATE: ColumnId = direct_id(Group::Numerics, DirectValue::DebrisStateError);

/// Handles: `group: series [reduction], ...;`, and then `group: direct value, ...;`.
macro_rules! ids {
    ({ $($group:ident: $($series:ident [$($reduction:ident)+]),+;)+ } $($of:ident: $($value:ident),+;)+) => {
        &[
            $($(series_id(Group::$group, Series::$series, reduction!($($reduction)+)),)+)+
            $($(direct_id(Group::$of, DirectValue::$value),)+)+
        ]
    };
}

/// Columns of a summary, in order; a column of wheels stands for one per wheel.
pub const HEADLINES: &[ColumnId] = ids! {
    {
        EnergyConservation: EnergyError [Error Max], EnergyError [Error Slope];
        MomentumConservation:
            LinearMomentumError [Error Max], AngularMomentumError [Error Max], DebrisLinearError [Error Max],
            DebrisAngularError [Error Max];
        Attitude: Orthonormality [Error Max];
        Constraints: ResidualKinematic [Error Max], ResidualCollocation [Error Max], ResidualAttitude [Error Max];
        EnergiesCom: ComError [Error Max];
        Exchange:
            ComBody [Value PeakToPeak], ComWheel [Value PeakToPeak], ComBody [Fraction], ComWheel [Fraction],
            ComWheel [Change Gross];
    }
    StepStatistics: Steps;
    Numerics: StateError, DebrisStateError, Amplification, IllConditioned;
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
