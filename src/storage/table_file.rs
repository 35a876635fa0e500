//! Tables in a single file: [`save`], in the [`TableFormat`] of its extension; [`TableError`].

use std::io;
use std::path::Path;

use parquet::errors::ParquetError;
use thiserror::Error;

use crate::campaign::Plan;
use crate::storage::atomic;
use crate::storage::columnar::{Packing, encoded};
use crate::storage::identity::provenance;
use crate::table::{Table, csv};

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

/// Writes `table` of `plan` to `path`, in the format of its extension; the file is whole or absent.
///
/// # Errors
/// [`TableError`].
pub fn save(plan: &Plan, table: &Table<'_>, path: &Path) -> Result<(), TableError> {
    match TableFormat::of(path)? {
        TableFormat::Csv => atomic::write(path, |file| csv::write(file, table))?,
        TableFormat::Parquet => atomic::write_bytes(path, &encoded(table, provenance(plan), Packing::Lz4)?)?,
    }
    Ok(())
}
