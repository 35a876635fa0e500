//! Layer 2: tables of columns with name, unit, meaning and values. Writers: [`csv`], [`html`], [`json`], aligned
//! [`text`] of [`mod@wrapped`] lines, Parquet in `storage::columnar`, Arrow in the Python package. Rows of a campaign
//! bypass tables: their block (`ensemble::Rows`) passes slices to the writers as [`Values`].

pub mod csv;
pub mod html;
pub mod json;
#[cfg(test)]
pub(crate) mod tests;
pub mod text;
pub mod wrapped;

use std::borrow::Cow;
use std::collections::BTreeMap;

use crate::run::Quantity;
use crate::table::text::{Align, Text};

/// The kind of the values of a column; variant names enter the hashed identity of rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Content {
    Real,
    Count,
    /// Texts with few distinct values.
    Word,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Column {
    pub quantity: Quantity,
    pub content: Content,
    pub nullable: bool,
    pub align: Align,
}

impl Column {
    /// A column without absent values, except that non-finite reals are always null.
    pub fn new(quantity: Quantity, content: Content) -> Self {
        Column { quantity, content, nullable: content == Content::Real, align: content.into() }
    }

    #[must_use]
    pub fn nullable(self) -> Self {
        Column { nullable: true, ..self }
    }
}

#[derive(Clone, Debug, PartialEq)]
pub enum Values<'a> {
    /// Non-finite numbers are null, so that aggregates stay finite.
    Real(Cow<'a, [f64]>),
    Count(Vec<u64>),
    /// Counts stored as doubles; non-finite ones are null.
    Counted(Cow<'a, [f64]>),
    /// Absent texts are null.
    Text(Vec<Option<Cow<'a, str>>>),
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cell<'a> {
    Null,
    Real(f64),
    Count(u64),
    Text(&'a str),
}

impl<'a> Values<'a> {
    pub fn words<T: Into<Cow<'a, str>>>(words: impl IntoIterator<Item = T>) -> Self {
        Values::Text(words.into_iter().map(|word| Some(word.into())).collect())
    }

    pub fn content(&self) -> Content {
        match self {
            Values::Real(_) => Content::Real,
            Values::Count(_) | Values::Counted(_) => Content::Count,
            Values::Text(_) => Content::Word,
        }
    }

    pub fn count(&self) -> usize {
        match self {
            Values::Real(values) | Values::Counted(values) => values.len(),
            Values::Count(values) => values.len(),
            Values::Text(values) => values.len(),
        }
    }

    pub fn cell(&self, row: usize) -> Cell<'_> {
        match self {
            Values::Real(values) if values[row].is_finite() => Cell::Real(values[row]),
            Values::Counted(values) if values[row].is_finite() => Cell::Count(values[row] as u64),
            Values::Real(_) | Values::Counted(_) => Cell::Null,
            Values::Count(values) => Cell::Count(values[row]),
            Values::Text(values) => values[row].as_deref().map_or(Cell::Null, Cell::Text),
        }
    }
}

/// Columns of equal length with their values.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table<'a> {
    pub columns: Vec<Column>,
    pub values: Vec<Values<'a>>,
    /// Notes for the file, in addition to those of the plan.
    pub notes: BTreeMap<String, String>,
}

