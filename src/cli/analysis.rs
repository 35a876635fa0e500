//! What is made of the rows of a campaign once they are on the disk: statistics, sensitivities, verdicts. It depends on plan and files only.

use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

use crate::campaign::Plan;
use crate::cli::command_outcome::Failure;
use crate::dataset::names::BANDS;
use crate::dataset::rows_reader::RowsReader;
use crate::dataset::running_counts::Counted;
use crate::dataset::sensitivity::InputSensitivity;
use crate::dataset::statistics::Statistics;
use crate::dataset::verdicts::Verdicts;
use crate::dataset::{
    atomic, bands_file, bands_table, sensitivity, sensitivity_table, statistics, statistics_table, verdicts,
};
use crate::ensemble::Bands;
use crate::report::requirements;

/// What the rows say.
#[derive(Clone, Debug)]
pub struct Analysed {
    /// Of every observable.
    pub statistics: Statistics,
    /// Of the requirements.
    pub verdicts: Verdicts,
    /// Of what drives the main observables.
    pub sensitivities: Vec<InputSensitivity>,
    /// Over time, where the campaign has bands.
    pub bands: Option<Bands>,
}

/// Makes the tables of the result of `plan` in the folder `root` from its rows, and the files `bands` of its bands.
///
/// # Errors
/// Where a file cannot be read or written.
pub fn analyse(
    plan: &Plan,
    reader: &RowsReader,
    bands: &[PathBuf],
    root: &Path,
    counted: Option<Counted>,
    threads: Option<NonZeroUsize>,
) -> Result<Analysed, Failure> {
    let found = computed(plan, reader, bands, counted, threads)?;
    let path = root.join(statistics_table::FILE);
    statistics_table::save(plan, &found.statistics, &path).map_err(|error| in_file(&path, &error))?;
    let path = root.join(sensitivity_table::FILE);
    sensitivity_table::save(plan, &found.sensitivities, &path).map_err(|error| in_file(&path, &error))?;
    if let Some(bands) = &found.bands {
        let path = root.join(BANDS);
        bands_table::save(plan, bands, &path).map_err(|error| in_file(&path, &error))?;
    }
    Ok(found)
}

/// What the rows and the files `bands` of the bands of `plan` say, or what was counted while they were made; nothing is written.
///
/// # Errors
/// Where a file cannot be read.
pub fn computed(
    plan: &Plan,
    reader: &RowsReader,
    bands: &[PathBuf],
    counted: Option<Counted>,
    threads: Option<NonZeroUsize>,
) -> Result<Analysed, Failure> {
    let (columns, counted_bands) = counted.map(|counted| (counted.columns, counted.bands)).unzip();
    let bands = match counted_bands {
        Some(bands) => bands,
        None => bands_file::read(bands, threads).map_err(Failure::files)?,
    };
    Ok(Analysed {
        statistics: statistics::compute(plan, reader, columns, threads).map_err(Failure::files)?,
        sensitivities: sensitivity::compute(plan, reader, threads).map_err(Failure::files)?,
        verdicts: verdicts::assess(plan, reader, bands.as_ref(), threads).map_err(Failure::files)?,
        bands,
    })
}

/// Writes the verdicts as JUnit XML, where a file for it was named; `failed` runs are not `ok`.
///
/// # Errors
/// Where the file cannot be written.
pub fn write_junit(plan: &Plan, verdicts: &Verdicts, failed: u64, file: Option<&Path>) -> Result<(), Failure> {
    let Some(file) = file else { return Ok(()) };
    let text = requirements::junit(plan, verdicts, failed);
    atomic::write_bytes(file, text.as_bytes()).map_err(|error| in_file(file, &error))
}

fn in_file(path: &Path, error: &dyn std::fmt::Display) -> Failure {
    Failure::files(format!("{}: {error}", path.display()))
}
