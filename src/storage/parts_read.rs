//! [`PartsRead`]: the files of the parts of a dataset by what is in them.

use std::path::PathBuf;

use crate::storage::manifest::PartRecord;

/// The files of parts, in the order of the parts.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PartsRead {
    /// Files of rows.
    pub rows: Vec<PathBuf>,
    /// Files of bands.
    pub bands: Vec<PathBuf>,
}

impl PartsRead {
    /// Those of `parts`; `path` finds a file by its name.
    pub fn of(parts: &[PartRecord], path: impl Fn(&str) -> PathBuf) -> Self {
        let files = parts.iter().flat_map(|part| &part.files).map(|file| path(&file.name));
        let (rows, bands) = files.partition(|path| path.extension().is_some_and(|extension| extension == "parquet"));
        PartsRead { rows, bands }
    }
}
