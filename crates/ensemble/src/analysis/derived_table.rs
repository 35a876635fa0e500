//! `observables.parquet`: the derived observables (`[[observable]]`), sample by sample.
//!
//! They follow from the rows: a changed expression needs no new run.

use super::observed::Observed;
use crate::campaign::Plan;
use crate::run::Status;
use crate::storage::columnar::{Layout, Packing};
use crate::storage::identity::provenance;
use crate::storage::rows_file::fixed_columns;
use crate::storage::rows_reader::{PartReader, Result, RowsError, RowsReader};
use crate::storage::store::Failure;
use crate::table::{Column, Content, Values};

/// The file of the campaign `plan`, from its rows, part by part; `None` without derived observables.
///
/// # Errors
/// If the rows cannot be read, or the table not be encoded.
pub fn encoded(plan: &Plan, reader: &RowsReader) -> Result<Option<Vec<u8>>, Failure> {
    let names = plan.analysis.derived.iter().map(|derived| derived.name.as_str());
    let derived = Observed::named(plan, names);
    if derived.is_empty() {
        return Ok(None);
    }
    let fixed = fixed_columns("How the run ended, as in the rows.");
    let of_derived = derived.iter().map(|one| Column::new(one.quantity.clone(), Content::Real));
    let columns: Vec<Column> = fixed.into_iter().chain(of_derived).collect();
    let layout = Layout::new(&columns, provenance(plan), Packing::Zstd)?;
    let mut bytes = Vec::new();
    let mut writer = layout.begin(&mut bytes, &[])?;
    for part in (0..).map_while(|index| reader.part(index)) {
        let part: PartReader = part?;
        let samples = part.samples()?.into_iter().map(|sample| sample.0).collect();
        let statuses: Vec<Status> = part.statuses()?;
        let fixed = [Values::Count(samples), Values::words(statuses.iter().map(|status| status.name()))];
        let values = |one: &Observed| {
            let mut values = one.column(&part)?.into_owned();
            let failed = values.iter_mut().zip(&statuses).filter(|(_, status)| **status != Status::Done);
            failed.for_each(|(value, _)| *value = f64::NAN);
            Ok::<_, RowsError>(Values::Real(values.into()))
        };
        let values = derived.iter().map(values).collect::<Result<Vec<_>, _>>()?;
        writer.group(fixed.into_iter().chain(values))?;
    }
    writer.finish()?;
    Ok(Some(bytes))
}
