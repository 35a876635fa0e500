//! Sampled parameters as a table, Parquet or CSV, written while drawn.

use super::store::Result;
use crate::campaign::Plan;
use crate::ensemble::DrawnScenes;
use crate::ensemble::drawn::MASS_COLUMNS;
use crate::run::{Quantity, Status};
use crate::storage::atomic;
use crate::storage::columnar::{Layout, Packing};
use crate::storage::identity::provenance;
use crate::storage::rows_file::{fixed_columns, parameter_columns};
use crate::storage::store::Failure;
use crate::storage::table_file::TableFormat;
use crate::table::{Column, Content, Values, csv};
use std::path::Path;

/// Status of a physical sample; others have the status of their row.
pub const PHYSICAL: &str = "drawn";

/// The columns: number, status, dispersed values, mass properties.
pub fn columns(plan: &Plan) -> Vec<Column> {
    let fixed = fixed_columns("drawn, or invalid_sample where the scene is not physical.");
    let mass = MASS_COLUMNS.map(|[name, unit, meaning]| Column::new(Quantity::new(name, unit, meaning), Content::Real));
    fixed.into_iter().chain(parameter_columns(plan)).chain(mass).collect()
}

/// The values of the columns in `drawn`, which has mass properties.
pub fn values(drawn: &DrawnScenes) -> Vec<Values<'_>> {
    let first = drawn.first.0;
    let fixed = [
        Values::Count((first..first + drawn.count() as u64).collect()),
        Values::words(drawn.physical.iter().map(|is| if *is { PHYSICAL } else { Status::InvalidSample.name() })),
    ];
    let numbers = drawn.columns.iter().chain(&drawn.mass).map(|column| Values::Real(column.into()));
    fixed.into_iter().chain(numbers).collect()
}

/// Writes the sampled parameters of `plan` to `path`, in the format of its extension; the file is whole or absent.
/// `seen` receives each part.
///
/// # Errors
/// An unknown extension, or a failure of writing.
pub fn save(plan: &Plan, path: &Path, mut seen: impl FnMut(&DrawnScenes)) -> Result<(), Failure> {
    match TableFormat::of(path)? {
        TableFormat::Csv => atomic::write(path, |file| {
            csv::header(file, &columns(plan))?;
            DrawnScenes::visit(plan, true, |drawn| {
                seen(drawn);
                Ok(csv::rows(file, &values(drawn))?)
            })
        }),
        TableFormat::Parquet => {
            let layout = Layout::new(&columns(plan), provenance(plan), Packing::Zstd)?;
            atomic::write(path, |file| {
                let mut writer = layout.begin(file, &[])?;
                DrawnScenes::visit(plan, true, |drawn| {
                    seen(drawn);
                    writer.group(values(drawn).into_iter())
                })?;
                Ok(writer.finish()?)
            })
        }
    }
}