impl<'a> Table<'a> {
    /// Builds a table with a row for each of `rows`, column by column.
    pub fn of<R>(rows: &'a [R]) -> TableOf<'a, R> {
        TableOf { rows, table: Table::default() }
    }

    /// A table of texts with these heads, to be filled row by row.
    pub fn with<H: Into<String>>(columns: impl IntoIterator<Item = (H, Align)>) -> Self {
        let mut table = Table::default();
        for (head, align) in columns {
            let quantity = Quantity::named(head.into(), String::new(), String::new());
            table.push(Column { align, ..Column::new(quantity, Content::Word) }, Values::Text(Vec::new()));
        }
        table
    }

    /// Adds a row of texts; missing cells are empty.
    pub fn row<C: Into<String>>(&mut self, cells: impl IntoIterator<Item = C>) {
        let mut cells = cells.into_iter();
        for values in &mut self.values {
            let cell: String = cells.next().map(Into::into).unwrap_or_default();
            if let Values::Text(texts) = values {
                texts.push(Some(cell.into()));
            }
        }
    }

    /// Lines of at most `width` characters.
    pub fn text(&self, width: usize) -> String {
        Text::of(self).lines(width)
    }

    pub fn push(&mut self, column: Column, values: Values<'a>) {
        self.columns.push(column);
        self.values.push(values);
    }

    pub fn rows(&self) -> usize {
        self.values.first().map_or(0, Values::count)
    }

    /// The column `name` of real numbers with its description; `None` if there is none.
    pub fn numbers(&self, name: &str) -> Option<(&Quantity, &[f64])> {
        let index = self.columns.iter().position(|column| column.quantity.name() == name)?;
        match &self.values[index] {
            Values::Real(values) => Some((&self.columns[index].quantity, values)),
            _ => None,
        }
    }
}

#[derive(Debug)]
pub struct TableOf<'a, R> {
    rows: &'a [R],
    table: Table<'a>,
}

impl<'a, R> TableOf<'a, R> {
    fn push(&mut self, name: &str, meaning: &str, content: Content, nullable: bool, values: Values<'a>) -> &mut Self {
        let quantity = Quantity::named(name.to_owned(), String::new(), meaning.to_owned());
        self.table.push(Column { nullable, ..Column::new(quantity, content) }, values);
        self
    }

    /// Adds a column of nullable numbers.
    pub fn real(&mut self, name: &str, meaning: &str, value: impl Fn(&'a R) -> Option<f64>) -> &mut Self {
        let values = self.rows.iter().map(|row| value(row).unwrap_or(f64::NAN)).collect();
        self.push(name, meaning, Content::Real, true, Values::Real(values))
    }

    pub fn count(&mut self, name: &str, meaning: &str, value: impl Fn(&'a R) -> u64) -> &mut Self {
        let values = self.rows.iter().map(value).collect();
        self.push(name, meaning, Content::Count, false, Values::Count(values))
    }

    /// Adds a column of nullable texts.
    pub fn text<T: Into<Cow<'a, str>>>(
        &mut self,
        name: &str,
        meaning: &str,
        value: impl Fn(&'a R) -> Option<T>,
    ) -> &mut Self {
        let values = self.rows.iter().map(|row| value(row).map(Into::into)).collect();
        self.push(name, meaning, Content::Word, true, Values::Text(values))
    }

    pub fn word<T: Into<Cow<'a, str>>>(&mut self, name: &str, meaning: &str, value: impl Fn(&'a R) -> T) -> &mut Self {
        self.push(name, meaning, Content::Word, false, Values::words(self.rows.iter().map(value)))
    }

    /// Adds the columns of an observable: its name, unit and meaning.
    pub fn observable(&mut self, quantity: impl Fn(&'a R) -> &'a Quantity) -> &mut Self {
        self.text("observable", "Name of the observable.", |row| Some(quantity(row).name()))
            .text("unit", "Its unit; empty for a pure number.", |row| Some(quantity(row).unit()))
            .text("meaning", "What it is.", |row| Some(quantity(row).meaning()))
    }

    pub fn unit(&mut self, unit: &str) -> &mut Self {
        if let Some(Column { quantity, .. }) = self.table.columns.last_mut() {
            let [name, meaning] = [quantity.name(), quantity.meaning()].map(str::to_owned);
            *quantity = Quantity::named(name, unit.to_owned(), meaning);
        }
        self
    }

    pub fn note(&mut self, key: &str, text: impl Into<String>) -> &mut Self {
        self.table.notes.insert(key.to_owned(), text.into());
        self
    }

    pub fn finish(&mut self) -> Table<'a> {
        std::mem::take(&mut self.table)
    }
}
