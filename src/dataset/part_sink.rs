//! [`PartSink`]: writes each part to a Parquet file of its own and counts its rows in the tally.

use std::sync::{Mutex, PoisonError};

use parquet::errors::ParquetError;
use thiserror::Error;

use crate::dataset::folder::Folder;
use crate::dataset::rows_file::RowsFile;
use crate::dataset::tally::Tally;
use crate::ensemble::{Ensemble, Rows, Sink};

/// Why rows could not be written.
#[derive(Debug, Error)]
#[error("{path}: {source}")]
pub struct PartError {
    /// The file.
    path: String,
    /// Why.
    source: ParquetError,
}

/// Writes parts into the folder of a result.
#[derive(Debug)]
pub struct PartSink<'f> {
    folder: &'f Folder,
    file: RowsFile,
    tally: Mutex<Tally>,
}

impl<'f> PartSink<'f> {
    /// A sink for the rows of `ensemble`.
    ///
    /// # Errors
    /// Where two columns have the same name.
    pub fn new(folder: &'f Folder, ensemble: &Ensemble<'_>) -> Result<Self, ParquetError> {
        Ok(PartSink { folder, file: RowsFile::new(ensemble)?, tally: Mutex::new(Tally::new(ensemble)) })
    }

    /// The statistics of all parts.
    pub fn into_tally(self) -> Tally {
        self.tally.into_inner().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Sink for PartSink<'_> {
    type Error = PartError;

    fn take(&self, rows: &Rows) -> Result<(), PartError> {
        let path = self.folder.part(rows.part().id);
        self.file.save(rows, &path).map_err(|source| PartError { path: path.display().to_string(), source })?;
        self.tally.lock().unwrap_or_else(PoisonError::into_inner).add(rows);
        Ok(())
    }
}
