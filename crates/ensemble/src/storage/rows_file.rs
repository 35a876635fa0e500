//! [`RowsFile`]: the files of rows: dispersed parameters, observables, audits.

use super::store::Result;
use crate::campaign::columns::parameter_quantity;
use crate::campaign::{Compression, Plan};
use crate::ensemble::audit::AuditValue;
use crate::ensemble::{Ensemble, Rows};
use crate::observables::ColumnKind;
use crate::observables::headlines::headlines;
use crate::run::Quantity;
use crate::storage::columnar::{Layout, Packing};
use crate::storage::identity::{self, BANDS_KEY, Identity, SEAL_KEY, UNSEALED, part_metadata, row_provenance};
use crate::table::{Column, Content, Values};
use parquet::errors::ParquetError;
use std::io::Write;

pub const SAMPLE_ID: &str = "sample_id";
pub const STATUS: &str = "status";

/// Column of reasons why a run is not `ok`.
pub const REASON: &str = "reason";

/// Column of reasons why a selected run has no audit.
pub const AUDIT_REASON: &str = "audit_reason";

#[derive(Clone, Debug)]
pub struct RowsFile {
    layout: Layout,
    contents: Vec<Content>,
    audits: Vec<AuditValue>,
    /// Indices of the observables with columns of numerical errors.
    audited: Vec<usize>,
}

pub fn audit_error_name(name: &str) -> String {
    format!("audit_error_{name}")
}

fn error_columns(ensemble: &Ensemble<'_>, indices: Vec<usize>) -> Vec<Column> {
    let columns = ensemble.request().columns();
    let column = |index: usize| {
        let quantity = &columns[index].quantity;
        let meaning =
            format!("True numerical error of {} in an audited run: |observed - reference solution|.", quantity.name());
        let name = audit_error_name(quantity.name());
        Column::new(Quantity::named(name, quantity.unit().to_owned(), meaning), Content::Real)
    };
    indices.into_iter().map(column).collect()
}

/// The observables with columns of numerical errors: the headlines, in a campaign with audits.
pub fn audited_observables(ensemble: &Ensemble<'_>) -> Vec<usize> {
    if ensemble.plan().audit_fraction > 0.0 { headlines(ensemble.request()) } else { Vec::new() }
}

/// The columns of numbers and of statuses, with the meaning `status`.
pub fn fixed_columns(status: &'static str) -> [Column; 2] {
    let number = "Number of the sample within the campaign; 0 is the nominal scene.";
    [(SAMPLE_ID, number, Content::Count), (STATUS, status, Content::Word)]
        .map(|(name, meaning, content)| Column::new(Quantity::new(name, "", meaning), content))
}

fn audit_values(ensemble: &Ensemble<'_>) -> impl Iterator<Item = AuditValue> + use<> {
    let is_audited = ensemble.plan().audit_fraction > 0.0;
    AuditValue::of_scenes(ensemble.request().debris).filter(move |_| is_audited)
}

pub fn columns(ensemble: &Ensemble<'_>) -> Vec<Column> {
    let status = "How the run ended: ok, step_limit, step_floor, non_finite, invalid_sample, inaccurate, \
        internal_error, \
         surface, diverged.";
    let reasons = |name, meaning| Column::new(Quantity::new(name, "", meaning), Content::Word).nullable();
    let observables = ensemble
        .request()
        .columns()
        .into_iter()
        .map(|column| Column::new(column.quantity.clone(), content(column.kind)).nullable());
    let audits = audit_values(ensemble).map(|value| Column::new(value.quantity().clone(), Content::Real));
    let errors = error_columns(ensemble, audited_observables(ensemble));
    let without = "Why a run that was selected for an audit has none; null in other rows.";
    let reason = (ensemble.plan().audit_fraction > 0.0).then(|| reasons(AUDIT_REASON, without));
    fixed_columns(status)
        .into_iter()
        .chain([reasons(REASON, "Why the run is not ok.")])
        .chain(parameter_columns(ensemble.plan()))
        .chain(observables)
        .chain(audits)
        .chain(errors)
        .chain(reason)
        .collect()
}

