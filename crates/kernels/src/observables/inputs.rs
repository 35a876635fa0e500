//! Inputs of each value of the table.

use super::reduction::{OrderStatistic, Reduction};
use super::rows::Need;
use super::table::{FRACTION_SCALE, Series, Value};

impl Value {
    pub(super) fn of_wheel(self, wheel: usize) -> Self {
        match self {
            Value::Of(series, reduction) => Value::Of(series.of_wheel(wheel), reduction),
            Value::Direct(value, _) => Value::Direct(value, wheel as u8),
            Value::Window(..) | Value::Law(_) => self,
        }
    }

    /// Statistic by which the value is divided.
    pub(super) fn scale(self) -> Option<(Series, Reduction)> {
        match self {
            Value::Of(_, Reduction::Fraction) => Some(FRACTION_SCALE),
            Value::Of(series, _) | Value::Window(series, _) => series.row().scale,
            Value::Direct(..) | Value::Law(_) => None,
        }
    }

    pub(super) fn of(self, series: Series) -> bool {
        matches!(self, Value::Of(own, _) | Value::Window(own, _) if own == series)
    }

    /// Statistics from which the value is computed.
    pub(super) fn inputs(self) -> impl Iterator<Item = (Series, Reduction)> {
        let (own, direct, wheel) = match self {
            Value::Of(series, reduction) => (Some((series, reduction)), [].as_slice(), 0),
            Value::Direct(value, wheel) => (None, value.row().inputs, usize::from(wheel)),
            // the cheapest one: the extreme itself comes from the series
            Value::Window(series, _) => (Some((series, Reduction::Order(OrderStatistic::Initial))), [].as_slice(), 0),
            Value::Law(_) => (None, [].as_slice(), 0),
        };
        let direct = direct.iter().map(move |(series, reduction)| (series.of_wheel(wheel), *reduction));
        own.into_iter().chain(self.scale()).chain(direct)
    }

    /// Fields from which the value is computed.
    pub(super) fn needs(self) -> impl Iterator<Item = Need> {
        let direct = match self {
            Value::Of(..) | Value::Window(..) | Value::Law(_) => [].as_slice(),
            Value::Direct(value, _) => value.row().needs,
        };
        let of_series = self.inputs().flat_map(|(series, _)| series.row().needs.iter().copied().flatten());
        of_series.chain(direct).copied()
    }

    pub(super) fn is_known_after_failure(self) -> bool {
        match self {
            Value::Of(..) | Value::Window(..) | Value::Law(_) => false,
            Value::Direct(value, _) => value.row().after_failure,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::observables::law_columns::LawSeries;
    use crate::observables::reduction::Stored;
    use crate::observables::table::{DirectValue, all};

    /// Law: a column uses every series and direct value, except the series of control loops, which bands use.
    #[test]
    fn no_row_is_idle() {
        let used: Vec<Series> = all().flat_map(|column| column.value.inputs()).map(|(series, _)| series).collect();
        let mut own = Series::all().filter(|series| LawSeries::place(*series).is_none());
        assert!(own.all(|series| series.wheel().is_some_and(|wheel| wheel > 0) || used.contains(&series)));
        let direct = all().filter(|column| matches!(column.value, Value::Direct(..))).count();
        assert_eq!(direct, DirectValue::COUNT);
    }

    /// Law: a series stored as a function of its quantity has order statistics only.
    #[test]
    fn statistics_are_those_of_the_quantity() {
        for column in all() {
            for (series, reduction) in column.value.inputs() {
                let is_order = matches!(reduction, Reduction::Order(_));
                assert!(is_order || series.row().stored == Stored::Quantity, "{column:?}");
            }
        }
    }
}
