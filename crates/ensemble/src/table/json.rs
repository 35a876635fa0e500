//! Tables as JSON: an object per row, keyed by column names.

use serde_json::{Map, Value, json};

use crate::table::{Cell, Table};

pub fn objects(table: &Table<'_>) -> Vec<Value> {
    let cell = |cell: Cell<'_>| match cell {
        Cell::Null => Value::Null,
        Cell::Real(number) => json!(number),
        Cell::Count(count) => json!(count),
        Cell::Text(text) => json!(text),
    };
    let object = |row: usize| {
        let cells = table.columns.iter().zip(&table.values);
        cells.map(|(column, values)| (column.quantity.name().to_owned(), cell(values.cell(row)))).collect::<Map<_, _>>()
    };
    (0..table.rows()).map(|row| Value::Object(object(row))).collect()
}