pub fn identity(ensemble: &Ensemble<'_>) -> Identity {
    identity::of(ensemble.plan(), &columns(ensemble))
}

pub fn parameter_columns(plan: &Plan) -> impl Iterator<Item = Column> {
    let columns = plan.dispersions.columns().iter();
    columns.map(|column| Column::new(parameter_quantity(column.parameter, column.component), Content::Real))
}

fn content(kind: ColumnKind) -> Content {
    match kind {
        ColumnKind::Float => Content::Real,
        ColumnKind::Count => Content::Count,
    }
}

fn packing(plan: &Plan) -> Packing {
    match plan.compression {
        Compression::Lz4 => Packing::Lz4,
        Compression::Zstd => Packing::Zstd,
        Compression::None => Packing::Plain,
    }
}

impl RowsFile {
    /// # Errors
    /// Two columns of one name.
    pub fn new(ensemble: &Ensemble<'_>) -> Result<Self, ParquetError> {
        let (plan, columns) = (ensemble.plan(), columns(ensemble));
        let origin = row_provenance(plan, &identity::of(plan, &columns));
        let layout = Layout::new(&columns, origin, packing(plan))?;
        let contents = ensemble.request().columns().into_iter().map(|column| content(column.kind)).collect();
        let audits = audit_values(ensemble).collect();
        Ok(RowsFile { layout, contents, audits, audited: audited_observables(ensemble) })
    }

    /// Writes `rows` to `out`, to be sealed afterwards ([`identity::seal`]); `bands` is the SHA-256 of the bands.
    ///
    /// NaN and infinite values are null, whether the run is `ok` or not.
    pub fn write<W: Write + Send>(&self, rows: &Rows, bands: Option<&str>, out: W) -> Result<(), ParquetError> {
        let first = rows.samples().first().copied().unwrap_or(rows.part().first);
        let bands = bands.map(|sha256| (BANDS_KEY, sha256.to_owned()));
        let seal = (SEAL_KEY, UNSEALED.to_owned());
        let own: Vec<_> = part_metadata(rows.part(), first).into_iter().chain(bands).chain([seal]).collect();
        let shape = rows.shape();
        let fixed = [
            Values::Count(rows.samples().iter().map(|sample| sample.0).collect()),
            Values::words(rows.statuses().iter().map(|status| status.name())),
            reasons(rows, rows.reasons()),
        ];
        let parameters = (0..shape.parameters).map(|index| Values::Real(rows.parameter(index).into()));
        let observables = self.contents.iter().enumerate().map(|(index, content)| match content {
            Content::Count => Values::Counted(rows.observable(index).into()),
            _ => Values::Real(rows.observable(index).into()),
        });
        let audits =
            audit_columns(rows, &self.audits, &self.audited).into_iter().map(|column| Values::Real(column.into()));
        let without = (!self.audits.is_empty()).then(|| reasons(rows, rows.audit_reasons()));
        self.layout.write(
            out,
            &own,
            fixed.into_iter().chain(parameters).chain(observables).chain(audits).chain(without),
        )
    }
}

fn reasons<'r>(rows: &Rows, list: &'r [(usize, String)]) -> Values<'r> {
    let mut texts = vec![None; rows.part().count];
    list.iter().for_each(|(row, reason)| texts[*row] = Some(reason.into()));
    Values::Text(texts)
}

/// The columns `values` of the audits, then the errors of the observables `indices`; NaN without audit.
fn audit_columns(rows: &Rows, values: &[AuditValue], indices: &[usize]) -> Vec<Vec<f64>> {
    let mut columns = vec![vec![f64::NAN; rows.part().count]; values.len() + indices.len()];
    for (row, audit) in rows.audits() {
        let Some(audit) = audit else { continue };
        for (column, value) in columns.iter_mut().zip(values) {
            column[*row] = audit.value(*value);
        }
        for (column, index) in columns[values.len()..].iter_mut().zip(indices) {
            column[*row] = audit.observables[*index];
        }
    }
    columns
}
