//! [`PartColumns`]: the columns of a part by name, identical from its file and from memory.

use crate::campaign::columns::parameter_quantity;
use crate::ensemble::audit::AuditValue;
use crate::ensemble::{Audit, Ensemble, Rows};
use crate::run::Status;
use crate::sampling::SampleId;
use crate::storage::rows_file::{audit_error_name, audited_observables};
use crate::storage::rows_reader::{PartReader, Result, RowsError};
use std::borrow::Cow;
use std::collections::HashMap;

pub trait PartColumns {
    fn rows(&self) -> usize;

    fn samples(&self) -> Result<Vec<SampleId>>;

    fn statuses(&self) -> Result<Cow<'_, [Status]>>;

    /// Rows that are not `ok`, with reasons.
    fn reasons(&self) -> Result<Cow<'_, [(usize, String)]>>;

    /// The column `name`: counts as doubles, NaN for none.
    ///
    /// # Errors There is no such column of numbers, or it cannot be read.
    fn numbers(&self, name: &str) -> Result<Cow<'_, [f64]>>;
}

impl PartColumns for PartReader {
    fn rows(&self) -> usize {
        self.rows()
    }

    fn samples(&self) -> Result<Vec<SampleId>> {
        self.samples()
    }

    fn statuses(&self) -> Result<Cow<'_, [Status]>> {
        self.statuses().map(Cow::Owned)
    }

    fn reasons(&self) -> Result<Cow<'_, [(usize, String)]>> {
        let reasons = self.reasons()?.into_iter().enumerate();
        Ok(reasons.filter_map(|(row, reason)| Some((row, reason?))).collect())
    }

    fn numbers(&self, name: &str) -> Result<Cow<'_, [f64]>> {
        self.numbers(name).map(Cow::Owned)
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Position {
    Parameter(usize),
    Observable(usize),
    Audit(AuditValue),
    AuditError(usize),
}

#[derive(Clone, Debug)]
pub struct RowNames(HashMap<String, Position>);

impl RowNames {
    pub fn new(ensemble: &Ensemble<'_>) -> Self {
        let parameters = ensemble.plan().dispersions.columns().iter().enumerate().map(|(index, column)| {
            let name = parameter_quantity(column.parameter, column.component).name().to_owned();
            (name, Position::Parameter(index))
        });
        let columns = ensemble.request().columns();
        let observables = columns
            .iter()
            .enumerate()
            .map(|(index, column)| (column.quantity.name().to_owned(), Position::Observable(index)));
        let audits = AuditValue::ALL.iter().map(|value| (value.quantity().name().to_owned(), Position::Audit(*value)));
        let errors = audited_observables(ensemble).into_iter().map(|index| {
            let name = audit_error_name(columns[index].quantity.name());
            (name, Position::AuditError(index))
        });
        RowNames(parameters.chain(observables).chain(audits).chain(errors).collect())
    }

    pub fn of<'r>(&'r self, rows: &'r Rows) -> RowsInMemory<'r> {
        RowsInMemory { names: self, rows }
    }
}

#[derive(Clone, Copy, Debug)]
pub struct RowsInMemory<'r> {
    names: &'r RowNames,
    rows: &'r Rows,
}

impl PartColumns for RowsInMemory<'_> {
    fn rows(&self) -> usize {
        self.rows.part().count
    }

    fn samples(&self) -> Result<Vec<SampleId>> {
        Ok(self.rows.samples().to_vec())
    }

    fn statuses(&self) -> Result<Cow<'_, [Status]>> {
        Ok(Cow::Borrowed(self.rows.statuses()))
    }

    fn reasons(&self) -> Result<Cow<'_, [(usize, String)]>> {
        Ok(Cow::Borrowed(self.rows.reasons()))
    }

    fn numbers(&self, name: &str) -> Result<Cow<'_, [f64]>> {
        let audits = |value: &dyn Fn(&Audit) -> f64| {
            let mut column = vec![f64::NAN; self.rows.part().count];
            let audited = self.rows.audits().iter().filter_map(|(row, audit)| Some((*row, audit.as_ref()?)));
            audited.for_each(|(row, audit)| column[row] = value(audit));
            Cow::Owned(column)
        };
        // non-finite numbers are absent, as in a file
        match self.names.0.get(name) {
            Some(Position::Parameter(index)) => Ok(Cow::Borrowed(self.rows.parameter(*index))),
            Some(Position::Observable(index)) => Ok(Cow::Borrowed(self.rows.observable(*index))),
            Some(Position::Audit(value)) => Ok(audits(&|audit| audit.value(*value))),
            Some(Position::AuditError(index)) => Ok(audits(&|audit| audit.observables[*index])),
            None => Err(RowsError { path: "rows".to_owned(), what: format!("there is no column `{name}`") }),
        }
    }
}
