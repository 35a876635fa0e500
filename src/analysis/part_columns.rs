//! [`PartColumns`]: the columns of one part by name, from its file or from the rows in memory. Both give the same numbers.

use std::borrow::Cow;
use std::collections::HashMap;

use crate::campaign::columns::parameter_quantity;
use crate::ensemble::{Ensemble, Rows};
use crate::run::Status;
use crate::sampling::SampleId;
use crate::storage::rows_reader::{PartReader, RowsError};

/// The columns of one part.
pub trait PartColumns {
    /// Number of rows.
    fn rows(&self) -> usize;

    /// The numbers of the samples, row by row.
    ///
    /// # Errors
    /// Where they cannot be read.
    fn samples(&self) -> Result<Vec<SampleId>, RowsError>;

    /// How each run ended.
    ///
    /// # Errors
    /// Where that cannot be read.
    fn statuses(&self) -> Result<Cow<'_, [Status]>, RowsError>;

    /// The numbers of the column `name`, row by row: counts as doubles, NaN where there is none.
    ///
    /// # Errors
    /// Where there is no such column of numbers, or it cannot be read.
    fn numbers(&self, name: &str) -> Result<Cow<'_, [f64]>, RowsError>;
}

impl PartColumns for PartReader {
    fn rows(&self) -> usize {
        self.rows()
    }

    fn samples(&self) -> Result<Vec<SampleId>, RowsError> {
        self.samples()
    }

    fn statuses(&self) -> Result<Cow<'_, [Status]>, RowsError> {
        self.statuses().map(Cow::Owned)
    }

    fn numbers(&self, name: &str) -> Result<Cow<'_, [f64]>, RowsError> {
        self.numbers(name).map(Cow::Owned)
    }
}

/// Where a column is in a block of rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Position {
    Parameter(usize),
    Observable(usize),
}

/// The columns of the rows of a campaign by name.
#[derive(Clone, Debug)]
pub struct RowNames(HashMap<String, Position>);

impl RowNames {
    /// Those of `ensemble`.
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
        RowNames(parameters.chain(observables).collect())
    }

    /// The columns of `rows`.
    pub fn of<'r>(&'r self, rows: &'r Rows) -> RowsInMemory<'r> {
        RowsInMemory { names: self, rows }
    }
}

/// Rows in memory with the names of their columns.
#[derive(Clone, Copy, Debug)]
pub struct RowsInMemory<'r> {
    names: &'r RowNames,
    rows: &'r Rows,
}

impl PartColumns for RowsInMemory<'_> {
    fn rows(&self) -> usize {
        self.rows.part().count
    }

    fn samples(&self) -> Result<Vec<SampleId>, RowsError> {
        Ok(self.rows.samples().to_vec())
    }

    fn statuses(&self) -> Result<Cow<'_, [Status]>, RowsError> {
        Ok(Cow::Borrowed(self.rows.statuses()))
    }

    fn numbers(&self, name: &str) -> Result<Cow<'_, [f64]>, RowsError> {
        let found = match self.names.0.get(name) {
            Some(Position::Parameter(index)) => Some(self.rows.parameter(*index)),
            Some(Position::Observable(index)) => Some(self.rows.observable(*index)),
            None => None,
        };
        match found {
            // what is not finite is absent in both
            Some(values) => Ok(Cow::Borrowed(values)),
            None => Err(RowsError { path: "rows".to_owned(), what: format!("there is no column `{name}`") }),
        }
    }
}
