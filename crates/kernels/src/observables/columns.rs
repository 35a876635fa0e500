//! Columns of a row, series and their handles; what they are is in [`super::table`].

use core::ops::Range;

use super::group::Group;
use super::reduction::{ErrorStatistic, Reduction, Stored};
use super::rows::{ColumnKind, Need, Scenes, SeriesSource};
use super::table::{CHANGES, DirectValue, PLACES, SERIES, all};
use crate::run::Quantity;
use crate::scene::Name;

/// A column of a row.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// Name, unit and meaning.
    pub quantity: Quantity,
    /// Group by which a campaign requests it.
    pub group: Group,
    /// Number or count.
    pub kind: ColumnKind,
    pub(super) scenes: Scenes,
    pub(super) value: Value,
    /// Index of the wheel, in the columns of a request.
    pub(super) wheel: Option<u8>,
}

impl Column {
    /// The kinds of scene that have the column, in words; empty for all.
    pub const fn scenes(&self) -> &'static str {
        self.scenes.words()
    }

    /// True if there is one such column per turning wheel.
    pub fn is_of_wheel(&self) -> bool {
        self.quantity.name().contains(WHEEL)
    }

    pub(super) fn of_wheel(&self, index: usize, name: Name) -> Column {
        let value = self.value.of_wheel(index);
        Column { quantity: named(&self.quantity, name), value, wheel: Some(index as u8), ..self.clone() }
    }

    /// Handle of the column.
    pub const fn id(&self) -> ColumnId {
        ColumnId { group: self.group, value: self.value }
    }
}

/// Content of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Value {
    /// A series reduced to a number.
    Of(Series, Reduction),
    /// A number not reduced from a single series, with the index of its wheel if there is one per wheel.
    Direct(DirectValue, u8),
    /// Extreme of a series in an interval of time, with its index in the request.
    Window(Series, u8),
    /// Report of a control law, by index among its columns; not filled by the observer.
    Law(u8),
}

/// Handle of a column; [`super::Request::position`] gives its position in a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ColumnId {
    pub(super) group: Group,
    pub(super) value: Value,
}

impl ColumnId {
    pub(super) fn is_of_wheel(self) -> bool {
        all().any(|column| column.id() == self && column.is_of_wheel())
    }

    /// The handle for wheel `wheel`; itself if there is no such column per wheel.
    #[must_use]
    pub fn of_wheel(self, wheel: usize) -> Self {
        let value = match self.value {
            Value::Direct(..) if !self.is_of_wheel() => self.value,
            of_wheel => of_wheel.of_wheel(wheel),
        };
        ColumnId { value, ..self }
    }

    /// Name of a column that does not depend on a wheel.
    ///
    /// # Panics
    /// If the table has no such column.
    pub fn name(self) -> &'static str {
        all().find(|column| column.id() == self).expect("every handle has a column").quantity.name()
    }
}

/// Placeholder of a wheel's name in the name or meaning of a column.
const WHEEL: &str = "{wheel}";

fn named(quantity: &Quantity, name: Name) -> Quantity {
    let of_wheel = |text: &str| text.replace(WHEEL, name.as_str());
    Quantity::named(of_wheel(quantity.name()), quantity.unit().to_owned(), of_wheel(quantity.meaning()))
}

/// A quantity at every observation point; a quantity of wheels has a series per possible wheel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Series(u8);

impl Series {
    pub(super) const COUNT: usize = Self::first(PLACES.len()).index();

    /// Every series, in the order of columns of a time series.
    pub fn all() -> impl Iterator<Item = Series> {
        (0..Self::COUNT).map(|index| Series(index as u8))
    }

    pub(super) const fn first(kind: usize) -> Series {
        let (mut first, mut other) = (0, 0);
        while other < kind {
            first += PLACES[other];
            other += 1;
        }
        Series(first as u8)
    }

    #[inline(always)]
    pub(super) const fn index(self) -> usize {
        self.0 as usize
    }

    /// Indices of `count` series from this one on: those of the first wheels.
    pub(super) const fn block(self, count: usize) -> Range<usize> {
        self.index()..self.index() + count
    }

    /// The series of wheel `wheel`; itself if it does not depend on wheels.
    pub const fn of_wheel(self, wheel: usize) -> Series {
        let (kind, _) = self.place();
        if PLACES[kind] > 1 { Series(Series::first(kind).0 + wheel as u8) } else { self }
    }

    /// Row, and place within it.
    const fn place(self) -> (usize, usize) {
        let (mut kind, mut place) = (0, self.0 as usize);
        while place >= PLACES[kind] {
            place -= PLACES[kind];
            kind += 1;
        }
        (kind, place)
    }

    pub(super) fn wheel(self) -> Option<usize> {
        let (kind, place) = self.place();
        (PLACES[kind] > 1).then_some(place)
    }

    pub(super) fn row(self) -> &'static SeriesRow {
        &SERIES[self.place().0]
    }

    /// Column of a time series for a spacecraft with these wheels; `None` for the scale of another series.
    pub fn quantity(self, wheels: &[Name]) -> Option<Quantity> {
        let shown = self.row().shown.as_ref()?;
        match self.wheel() {
            Some(wheel) => wheels.get(wheel).map(|name| named(shown, *name)),
            None => Some(shown.clone()),
        }
    }

    /// [`Series::quantity`], or the quantity of the change since the start, if any.
    pub(super) fn over_time(self, is_change: bool, wheels: &[Name]) -> Option<Quantity> {
        let shown = self.quantity(wheels)?;
        if !is_change {
            return Some(shown);
        }
        let (_, name, meaning) = CHANGES.iter().find(|(series, ..)| series.place().0 == self.place().0)?;
        let change = Quantity::named((*name).to_owned(), shown.unit().to_owned(), (*meaning).to_owned());
        self.wheel().map_or(Some(change.clone()), |wheel| wheels.get(wheel).map(|wheel| named(&change, *wheel)))
    }
}

/// Handle of a reduced series.
pub const fn series_id(group: Group, series: Series, reduction: Reduction) -> ColumnId {
    ColumnId { group, value: Value::Of(series, reduction) }
}

/// Handle of a statistic of an error.
pub const fn error_id(group: Group, series: Series, statistic: ErrorStatistic) -> ColumnId {
    series_id(group, series, Reduction::Error(statistic))
}

/// Handle of a direct value.
pub const fn direct_id(group: Group, value: DirectValue) -> ColumnId {
    ColumnId { group, value: Value::Direct(value, 0) }
}

pub(super) struct SeriesRow {
    pub(super) source: SeriesSource,
    pub(super) stored: Stored,
    /// Statistic by which the values are divided.
    pub(super) scale: Option<(Series, Reduction)>,
    pub(super) needs: &'static [&'static [Need]],
    pub(super) shown: Option<Quantity>,
}

pub(super) struct DirectRow {
    pub(super) needs: &'static [Need],
    pub(super) inputs: &'static [(Series, Reduction)],
    /// True if a failed run has it.
    pub(super) after_failure: bool,
}
