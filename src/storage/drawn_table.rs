//! Sampled parameters as a table, Parquet or CSV, written as they are drawn.

use std::io::{self, Write};
use std::path::Path;

use crate::campaign::Plan;
use crate::ensemble::DrawnScenes;
use crate::ensemble::drawn::MASS_COLUMNS;
use crate::run::{Quantity, Status};
use crate::storage::atomic;
use crate::storage::columnar::{Cells, Content, Heading, Layout, Packing};
use crate::storage::identity::provenance;
use crate::storage::rows_file::{SAMPLE_ID, STATUS, parameter_headings};
use crate::storage::table::{TableError, TableFormat, csv_header, write_number};

/// Status of a sample that is physical; one that is not has the status of its row.
pub const PHYSICAL: &str = "drawn";

/// The columns: number, status, dispersed values, mass properties.
pub fn headings(plan: &Plan) -> Vec<Heading> {
    let number = "Number of the sample within the campaign; 0 is the nominal scene.";
    let status = "drawn, or invalid_sample where the scene is not physical.";
    let fixed = [(SAMPLE_ID, number, Content::Count), (STATUS, status, Content::Word)]
        .map(|(name, meaning, content)| Heading::new(Quantity::new(name, "", meaning), content));
    let mass =
        MASS_COLUMNS.map(|[name, unit, meaning]| Heading::new(Quantity::new(name, unit, meaning), Content::Real));
    fixed.into_iter().chain(parameter_headings(plan)).chain(mass).collect()
}

/// The columns of `drawn`, whose mass properties were asked for.
pub fn cells(drawn: &DrawnScenes) -> impl Iterator<Item = Cells<'_>> {
    let first = drawn.first.0;
    let fixed = [
        Cells::Count((first..first + drawn.count() as u64).collect(), None),
        Cells::Word(drawn.physical.iter().map(|physical| status(*physical)).collect()),
    ];
    fixed.into_iter().chain(drawn.columns.iter().chain(&drawn.mass).map(|column| Cells::Real(column, None)))
}

/// Writes the sampled parameters of `plan` to `path`, in the format of its extension; the file is whole or absent. Samples are drawn as
/// they are written; `seen` is shown each part of them.
///
/// # Errors
/// [`TableError`].
pub fn save(plan: &Plan, path: &Path, mut seen: impl FnMut(&DrawnScenes)) -> Result<(), TableError> {
    match TableFormat::of(path)? {
        TableFormat::Csv => atomic::write(path, |file| {
            csv_header(file, &headings(plan))?;
            DrawnScenes::visit(plan, true, |drawn| {
                seen(drawn);
                write_csv(file, drawn)
            })
        })
        .map_err(TableError::Io),
        TableFormat::Parquet => {
            let layout = Layout::new(&headings(plan), provenance(plan), Packing::Zstd)?;
            let written = |file: &mut _| {
                let mut writer = layout.begin(file, &[])?;
                DrawnScenes::visit(plan, true, |drawn| {
                    seen(drawn);
                    writer.group(cells(drawn))
                })?;
                writer.finish()
            };
            atomic::write(path, written).map_err(TableError::Parquet)
        }
    }
}

/// Writes samples as lines of CSV.
fn write_csv(out: &mut impl Write, drawn: &DrawnScenes) -> io::Result<()> {
    for (row, physical) in drawn.physical.iter().enumerate() {
        write!(out, "{},{}", drawn.first.0 + row as u64, status(*physical))?;
        drawn.columns.iter().chain(&drawn.mass).try_for_each(|column| {
            out.write_all(b",")?;
            write_number(out, column[row])
        })?;
        writeln!(out)?;
    }
    Ok(())
}

fn status(physical: bool) -> &'static str {
    if physical { PHYSICAL } else { Status::InvalidSample.name() }
}
