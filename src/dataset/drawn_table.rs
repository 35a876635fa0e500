//! [`DrawnTable`]: sampled parameters as a table, Parquet or CSV.

use std::io::{self, Write};
use std::path::Path;

use crate::campaign::Plan;
use crate::dataset::atomic;
use crate::dataset::columnar::{Cells, Content, Heading, Layout, Packing};
use crate::dataset::provenance::provenance;
use crate::dataset::rows_file::{SAMPLE_ID, STATUS, parameter_headings};
use crate::dataset::table::{TableError, TableFormat, write_csv};
use crate::ensemble::DrawnScenes;
use crate::run::{Quantity, Status};

/// Status of a sample that is physical; one that is not has the status of its row.
pub const PHYSICAL: &str = "drawn";

/// Sampled parameters of a campaign as a table.
#[derive(Clone, Copy, Debug)]
pub struct DrawnTable<'a> {
    /// The campaign.
    pub plan: &'a Plan,
    /// Its samples.
    pub drawn: &'a DrawnScenes,
}

impl DrawnTable<'_> {
    /// The columns: number, status, dispersed values.
    pub fn headings(&self) -> Vec<Heading> {
        let number = "Number of the sample within the campaign; 0 is the nominal scene.";
        let status = "drawn, or invalid_sample where the scene is not physical.";
        let fixed = [(SAMPLE_ID, number, Content::Count), (STATUS, status, Content::Word)]
            .map(|(name, meaning, content)| Heading::new(Quantity::new(name, "", meaning), content));
        fixed.into_iter().chain(parameter_headings(self.plan)).collect()
    }

    /// Writes the table to `path`, in the format of its extension; the file is whole or absent.
    ///
    /// # Errors
    /// [`TableError`].
    pub fn save(&self, path: &Path) -> Result<(), TableError> {
        match TableFormat::of(path)? {
            TableFormat::Csv => atomic::write(path, |file| self.write_csv(file)).map_err(TableError::Io),
            TableFormat::Parquet => {
                let layout = Layout::new(&self.headings(), provenance(self.plan), Packing::Zstd)?;
                let first = self.drawn.first.0;
                let ids = (first..first + self.drawn.count() as u64).collect();
                let fixed = [
                    Cells::Count(ids, None),
                    Cells::Word(self.drawn.physical.iter().map(|physical| status(*physical)).collect()),
                ];
                let values = self.drawn.columns.iter().map(|column| Cells::Real(column, None));
                let cells = fixed.into_iter().chain(values);
                atomic::write(path, |file| layout.write(file, &[], cells)).map_err(TableError::Parquet)
            }
        }
    }

    /// Writes the table as CSV. Numbers have the fewest digits that read back to the same bits.
    ///
    /// # Errors
    /// What `out` returns.
    pub fn write_csv(&self, out: &mut impl Write) -> io::Result<()> {
        write_csv(out, &self.headings(), self.drawn.count(), |out, row| {
            write!(out, "{},{}", self.drawn.first.0 + row as u64, status(self.drawn.physical[row]))?;
            self.drawn.columns.iter().try_for_each(|column| write!(out, ",{:?}", column[row]))
        })
    }
}

fn status(physical: bool) -> &'static str {
    if physical { PHYSICAL } else { Status::InvalidSample.name() }
}
