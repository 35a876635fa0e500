//! [`PartsRead`]: the files of the parts of a dataset by what is in them.

use std::path::PathBuf;

use crate::storage::manifest::PartRecord;
use crate::storage::names::{PART_BANDS, RUNS};

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
        let names = || parts.iter().flat_map(|part| &part.files).map(|file| file.name.as_str());
        let of = |folder: &str| names().filter(|name| name.starts_with(folder)).map(&path).collect();
        PartsRead { rows: of(RUNS), bands: of(PART_BANDS) }
    }
}
