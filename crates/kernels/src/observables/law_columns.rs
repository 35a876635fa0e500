//! [`LawColumns`]: columns that a control law reports ([`crate::dynamics::actuation::ActuationLaw::report`]);
//! [`LawSeries`]: its records over time.

use std::sync::Mutex;

use super::group::Group;
use super::rows::{ColumnKind, Scenes};
use super::table::{Column, ColumnId, Series, Value};
use crate::run::Quantity;
use crate::scene::MAX_WHEELS;
use crate::scene::schema::numbers::interned;

/// A column of a control law.
#[derive(Clone, Debug, PartialEq)]
pub struct LawColumn {
    /// Name, unit and meaning.
    pub quantity: Quantity,
    /// Real numbers or counts.
    pub kind: ColumnKind,
    /// Meanings of the counts 0, 1, ..., if they are codes.
    pub codes: &'static [&'static str],
}

/// Series that a control loop records at the observation points.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LawSeries(u32);

impl LawSeries {
    /// No series.
    pub const NONE: LawSeries = LawSeries(0);
    /// Every series.
    pub const ALL: LawSeries = LawSeries(u32::MAX);
    /// Columns of a record, in the order of the table, with one per possible wheel.
    pub const COUNT: usize = Series::MotorTorque.index() + MAX_WHEELS - Series::PointingError.index();

    /// This set and `series`.
    ///
    /// # Panics
    /// If no control loop records it.
    #[must_use]
    pub fn with(self, series: Series) -> Self {
        LawSeries(self.0 | 1 << Self::place(series).expect("a control loop records the series"))
    }

    /// Column of `series` in a record, if a control loop records it.
    pub fn place(series: Series) -> Option<usize> {
        series.index().checked_sub(Series::PointingError.index()).filter(|place| *place < Self::COUNT)
    }

    pub(super) fn series(self) -> impl Iterator<Item = Series> {
        Series::all().filter(move |series| Self::place(*series).is_some_and(|place| self.0 & 1 << place != 0))
    }
}

/// Reports of a control law; NaN means no value.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LawColumns {
    /// The columns.
    pub list: &'static [LawColumn],
    /// Number of columns, at the end, that are times of events and failures.
    pub of_events: usize,
    /// Recorded series.
    pub over_time: LawSeries,
}

impl LawColumns {
    /// No reports.
    pub const NONE: LawColumns = LawColumns { list: &[], of_events: 0, over_time: LawSeries::NONE };

    /// Columns known at run time only; a list is kept forever, once for each kind of campaign.
    pub fn kept(list: Vec<LawColumn>) -> Self {
        static KEPT: Mutex<Vec<&'static [LawColumn]>> = Mutex::new(Vec::new());
        LawColumns { list: interned(&KEPT, list, |a, b| a == b), ..LawColumns::NONE }
    }

    /// Appends columns of times of events and failures.
    #[must_use]
    pub fn with_events(self, events: Vec<LawColumn>) -> Self {
        if events.is_empty() {
            return self;
        }
        let of_events = events.len();
        LawColumns { of_events, over_time: self.over_time, ..Self::kept([self.list.to_vec(), events].concat()) }
    }

    pub(super) fn ids(self) -> impl Iterator<Item = ColumnId> {
        let of_law = self.list.len() - self.of_events;
        let group = move |index: usize| if index < of_law { Group::Control } else { Group::Events };
        (0..self.list.len()).map(move |index| ColumnId { group: group(index), value: Value::Law(index as u8) })
    }

    pub(super) fn columns(self) -> impl Iterator<Item = Column> {
        self.list.iter().zip(self.ids()).map(|(column, ColumnId { group, value })| Column {
            quantity: column.quantity.clone(),
            group,
            kind: column.kind,
            scenes: Scenes::All,
            value,
            wheel: None,
        })
    }
}
