//! [`RowsFile`]: the files of rows, from the table of observables and the dispersed parameters.

use std::collections::HashMap;
use std::io::Write;
use std::path::Path;

use parquet::errors::ParquetError;

use crate::campaign::{Compression, Plan};
use crate::dataset::atomic;
use crate::dataset::columnar::{Cells, Content, Heading, Layout, Packing};
use crate::ensemble::audit::COLUMNS;
use crate::ensemble::{Ensemble, PartId, Rows};
use crate::observables::Kind;
use crate::run::Status;

/// Name of the column that numbers the samples.
pub const SAMPLE_ID: &str = "sample_id";
/// Name of the column that says how a run ended.
pub const STATUS: &str = "status";

/// What the files of rows of one campaign have in common.
#[derive(Clone, Debug)]
pub struct RowsFile {
    layout: Layout,
    /// Content of each observable.
    contents: Vec<Content>,
    is_audited: bool,
}

/// The name of the file that holds `part`.
pub fn file_name(part: PartId) -> String {
    format!("part-{:06}.parquet", part.0)
}

/// The columns of a row.
pub fn headings(campaign: &Ensemble<'_>) -> Vec<Heading> {
    let fixed = [
        (SAMPLE_ID, "Number of the sample within the campaign; 0 is the nominal scene.", Content::Count),
        (STATUS, "How the run ended: ok, step_limit, step_floor, non_finite, invalid_sample.", Content::Word),
    ];
    let fixed = fixed.map(|(name, meaning, content)| Heading {
        name: name.to_owned(),
        unit: String::new(),
        meaning: meaning.to_owned(),
        content,
        nullable: false,
    });
    let observables = campaign.request().columns().into_iter().map(|column| Heading {
        name: column.name.to_owned(),
        unit: column.unit.to_owned(),
        meaning: column.meaning.to_owned(),
        content: content(column.kind),
        nullable: true,
    });
    let audited = campaign.plan().audit_fraction > 0.0;
    let audits = COLUMNS.iter().filter(|_| audited).map(|column| Heading {
        name: column.name.to_owned(),
        unit: column.unit.to_owned(),
        meaning: column.meaning.to_owned(),
        content: Content::Real,
        nullable: true,
    });
    fixed.into_iter().chain(parameter_headings(campaign.plan())).chain(observables).chain(audits).collect()
}

/// The columns of dispersed values.
pub fn parameter_headings(plan: &Plan) -> impl Iterator<Item = Heading> {
    plan.dispersions.columns().iter().map(|column| Heading {
        name: column.parameter.column_name(column.component),
        unit: match column.parameter.unit() {
            "1" => String::new(),
            unit => unit.to_owned(),
        },
        meaning: format!("{} as applied.", column.parameter.component_name(column.component)),
        content: Content::Real,
        nullable: false,
    })
}

fn content(kind: Kind) -> Content {
    match kind {
        Kind::Float => Content::Real,
        Kind::Count => Content::Count,
    }
}

/// What every file of a campaign says about its origin. The instruction set is not in it: no bit depends on it.
pub fn provenance(plan: &Plan) -> HashMap<String, String> {
    let pairs = [
        ("spindrift.version", env!("CARGO_PKG_VERSION").to_owned()),
        ("spindrift.campaign", plan.name.clone()),
        ("spindrift.seed", plan.seed.to_string()),
        ("spindrift.plan_hash", plan.hash()),
        ("spindrift.plan", plan.text()),
    ];
    pairs.map(|(key, value)| (key.to_owned(), value)).into()
}

/// How the files of `plan` are packed.
pub fn packing(plan: &Plan) -> Packing {
    match plan.compression {
        Compression::Lz4 => Packing::Lz4,
        Compression::Zstd => Packing::Zstd,
        Compression::None => Packing::Plain,
    }
}

impl RowsFile {
    /// The files of `campaign`.
    ///
    /// # Errors
    /// Where two columns have one name.
    pub fn new(campaign: &Ensemble<'_>) -> Result<Self, ParquetError> {
        let layout = Layout::new(&headings(campaign), provenance(campaign.plan()), packing(campaign.plan()))?;
        let contents = campaign.request().columns().into_iter().map(|column| content(column.kind)).collect();
        Ok(RowsFile { layout, contents, is_audited: campaign.plan().audit_fraction > 0.0 })
    }

    /// Number of columns.
    pub fn columns(&self) -> usize {
        self.layout.schema().fields().len()
    }

    /// Writes `rows` as the file `path`, which is whole or absent.
    ///
    /// # Errors
    /// Where writing fails.
    pub fn save(&self, rows: &Rows, path: &Path) -> Result<(), ParquetError> {
        atomic::write(path, |file| self.write(rows, file))
    }

    /// Writes `rows` to `out`.
    ///
    /// A number that a failed run does not have is null; in a run that is `ok` a value that is not a number stays one, so
    /// that nobody takes it for a missing run.
    ///
    /// # Errors
    /// Where writing fails.
    pub fn write<W: Write + Send>(&self, rows: &Rows, out: W) -> Result<(), ParquetError> {
        let own = [
            ("spindrift.part", rows.part().id.0.to_string()),
            ("spindrift.first_sample", rows.part().first.to_string()),
            ("spindrift.samples", rows.part().count.to_string()),
        ];
        let shape = rows.shape();
        let masks = masks(rows);
        let fixed = [
            Cells::Count(rows.part().samples().map(|sample| sample.0).collect(), None),
            Cells::Word(rows.statuses().iter().map(|status| status.name()).collect()),
        ];
        let parameters = (0..shape.parameters).map(|index| Cells::Real(rows.parameter(index), None));
        let observables = (0..shape.observables).map(|index| {
            let (values, mask) = (rows.observable(index), masks.as_ref().map(|masks| &masks[index][..]));
            match self.contents[index] {
                Content::Count => Cells::Count(values.iter().map(|value| *value as u64).collect(), mask),
                _ => Cells::Real(values, mask),
            }
        });
        let (audited, audits) = if self.is_audited { audit_columns(rows) } else { (Vec::new(), Vec::new()) };
        let audits = audits.iter().map(|column| Cells::Real(column, Some(&audited)));
        self.layout.write(out, &own, fixed.into_iter().chain(parameters).chain(observables).chain(audits))
    }
}

/// Which rows were audited, and the columns of the audits.
fn audit_columns(rows: &Rows) -> (Vec<bool>, Vec<Vec<f64>>) {
    let mut audited = vec![false; rows.part().count];
    let mut columns = vec![vec![f64::NAN; rows.part().count]; COLUMNS.len()];
    for (row, audit) in rows.audits() {
        let Some(audit) = audit else { continue };
        audited[*row] = true;
        for (column, value) in columns.iter_mut().zip(audit.values()) {
            column[*row] = value;
        }
    }
    (audited, columns)
}

/// Which values of each observable are there; `None` where all are.
fn masks(rows: &Rows) -> Option<Vec<Vec<bool>>> {
    if rows.statuses().iter().all(|status| *status == Status::Done) {
        return None;
    }
    let there = |(value, status): (&f64, &Status)| *status == Status::Done || !value.is_nan();
    let mask = |index: usize| rows.observable(index).iter().zip(rows.statuses()).map(there).collect();
    Some((0..rows.shape().observables).map(mask).collect())
}
