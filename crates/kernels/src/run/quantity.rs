//! [`Quantity`]: name, unit and meaning of a column of any table.

use std::borrow::Cow;

/// Name, unit and meaning of a column.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Quantity {
    name: Cow<'static, str>,
    unit: Cow<'static, str>,
    meaning: Cow<'static, str>,
}

impl Quantity {
    /// A quantity known at compile time.
    pub const fn new(name: &'static str, unit: &'static str, meaning: &'static str) -> Self {
        Quantity { name: Cow::Borrowed(name), unit: Cow::Borrowed(unit), meaning: Cow::Borrowed(meaning) }
    }

    /// A quantity known at run time.
    pub fn named(name: String, unit: String, meaning: String) -> Self {
        Quantity { name: Cow::Owned(name), unit: Cow::Owned(unit), meaning: Cow::Owned(meaning) }
    }

    /// Name of the column, unit last.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Unit; empty for a pure number.
    pub fn unit(&self) -> &str {
        &self.unit
    }

    /// One sentence.
    pub fn meaning(&self) -> &str {
        &self.meaning
    }
}
