//! Tables in a single file: [`TableFormat`] by extension, [`TableError`], and [`write_csv`].

use std::io::{self, Write};
use std::path::Path;

use parquet::errors::ParquetError;
use thiserror::Error;

use crate::storage::columnar::Heading;

/// The formats of a table in a single file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TableFormat {
    Parquet,
    Csv,
}

/// Why a table could not be written.
#[derive(Debug, Error)]
pub enum TableError {
    /// The extension is neither Parquet nor CSV.
    #[error("a table is written as .parquet or .csv, and `{0}` is neither")]
    Format(String),
    /// An operation on the file failed.
    #[error(transparent)]
    Io(#[from] io::Error),
    #[error(transparent)]
    Parquet(#[from] ParquetError),
}

impl TableFormat {
    /// The format that the extension of `path` names.
    ///
    /// # Errors
    /// [`TableError::Format`].
    pub fn of(path: &Path) -> Result<Self, TableError> {
        match path.extension().and_then(|extension| extension.to_str()).map(str::to_ascii_lowercase).as_deref() {
            Some("parquet") => Ok(TableFormat::Parquet),
            Some("csv") => Ok(TableFormat::Csv),
            _ => Err(TableError::Format(path.display().to_string())),
        }
    }
}

/// Writes the first line of a table as CSV: the names of `headings`.
///
/// # Errors
/// What `out` returns.
pub fn csv_header(out: &mut impl Write, headings: &[Heading]) -> io::Result<()> {
    let names: Vec<&str> = headings.iter().map(|heading| heading.quantity.name()).collect();
    writeln!(out, "{}", names.join(","))
}

/// Writes a number with the fewest digits that read back to the same bits; nothing for what is no finite number, as in Parquet.
///
/// # Errors
/// What `out` returns.
pub fn write_number(out: &mut impl Write, number: f64) -> io::Result<()> {
    if number.is_finite() { write!(out, "{number:?}") } else { Ok(()) }
}

/// Writes a table as CSV: the names of `headings`, then `rows` rows. `cells` writes the cells of one row, separated by commas.
///
/// # Errors
/// What `out` returns.
pub fn write_csv<W: Write>(
    out: &mut W,
    headings: &[Heading],
    rows: usize,
    cells: impl Fn(&mut W, usize) -> io::Result<()>,
) -> io::Result<()> {
    csv_header(out, headings)?;
    for row in 0..rows {
        cells(out, row)?;
        writeln!(out)?;
    }
    Ok(())
}
