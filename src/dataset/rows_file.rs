//! [`RowsFile`]: the files of rows: dispersed parameters, observables, audits.

use std::io::Write;

use parquet::errors::ParquetError;

use crate::campaign::columns::parameter_quantity;
use crate::campaign::{Compression, Plan};
use crate::dataset::columnar::{Cells, Content, Heading, Layout, Packing};
use crate::dataset::provenance::row_provenance;
use crate::ensemble::audit::AuditValue;
use crate::ensemble::{Ensemble, Rows};
use crate::observables::Kind;
use crate::observables::headlines::headlines;
use crate::run::{Quantity, Status};

/// Name of the column that numbers the samples.
pub const SAMPLE_ID: &str = "sample_id";
/// Name of the column that says how a run ended.
pub const STATUS: &str = "status";

/// Name of the column that says why a run is not `ok`.
pub const REASON: &str = "reason";

/// Layout of the files of rows of one campaign.
#[derive(Clone, Debug)]
pub struct RowsFile {
    layout: Layout,
    /// Content of each observable.
    contents: Vec<Content>,
    /// The columns of audits; none where the campaign has no audits.
    audits: Vec<AuditValue>,
    /// The observables whose numerical errors are columns too, by their indices.
    audited: Vec<usize>,
}

/// The name of the column with the numerical error of the observable `name`.
pub fn audit_error_name(name: &str) -> String {
    format!("audit_error_{name}")
}

/// The columns of numerical errors of the observables `indices`.
fn error_headings(ensemble: &Ensemble<'_>, indices: Vec<usize>) -> Vec<Heading> {
    let columns = ensemble.request().columns();
    let heading = |index: usize| {
        let quantity = &columns[index].quantity;
        let meaning =
            format!("True numerical error of {} in an audited run: |observed - reference solution|.", quantity.name());
        Heading::new(
            Quantity::named(audit_error_name(quantity.name()), quantity.unit().to_owned(), meaning),
            Content::Real,
        )
    };
    indices.into_iter().map(|index| heading(index).nullable()).collect()
}

/// The observables whose numerical errors are columns: those with statistics in the summary, where the campaign has audits.
pub fn audited_observables(ensemble: &Ensemble<'_>) -> Vec<usize> {
    if ensemble.plan().audit_fraction > 0.0 { headlines(ensemble.request()) } else { Vec::new() }
}

/// The columns of a row.
pub fn headings(ensemble: &Ensemble<'_>) -> Vec<Heading> {
    let number = "Number of the sample within the campaign; 0 is the nominal scene.";
    let status =
        "How the run ended: ok, step_limit, step_floor, non_finite, invalid_sample, inaccurate, internal_error.";
    let reason = "Why the run is not ok.";
    let fixed = [(SAMPLE_ID, number, Content::Count), (STATUS, status, Content::Word), (REASON, reason, Content::Word)]
        .map(|(name, meaning, content)| Heading::new(Quantity::new(name, "", meaning), content))
        .map(|heading| if heading.quantity.name() == REASON { heading.nullable() } else { heading });
    let observables = ensemble
        .request()
        .columns()
        .into_iter()
        .map(|column| Heading::new(column.quantity.clone(), content(column.kind)).nullable());
    let audited = ensemble.plan().audit_fraction > 0.0;
    let audits = AuditValue::of_scenes(ensemble.request().debris)
        .filter(|_| audited)
        .map(|value| Heading::new(value.quantity().clone(), Content::Real).nullable());
    let errors = error_headings(ensemble, audited_observables(ensemble));
    fixed
        .into_iter()
        .chain(parameter_headings(ensemble.plan()))
        .chain(observables)
        .chain(audits)
        .chain(errors)
        .collect()
}

/// The columns of dispersed values.
pub fn parameter_headings(plan: &Plan) -> impl Iterator<Item = Heading> {
    let columns = plan.dispersions.columns().iter();
    columns.map(|column| Heading::new(parameter_quantity(column.parameter, column.component), Content::Real))
}

fn content(kind: Kind) -> Content {
    match kind {
        Kind::Float => Content::Real,
        Kind::Count => Content::Count,
    }
}

