//! [`LawColumns`]: the columns of a row that a control law reports at the end of a run.
//!
//! The observer does not know their values: whoever flies a run asks its law ([`crate::dynamics::actuation::ActuationLaw::report`]).

use std::sync::{Mutex, PoisonError};

use super::group::Group;
use super::rows::{ColumnKind, Scenes};
use super::table::{Column, ColumnId, Value};
use crate::run::Quantity;

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

/// The columns that the control law of a campaign reports, in the order of a row. NaN is a value that a run does not have.
#[derive(Clone, Copy, Debug, Default)]
pub struct LawColumns(pub &'static [LawColumn]);

impl PartialEq for LawColumns {
    fn eq(&self, other: &Self) -> bool {
        core::ptr::eq(self.0, other.0) || self.0 == other.0
    }
}

impl LawColumns {
    /// A law that reports nothing, or no law.
    pub const NONE: LawColumns = LawColumns(&[]);

    /// The columns `list`, known at run time only. Each list is kept once and for good: a program has as many as it opens kinds of campaigns.
    pub fn kept(list: Vec<LawColumn>) -> Self {
        static KEPT: Mutex<Vec<&'static [LawColumn]>> = Mutex::new(Vec::new());
        let mut kept = KEPT.lock().unwrap_or_else(PoisonError::into_inner);
        let known = kept.iter().find(|known| ***known == list[..]).copied();
        LawColumns(known.unwrap_or_else(|| {
            let list: &'static [LawColumn] = Vec::leak(list);
            kept.push(list);
            list
        }))
    }

    /// The handles of the columns.
    pub(super) fn ids(self) -> impl Iterator<Item = ColumnId> {
        (0..self.0.len()).map(|index| ColumnId { group: Group::Control, value: Value::Law(index as u8) })
    }

    /// The columns.
    pub(super) fn columns(self) -> impl Iterator<Item = Column> {
        self.0.iter().zip(self.ids()).map(|(column, ColumnId { group, value })| Column {
            quantity: column.quantity.clone(),
            group,
            kind: column.kind,
            scenes: Scenes::All,
            value,
            wheel: None,
        })
    }
}
