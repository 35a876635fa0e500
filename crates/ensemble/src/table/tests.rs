//! Laws of the writers: a table with every kind of value is read back.

use super::{Cell, Column, Content, Table, Values, csv, json};
use crate::run::Quantity;

/// Fragile numbers: largest, smallest, signed zeros, 17 digits, and nulls.
const NUMBERS: [f64; 10] =
    [0.0, -0.0, 0.1 + 0.2, -1.5e300, f64::MAX, f64::MIN_POSITIVE, 5e-324, f64::NAN, f64::INFINITY, f64::NEG_INFINITY];

/// Fragile texts: delimiters, line ends, empty, absent, long.
pub(crate) fn texts() -> [Option<String>; 10] {
    let all = ["a,b", "say \"no\"", "two\nlines", "\r\n", "", "<b>&amp;'", "\u{3b1} \u{2212}1", " space ", "null"];
    let long = all.concat().repeat(40);
    std::array::from_fn(|row| match row {
        8 => None,
        9 => Some(long.clone()),
        row => Some(all[row].to_owned()),
    })
}

pub(crate) fn every_kind() -> Table<'static> {
    let counted = vec![0.0, 1.0, f64::NAN, 9_007_199_254_740_992.0, 4.0, f64::INFINITY, 6.0, 7.0, 8.0, 9.0];
    let mut table = Table::default();
    let quantity = |name: &str| Quantity::named(name.to_owned(), "m/s".to_owned(), format!("The \"{name}\"."));
    table.push(Column::new(quantity("count"), Content::Count), Values::Count((0..10).map(|row| row << 50).collect()));
    table.push(Column::new(quantity("real"), Content::Real), Values::Real(NUMBERS.to_vec().into()));
    let texts = texts().into_iter().map(|text| text.map(Into::into)).collect();
    table.push(Column::new(quantity("a, \"text\""), Content::Word).nullable(), Values::Text(texts));
    table.push(Column::new(quantity("counted"), Content::Count).nullable(), Values::Counted(counted.into()));
    table.push(Column::new(quantity("word"), Content::Word), Values::words(["ok"; 10]));
    table
}

/// Law: CSV cells, read by another implementation, equal those of the table bit for bit; null is empty.
#[test]
fn csv_comes_back() {
    let table = every_kind();
    let mut bytes = Vec::new();
    csv::write(&mut bytes, &table).unwrap();
    let mut reader = ::csv::Reader::from_reader(&bytes[..]);
    let names: Vec<&str> = table.columns.iter().map(|column| column.quantity.name()).collect();
    assert_eq!(reader.headers().unwrap(), names);
    let lines: Vec<::csv::StringRecord> = reader.records().map(Result::unwrap).collect();
    assert_eq!(lines.len(), table.rows());
    for (row, line) in lines.iter().enumerate() {
        for (values, found) in table.values.iter().zip(line) {
            match values.cell(row) {
                Cell::Null => assert_eq!(found, ""),
                Cell::Real(number) => assert_eq!(found.parse::<f64>().unwrap().to_bits(), number.to_bits()),
                Cell::Count(count) => assert_eq!(found.parse::<u64>(), Ok(count)),
                Cell::Text(text) => assert_eq!(found, text),
            }
        }
    }
}

/// Law: JSON cells equal those of the table bit for bit, also through text.
#[test]
fn json_comes_back() {
    let table = every_kind();
    let text = serde_json::to_string(&json::objects(&table)).unwrap();
    let objects: Vec<serde_json::Value> = serde_json::from_str(&text).unwrap();
    assert_eq!(objects.len(), table.rows());
    for (row, object) in objects.iter().enumerate() {
        for (column, values) in table.columns.iter().zip(&table.values) {
            let found = &object[column.quantity.name()];
            match values.cell(row) {
                Cell::Null => assert!(found.is_null()),
                Cell::Real(number) => assert_eq!(found.as_f64().map(f64::to_bits), Some(number.to_bits())),
                Cell::Count(count) => assert_eq!(found.as_u64(), Some(count)),
                Cell::Text(text) => assert_eq!(found.as_str(), Some(text)),
            }
        }
    }
}
