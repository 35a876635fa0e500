//! A small table that is made at the end of a campaign: its columns one by one, each with its meaning and its values, as one file.

use parquet::errors::ParquetError;
use serde_json::{Map, Value, json};

use crate::campaign::Plan;
use crate::run::Quantity;
use crate::storage::columnar::{Cells, Content, Heading, Layout, Packing};
use crate::storage::identity::provenance;

/// A column with its values.
#[derive(Clone, Debug)]
pub struct DescribedColumn {
    heading: Heading,
    values: Values,
}

#[derive(Clone, Debug)]
enum Values {
    Texts(Vec<Option<String>>),
    Counts(Vec<u64>),
    Reals(Vec<f64>, Vec<bool>),
}

fn quantity(name: &str, meaning: &str) -> Quantity {
    Quantity::named(name.to_owned(), String::new(), meaning.to_owned())
}

impl DescribedColumn {
    /// A column of texts, which may be absent.
    pub fn texts(name: &str, meaning: &str, texts: impl Iterator<Item = Option<String>>) -> Self {
        let heading = Heading::new(quantity(name, meaning), Content::Word).nullable();
        DescribedColumn { heading, values: Values::Texts(texts.collect()) }
    }

    pub fn counts(name: &str, meaning: &str, counts: impl Iterator<Item = u64>) -> Self {
        let heading = Heading::new(quantity(name, meaning), Content::Count);
        DescribedColumn { heading, values: Values::Counts(counts.collect()) }
    }

    /// A column of numbers, which may be absent. What is not a number is absent too: no reader's maximum becomes NaN.
    pub fn numbers(name: &str, meaning: &str, numbers: impl Iterator<Item = Option<f64>>) -> Self {
        let heading = Heading::new(quantity(name, meaning), Content::Real).nullable();
        let numbers = numbers.map(|number| number.filter(|number| !number.is_nan()));
        let (values, present) = numbers.map(|number| (number.unwrap_or(f64::NAN), number.is_some())).unzip();
        DescribedColumn { heading, values: Values::Reals(values, present) }
    }
}

impl DescribedColumn {
    /// Its name and meaning, and what it has.
    pub fn heading(&self) -> &Heading {
        &self.heading
    }

    pub fn cells(&self) -> Cells<'_> {
        match &self.values {
            Values::Texts(texts) => Cells::Text(texts.iter().map(Option::as_deref).collect()),
            Values::Counts(counts) => Cells::Count(counts.clone(), None),
            Values::Reals(values, present) => Cells::Real(values, Some(present)),
        }
    }
}

/// The rows of `columns`, all of one length, as objects with the names of the columns as keys.
pub fn json(columns: &[DescribedColumn]) -> Vec<Value> {
    let cell = |column: &DescribedColumn, row: usize| match &column.values {
        Values::Texts(texts) => json!(texts[row]),
        Values::Counts(counts) => json!(counts[row]),
        Values::Reals(values, present) => json!(present[row].then_some(values[row])),
    };
    let count = columns.first().map_or(0, |column| match &column.values {
        Values::Texts(texts) => texts.len(),
        Values::Counts(counts) => counts.len(),
        Values::Reals(values, _) => values.len(),
    });
    let object = |row: usize| {
        columns
            .iter()
            .map(|column| (column.heading.quantity.name().to_owned(), cell(column, row)))
            .collect::<Map<_, _>>()
    };
    (0..count).map(|row| Value::Object(object(row))).collect()
}

/// `columns`, all of one length, as a file of the result of `plan`.
///
/// # Errors
/// Where two columns have one name, or encoding fails.
pub fn encoded(plan: &Plan, columns: &[DescribedColumn]) -> Result<Vec<u8>, ParquetError> {
    let headings: Vec<Heading> = columns.iter().map(|column| column.heading.clone()).collect();
    let layout = Layout::new(&headings, provenance(plan), Packing::Zstd)?;
    let mut bytes = Vec::new();
    layout.write(&mut bytes, &[], columns.iter().map(DescribedColumn::cells))?;
    Ok(bytes)
}
