//! [`Heading`]: a column of a file: name, unit, meaning and type.

use std::sync::Arc;

use parquet::basic::{LogicalType, Repetition, Type as Physical};
use parquet::errors::Result;
use parquet::schema::types::{Type, TypePtr};

use crate::run::Quantity;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Content {
    Real,
    Count,
    /// Short words, few of them distinct.
    Word,
}

/// A column of a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Heading {
    /// Name, unit and meaning.
    pub quantity: Quantity,
    pub content: Content,
    /// Whether a value may be absent.
    pub nullable: bool,
}

impl Heading {
    /// A column without absent values; those of real numbers may always be absent, since what is no finite number is null.
    pub fn new(quantity: Quantity, content: Content) -> Self {
        Heading { quantity, content, nullable: content == Content::Real }
    }

    /// The same column, whose values may be absent.
    #[must_use]
    pub fn nullable(self) -> Self {
        Heading { nullable: true, ..self }
    }

    /// The column in Parquet's schema.
    ///
    /// # Errors
    /// Where Parquet refuses it.
    pub(super) fn column(&self) -> Result<TypePtr> {
        let (physical, logical) = match self.content {
            Content::Real => (Physical::DOUBLE, None),
            // table engines have no unsigned integers (Delta Lake, Spark, Trino); no count comes near 2^63
            Content::Count => (Physical::INT64, None),
            Content::Word => (Physical::BYTE_ARRAY, Some(LogicalType::String)),
        };
        let repetition = if self.nullable { Repetition::OPTIONAL } else { Repetition::REQUIRED };
        let column = Type::primitive_type_builder(self.quantity.name(), physical);
        column.with_repetition(repetition).with_logical_type(logical).build().map(Arc::new)
    }
}
