//! [`PartSink`]: the rows of each part into its own Parquet file, and into the tally.

use std::sync::{Mutex, PoisonError};

use parquet::errors::ParquetError;
use thiserror::Error;

use crate::dataset::folder::Folder;
use crate::dataset::rows_file::RowsFile;
use crate::ensemble::{Ensemble, Rows, Sink};
use crate::report::summary::Tally;

/// Why rows could not be kept.
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
    /// A sink for the rows of `campaign`.
    ///
    /// # Errors
    /// Where two columns have one name.
    pub fn new(folder: &'f Folder, campaign: &Ensemble<'_>) -> Result<Self, ParquetError> {
        Ok(PartSink { folder, file: RowsFile::new(campaign)?, tally: Mutex::new(Tally::new(campaign)) })
    }

    /// What the parts amount to.
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
