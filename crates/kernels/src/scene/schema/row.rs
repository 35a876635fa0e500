//! [`Row`]: one numeric key of one table.

use super::limit::Limit;
use crate::scene::error::Problems;
use std::borrow::Cow;

/// Relation between the components of a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// Independent numbers.
    Plain,
    /// A unit quaternion, scalar first: normalised after its components were changed.
    Quaternion,
    /// A symmetric 3x3 tensor by rows; its components are the six entries on and above the diagonal.
    Symmetric,
}

/// The first of the optional tokens of a row.
pub(super) const fn first<T: Copy>(tokens: &[T]) -> Option<T> {
    match tokens {
        [first, ..] => Some(*first),
        [] => None,
    }
}

/// Facts about a key of any table.
#[derive(Clone, Copy, Debug)]
pub struct Facts {
    /// The key within its table.
    pub key: &'static str,
    /// The unit, as in text; `1` for a pure number.
    pub unit: &'static str,
    /// Meaning, without the unit.
    pub meaning: &'static str,
    /// The names of the components; one empty name for a scalar.
    pub components: &'static [&'static str],
    /// Relation between the components.
    pub shape: Shape,
    /// Example for messages, if the key is required.
    pub required: Option<&'static str>,
    /// True if the key exists only with debris.
    pub needs_debris: bool,
    /// Condition on its value.
    pub limit: Limit,
}

/// A row of the schema: one numeric key of the table `T`.
#[derive(Debug)]
pub struct Row<T: 'static> {
    /// Facts about the key.
    pub facts: Facts,
    /// The numbers, if the table has the key; nine for a symmetric tensor.
    pub read: fn(&T) -> Option<&[f64]>,
    /// The numbers, mutable.
    pub write: fn(&mut T) -> Option<&mut [f64]>,
    /// Adds the key to the table.
    pub open: fn(&mut T),
}

/// Notes violated limits of the rows that `table` has.
pub(super) fn check_rows<T>(
    rows: &'static [Row<T>],
    table: &T,
    problems: &mut Problems,
    name: impl Fn(&'static str) -> Cow<'static, str>,
) {
    for row in rows {
        if let Some(numbers) = (row.read)(table) {
            row.facts.limit.check(|| name(row.facts.key), numbers, problems);
        }
    }
}
