//! [`Window`]: extreme of a quantity over an interval of time, the column behind a requirement "at all times".

use core::ops::Range;

use super::group::Group;
use super::reduction::Stored;
use super::rows::{ColumnKind, Scenes};
use super::table::{Column, ColumnId, Series, Value};
use crate::math::list::List;
use crate::run::{Quantity, points_before, points_to};
use crate::scene::Name;

/// Maximum per campaign.
pub const MAX_WINDOWS: usize = 16;

/// Windows of a campaign.
pub type Windows = List<Window, MAX_WINDOWS>;

const BLANK: Window = Window {
    series: Series::EnergyTotal,
    group: Group::Energies,
    is_change: false,
    is_highest: true,
    from_s: None,
    to_s: None,
};
/// No window.
pub const NO_WINDOWS: Windows = List::empty(BLANK);

/// Extreme of a quantity with bands over the observation points in a closed interval of time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Window {
    pub(super) series: Series,
    pub(super) group: Group,
    /// True for the change of the series since the start.
    pub(super) is_change: bool,
    /// True for the largest value, false for the smallest.
    pub(super) is_highest: bool,
    pub(super) from_s: Option<f64>,
    pub(super) to_s: Option<f64>,
}

impl Window {
    pub(super) fn column(&self, wheels: &[Name], index: usize) -> Column {
        let of = self.series.over_time(self.is_change, wheels).expect("quantities with bands have names");
        Column {
            quantity: self.quantity(&of),
            group: self.group,
            kind: ColumnKind::Float,
            scenes: Scenes::All,
            value: self.id(index).value,
            wheel: None,
        }
    }

    /// Name, unit and meaning of its column.
    pub fn quantity(&self, of: &Quantity) -> Quantity {
        let (prefix, word) = if self.is_highest { ("highest", "Largest") } else { ("lowest", "Smallest") };
        let text = |time: f64| format!("{time:?}").trim_end_matches(".0").replace('.', "p").replace('-', "m");
        let end = |word: &str, end: Option<f64>| end.map_or(String::new(), |end| format!("_{word}_{}_s", text(end)));
        let name = format!("{prefix}{}{}_{}", end("from", self.from_s), end("to", self.to_s), of.name());
        let words = |word: &str, end: Option<f64>| end.map_or(String::new(), |end| format!(" {word} {end:?} s"));
        let times = format!("{}{}", words("from", self.from_s), words("to", self.to_s));
        let meaning = format!("{word} value over the observation points{times} of {}: {}", of.name(), of.meaning());
        Quantity::named(name, of.unit().to_owned(), meaning)
    }

    pub(super) fn id(&self, index: usize) -> ColumnId {
        ColumnId { group: self.group, value: Value::Window(self.series, index as u8) }
    }

    /// Observation points within the window, among `times`.
    pub fn points(&self, times: &[f64]) -> Range<usize> {
        let start = self.from_s.map_or(0, |from| points_before(times, from));
        let end = self.to_s.map_or(times.len(), |to| points_to(times, to));
        start..end.max(start)
    }

    /// Extreme over `points` of the stored numbers `column`, divided by `scale`; NaN if one is, or if there are none.
    pub(super) fn extreme(&self, column: &[f64], points: Range<usize>, scale: f64) -> f64 {
        let beyond = |a: f64, b: f64| if self.is_highest { a > b } else { a < b };
        let further = |far: f64, value: &f64| if far.is_nan() || beyond(far, *value) { far } else { *value };
        let Some((first, rest)) = column.get(points).and_then(<[f64]>::split_first) else { return f64::NAN };
        let extreme = rest.iter().fold(*first, further);
        // stored numbers increase with the quantity
        match self.series.row().stored {
            Stored::Quantity if self.is_change => extreme - column[0],
            stored => stored.shown(extreme) / scale,
        }
    }
}