/// Encoding and compression of the files of `plan`.
fn packing(plan: &Plan) -> Packing {
    match plan.compression {
        Compression::Lz4 => Packing::Lz4,
        Compression::Zstd => Packing::Zstd,
        Compression::None => Packing::Plain,
    }
}

impl RowsFile {
    /// The files of `ensemble`.
    ///
    /// # Errors
    /// Where two columns have the same name.
    pub fn new(ensemble: &Ensemble<'_>) -> Result<Self, ParquetError> {
        let layout = Layout::new(&headings(ensemble), row_provenance(ensemble.plan()), packing(ensemble.plan()))?;
        let contents = ensemble.request().columns().into_iter().map(|column| content(column.kind)).collect();
        let is_audited = ensemble.plan().audit_fraction > 0.0;
        let audits = AuditValue::of_scenes(ensemble.request().debris).filter(|_| is_audited).collect();
        Ok(RowsFile { layout, contents, audits, audited: audited_observables(ensemble) })
    }

    /// Number of columns.
    pub fn columns(&self) -> usize {
        self.layout.schema().fields().len()
    }

    /// Writes `rows` to `out`.
    ///
    /// A value that a failed run does not have is null. In a run that is `ok` a NaN stays a NaN, so that it is not mistaken
    /// for the value of a failed run.
    ///
    /// # Errors
    /// Where writing fails.
    pub fn write<W: Write + Send>(&self, rows: &Rows, out: W) -> Result<(), ParquetError> {
        let own = [
            ("spindrift.part", rows.part().id.0.to_string()),
            ("spindrift.first_sample", rows.samples().first().copied().unwrap_or(rows.part().first).to_string()),
            ("spindrift.samples", rows.part().count.to_string()),
        ];
        let shape = rows.shape();
        let masks = masks(rows);
        let mut reasons = vec![None; rows.part().count];
        rows.reasons().iter().for_each(|(row, reason)| reasons[*row] = Some(reason.as_str()));
        let fixed = [
            Cells::Count(rows.samples().iter().map(|sample| sample.0).collect(), None),
            Cells::Word(rows.statuses().iter().map(|status| status.name()).collect()),
            Cells::Text(reasons),
        ];
        let parameters = (0..shape.parameters).map(|index| Cells::Real(rows.parameter(index), None));
        let observables = (0..shape.observables).map(|index| {
            let (values, mask) = (rows.observable(index), masks.as_ref().map(|masks| &masks[index][..]));
            match self.contents[index] {
                Content::Count => Cells::Count(values.iter().map(|value| *value as u64).collect(), mask),
                _ => Cells::Real(values, mask),
            }
        });
        let (audited, audits) = audit_columns(rows, &self.audits, &self.audited);
        let audits = audits.iter().map(|column| Cells::Real(column, Some(&audited)));
        self.layout.write(out, &own, fixed.into_iter().chain(parameters).chain(observables).chain(audits))
    }
}

/// Which rows were audited, and the columns `values` of the audits with the errors of the observables `indices`.
fn audit_columns(rows: &Rows, values: &[AuditValue], indices: &[usize]) -> (Vec<bool>, Vec<Vec<f64>>) {
    let mut audited = vec![false; rows.part().count];
    let mut columns = vec![vec![f64::NAN; rows.part().count]; values.len() + indices.len()];
    for (row, audit) in rows.audits() {
        let Some(audit) = audit else { continue };
        audited[*row] = true;
        for (column, value) in columns.iter_mut().zip(values) {
            column[*row] = audit.value(*value);
        }
        for (column, index) in columns[values.len()..].iter_mut().zip(indices) {
            column[*row] = audit.observables[*index];
        }
    }
    (audited, columns)
}

/// Which values of each observable are present; `None` where all are.
fn masks(rows: &Rows) -> Option<Vec<Vec<bool>>> {
    if rows.statuses().iter().all(|status| *status == Status::Done) {
        return None;
    }
    let present = |(value, status): (&f64, &Status)| *status == Status::Done || !value.is_nan();
    let mask = |index: usize| rows.observable(index).iter().zip(rows.statuses()).map(present).collect();
    Some((0..rows.shape().observables).map(mask).collect())
}
