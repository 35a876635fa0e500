//! Tables as CSV (RFC 4180, with line feeds): a header, then a line per row. A null is an empty cell.

use std::io::{self, Write};

use crate::table::{Cell, Column, Table, Values};

/// Writes the column names.
///
/// # Errors Those of `out`.
pub fn header(out: &mut impl Write, columns: &[Column]) -> io::Result<()> {
    for (index, column) in columns.iter().enumerate() {
        out.write_all(if index == 0 { b"" } else { b"," })?;
        text(out, column.quantity.name())?;
    }
    writeln!(out)
}

/// Writes a line per row of the columns `values`; numbers in the shortest form that reads back exactly.
///
/// # Errors Those of `out`.
pub fn rows(out: &mut impl Write, values: &[Values<'_>]) -> io::Result<()> {
    for row in 0..values.first().map_or(0, Values::count) {
        for (index, values) in values.iter().enumerate() {
            out.write_all(if index == 0 { b"" } else { b"," })?;
            match values.cell(row) {
                Cell::Null => {}
                Cell::Real(number) => write!(out, "{number:?}")?,
                Cell::Count(count) => write!(out, "{count}")?,
                Cell::Text(words) => text(out, words)?,
            }
        }
        writeln!(out)?;
    }
    Ok(())
}

/// Writes `table`.
///
/// # Errors Those of `out`.
pub fn write(out: &mut impl Write, table: &Table<'_>) -> io::Result<()> {
    header(out, &table.columns)?;
    rows(out, &table.values)
}

/// Quotes texts with special characters, and empty ones, which are not null.
fn text(out: &mut impl Write, text: &str) -> io::Result<()> {
    if text.is_empty() || text.contains([',', '"', '\n', '\r']) {
        write!(out, "\"{}\"", text.replace('"', "\"\""))
    } else {
        out.write_all(text.as_bytes())
    }
}
