//! Tables as CSV (RFC 4180, with line feeds): a line of names, then a line for each row. A null is an empty cell.

use std::io::{self, Write};

use crate::table::{Cell, Column, Table, Values};

/// Writes the line of names.
///
/// # Errors
/// Those of `out`.
pub fn header(out: &mut impl Write, columns: &[Column]) -> io::Result<()> {
    for (index, column) in columns.iter().enumerate() {
        out.write_all(if index == 0 { b"" } else { b"," })?;
        text(out, column.quantity.name())?;
    }
    writeln!(out)
}

/// Writes a line for each row of `values`, which has the values of each column. A number has the fewest digits that
/// read back to the same bits.
///
/// # Errors
/// Those of `out`.
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
/// # Errors
/// Those of `out`.
pub fn write(out: &mut impl Write, table: &Table<'_>) -> io::Result<()> {
    header(out, &table.columns)?;
    rows(out, &table.values)
}

/// Writes a text, in quotes if it has letters with a meaning in CSV, or is empty, which is not the same as absent.
fn text(out: &mut impl Write, text: &str) -> io::Result<()> {
    if text.is_empty() || text.contains([',', '"', '\n', '\r']) {
        write!(out, "\"{}\"", text.replace('"', "\"\""))
    } else {
        out.write_all(text.as_bytes())
    }
}
