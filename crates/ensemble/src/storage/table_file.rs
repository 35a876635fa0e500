//! Tables in a single file: [`save`], in the [`TableFormat`] of its extension.

use super::store::Result;
use crate::campaign::Plan;
use crate::storage::atomic;
use crate::storage::columnar::{Packing, encoded};
use crate::storage::identity::provenance;
use crate::storage::store::Failure;
use crate::table::{Table, csv};
use std::path::Path;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TableFormat {
    Parquet,
    Csv,
}

impl TableFormat {
    /// The format of the extension of `path`.
    ///
    /// # Errors
    /// An unknown extension.
    pub fn of(path: &Path) -> Result<Self, String> {
        match path.extension().and_then(|extension| extension.to_str()).map(str::to_ascii_lowercase).as_deref() {
            Some("parquet") => Ok(TableFormat::Parquet),
            Some("csv") => Ok(TableFormat::Csv),
            _ => Err(format!("a table is written as .parquet or .csv, and `{}` is neither", path.display())),
        }
    }
}

/// Writes `table` of `plan` to `path`, in the format of its extension; the file is whole or absent.
///
/// # Errors
/// An unknown extension, or a failure of writing.
pub fn save(plan: &Plan, table: &Table<'_>, path: &Path) -> Result<(), Failure> {
    match TableFormat::of(path)? {
        TableFormat::Csv => atomic::write(path, |file| csv::write(file, table))?,
        TableFormat::Parquet => atomic::write_bytes(path, &encoded(table, provenance(plan), Packing::Lz4)?)?,
    }
    Ok(())
}
