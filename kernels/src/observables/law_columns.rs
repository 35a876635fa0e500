//! [`LawColumns`]: the columns of a row that a control law reports at the end of a run; [`LawSeries`]: the quantities
//! that it records over time.
//!
//! The observer does not know the values of the columns: whoever flies a run asks its law
//! ([`crate::dynamics::actuation::ActuationLaw::report`]).

use std::sync::{Mutex, PoisonError};

use super::group::Group;
use super::rows::{ColumnKind, Scenes};
use super::table::{Column, ColumnId, Series, Value};
use crate::run::Quantity;
use crate::scene::MAX_WHEELS;

/// A column that a control law reports.
#[derive(Clone, Debug, PartialEq)]
pub struct LawColumn {
    /// Name, unit and meaning.
    pub quantity: Quantity,
    /// Whether the value is a number or a count.
    pub kind: ColumnKind,
    /// What the counts 0, 1, ... stand for, where they are codes.
    pub codes: &'static [&'static str],
}

/// The quantities over time that a control loop records at the observation points: a set of series of the table.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LawSeries(u32);

impl LawSeries {
    /// No quantity.
    pub const NONE: LawSeries = LawSeries(0);
    /// Every quantity.
    pub const ALL: LawSeries = LawSeries(u32::MAX);
    /// How many there are, with one of each wheel that a spacecraft may have: a record has as many columns, in the
    /// order of the table.
    pub const COUNT: usize = Series::MotorTorque.index() + MAX_WHEELS - Series::PointingError.index();

    /// The set with `series`.
    ///
    /// # Panics
    /// Where no control loop records it.
    #[must_use]
    pub fn with(self, series: Series) -> Self {
        LawSeries(self.0 | 1 << Self::place(series).expect("a control loop records the series"))
    }

    /// The column of `series` in a record; `None` where no control loop records it.
    pub fn place(series: Series) -> Option<usize> {
        series.index().checked_sub(Series::PointingError.index()).filter(|place| *place < Self::COUNT)
    }

    /// The series of the set.
    pub(super) fn series(self) -> impl Iterator<Item = Series> {
        Series::all().filter(move |series| Self::place(*series).is_some_and(|place| self.0 & 1 << place != 0))
    }
}

/// What the control law of a campaign reports: the columns `list` of its rows, in this order, and quantities over time.
/// NaN is a value that a run does not have.
#[derive(Clone, Copy, Debug, Default)]
pub struct LawColumns {
    /// The columns.
    pub list: &'static [LawColumn],
    /// How many of them, the last ones, say when events and failures happened: they are no matter of the law.
    pub of_events: usize,
    /// The quantities over time.
    pub over_time: LawSeries,
}

impl PartialEq for LawColumns {
    fn eq(&self, other: &Self) -> bool {
        (core::ptr::eq(self.list, other.list) || self.list == other.list)
            && self.of_events == other.of_events
            && self.over_time == other.over_time
    }
}

impl LawColumns {
    /// A law that reports nothing, or no law.
    pub const NONE: LawColumns = LawColumns { list: &[], of_events: 0, over_time: LawSeries::NONE };

    /// The columns `list`, known at run time only. Each list is kept once and for good: a program has as many as it
    /// opens kinds of campaigns.
    pub fn kept(list: Vec<LawColumn>) -> Self {
        static KEPT: Mutex<Vec<&'static [LawColumn]>> = Mutex::new(Vec::new());
        let mut kept = KEPT.lock().unwrap_or_else(PoisonError::into_inner);
        let known = kept.iter().find(|known| ***known == list[..]).copied();
        let list = known.unwrap_or_else(|| {
            let list: &'static [LawColumn] = Vec::leak(list);
            kept.push(list);
            list
        });
        LawColumns { list, ..LawColumns::NONE }
    }

    /// The same, followed by the columns `events` that say when events and failures happened.
    #[must_use]
    pub fn with_events(self, events: Vec<LawColumn>) -> Self {
        if events.is_empty() {
            return self;
        }
        let of_events = events.len();
        LawColumns { of_events, over_time: self.over_time, ..Self::kept([self.list.to_vec(), events].concat()) }
    }

    /// The handles of the columns.
    pub(super) fn ids(self) -> impl Iterator<Item = ColumnId> {
        let of_law = self.list.len() - self.of_events;
        let group = move |index: usize| if index < of_law { Group::Control } else { Group::Events };
        (0..self.list.len()).map(move |index| ColumnId { group: group(index), value: Value::Law(index as u8) })
    }

    /// The columns.
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
