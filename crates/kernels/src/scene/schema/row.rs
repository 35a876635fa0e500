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
    /// A symmetric 3x3 tensor by rows; the six entries on and above the diagonal are the components; a change of
    /// one off the diagonal changes its mirror image too.
    Symmetric,
}

/// Required or optional.
#[derive(Clone, Copy, Debug)]
pub enum Presence {
    /// Always; a message shows this example.
    Required(&'static str),
    /// Never: where it is left out, the default of the input structure applies.
    Optional,
}

/// Part of a scene that a key needs to exist, beside its table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Needs {
    /// Nothing else.
    Nothing,
    /// Debris.
    Debris,
}

impl Needs {
    /// True if a scene has it.
    #[inline(always)]
    pub const fn are_met(self, has_debris: bool) -> bool {
        match self {
            Needs::Nothing => true,
            Needs::Debris => has_debris,
        }
    }
}

/// Facts about a key, whatever its table is.
#[derive(Clone, Copy, Debug)]
pub struct Facts {
    /// The key within its table.
    pub key: &'static str,
    /// The unit, as people write it; `1` for a pure number.
    pub unit: &'static str,
    /// Meaning, without the unit.
    pub meaning: &'static str,
    /// The names of the components; one empty name for a scalar.
    pub components: &'static [&'static str],
    /// Relation between the components.
    pub shape: Shape,
    /// Required, or optional.
    pub presence: Presence,
    /// Part of a scene that the key needs, beside its table.
    pub needs: Needs,
    /// Condition on its value.
    pub limit: Limit,
}

/// A row of the schema: one numeric key of the table `T`.
#[derive(Debug)]
pub struct Row<T: 'static> {
    /// Facts about the key.
    pub facts: Facts,
    /// The numbers; `None` where the table has no such key. A symmetric tensor has nine.
    pub read: fn(&T) -> Option<&[f64]>,
    /// The numbers, to be changed.
    pub write: fn(&mut T) -> Option<&mut [f64]>,
    /// Makes the table have the key: an optional value, a way to describe a body.
    pub open: fn(&mut T),
}

/// Notes which values of the rows that `table` has violate their limits.
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
