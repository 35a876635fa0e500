//! [`compared`]: a comparison of two finished results, and its file.

use std::path::Path;

use crate::analysis::comparison::compare;
use crate::analysis::comparison_table;
use crate::analysis::pairing::ResultRows;
use crate::findings::compared::Compared;
use crate::report::comparison_json;
use crate::storage::atomic;
use crate::storage::columnar::{Packing, encoded};
use crate::storage::identity::provenance;
use crate::workflow::error::{Result, WorkflowError};
use crate::workflow::results::Results;

/// Compares the rows of two results, sample by sample if both drew the same ones; `names` are their names.
pub fn compared<'r>(results: [&'r Results<'_>; 2], names: [String; 2]) -> Result<Compared<'r>> {
    let [first, second] = results;
    let rows = results.map(|one| ResultRows { plan: one.plan(), reader: one.rows() });
    let comparison = compare(rows[0], rows[1], first.threads())?;
    let ends = [first.end()?.verdicts, second.end()?.verdicts];
    Ok(Compared::new(names, [first.plan(), second.plan()], comparison, ends))
}

#[derive(Clone, Copy, Debug)]
pub enum ComparisonFormat {
    Json,
    Parquet,
}

impl ComparisonFormat {
    /// The format of the extension of `path`.
    ///
    /// # Errors
    /// An unknown extension.
    pub fn of(path: &Path) -> Result<Self> {
        match path.extension().and_then(|extension| extension.to_str()).map(str::to_ascii_lowercase).as_deref() {
            Some("json") => Ok(ComparisonFormat::Json),
            Some("parquet") => Ok(ComparisonFormat::Parquet),
            _ => Err(WorkflowError::Input(format!(
                "--out {}: a comparison is written as .json or .parquet; choose one of these",
                path.display()
            ))),
        }
    }

    pub fn write(self, compared: &Compared<'_>, path: &Path) -> Result<()> {
        let bytes = match self {
            ComparisonFormat::Json => comparison_json::text(compared).into_bytes(),
            ComparisonFormat::Parquet => {
                let table = comparison_table::table(&compared.comparison);
                encoded(&table, provenance(compared.plans[0]), Packing::Zstd)
                    .map_err(|error| WorkflowError::at(path, error))?
            }
        };
        atomic::write_bytes(path, &bytes).map_err(|error| WorkflowError::at(path, error))
    }
}
