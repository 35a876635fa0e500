//! [`ArrowTable`]: a table as Arrow's arrays: columns with units and meanings, which Arrow's C interface hands over
//! without a copy.
//!
//! Apache Arrow, *The Arrow PyCapsule Interface*: polars, pyarrow, pandas, DuckDB and others take an object with
//! `__arrow_c_stream__`.

use std::collections::HashMap;
use std::sync::Arc;

use arrow_array::cast::AsArray;
use arrow_array::ffi_stream::FFI_ArrowArrayStream;
use arrow_array::types::{Float64Type, Int64Type};
use arrow_array::{Array, ArrayRef, Float64Array, Int64Array, RecordBatch, RecordBatchIterator, StringArray};
use arrow_schema::{ArrowError, DataType, Field, Schema, SchemaRef};
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;
use pyo3::types::{PyCapsule, PyList};
use spindrift::campaign::Plan;
use spindrift::ensemble::{DrawnScenes, Ensemble};
use spindrift::run::Quantity;
use spindrift::storage::rows_reader::{PartReader, RowsError};
use spindrift::storage::{drawn_table, rows_file};
use spindrift::table::{Column, Content, Table, Values};
use spindrift::workflow::{Results, WorkflowError};

use crate::SpindriftError;

/// A table.
#[pyclass(name = "Table", module = "spindrift._native", frozen)]
pub struct ArrowTable {
    schema: SchemaRef,
    batches: Vec<RecordBatch>,
}

/// The values of a column as Arrow's; a number that is not finite is null, as in files.
fn array(values: Values<'_>) -> ArrayRef {
    match values {
        Values::Real(values) if values.iter().all(|value| value.is_finite()) => {
            Arc::new(Float64Array::from(values.into_owned()))
        }
        Values::Real(values) => {
            Arc::new(values.iter().map(|value| value.is_finite().then_some(*value)).collect::<Float64Array>())
        }
        Values::Count(values) => Arc::new(Int64Array::from_iter_values(values.into_iter().map(u64::cast_signed))),
        Values::Counted(values) => {
            Arc::new(values.iter().map(|value| value.is_finite().then_some(*value as i64)).collect::<Int64Array>())
        }
        Values::Text(texts) => Arc::new(texts.iter().map(Option::as_deref).collect::<StringArray>()),
    }
}

/// A field with unit and meaning in its metadata.
fn field(column: &Column) -> Field {
    let (quantity, of) = (
        &column.quantity,
        match column.content {
            Content::Real => DataType::Float64,
            Content::Count => DataType::Int64,
            Content::Word => DataType::Utf8,
        },
    );
    let metadata = [("unit", quantity.unit()), ("meaning", quantity.meaning())];
    let metadata = metadata.into_iter().filter(|(_, text)| !text.is_empty());
    let metadata: HashMap<String, String> = metadata.map(|(key, text)| (key.to_owned(), text.to_owned())).collect();
    Field::new(quantity.name(), of, true).with_metadata(metadata)
}

impl ArrowTable {
    /// Columns whose values come in batches.
    fn of_batches(columns: &[Column], batches: impl IntoIterator<Item = Vec<ArrayRef>>) -> Result<Self, WorkflowError> {
        let schema = Arc::new(Schema::new(columns.iter().map(field).collect::<Vec<_>>()));
        let batches = batches.into_iter().map(|arrays| RecordBatch::try_new(schema.clone(), arrays));
        let batches = batches.collect::<Result<_, ArrowError>>().map_err(WorkflowError::files)?;
        Ok(ArrowTable { schema, batches })
    }

    /// A table in memory.
    ///
    /// # Errors
    /// Where its columns differ in length.
    pub fn of(table: Table<'_>) -> Result<Self, WorkflowError> {
        ArrowTable::of_batches(&table.columns, [table.values.into_iter().map(array).collect()])
    }

    /// The rows of a result.
    ///
    /// # Errors
    /// Where a file cannot be read.
    pub fn of_rows(results: &Results<'_>) -> Result<Self, WorkflowError> {
        let columns = rows_file::columns(&Ensemble::new(results.plan(), spindrift::workflow::isa()?));
        let mut parts: Vec<Vec<ArrayRef>> = Vec::new();
        let read = |part: &mut PartReader| {
            let arrays = columns.iter().map(|column| part.values(column.quantity.name()).map(array));
            arrays.collect::<Result<Vec<_>, RowsError>>()
        };
        let merge = |part| {
            parts.push(part);
            Ok(())
        };
        results.rows().visit(None, read, merge)?;
        ArrowTable::of_batches(&columns, parts)
    }

    /// A small file of a result, whose columns are explained by their names and by columns of their own.
    ///
    /// # Errors
    /// Where it cannot be read.
    pub fn of_part(part: &PartReader) -> Result<Self, WorkflowError> {
        let mut table = Table::default();
        for name in part.names() {
            let values = part.values(&name)?;
            let quantity = Quantity::named(name, String::new(), String::new());
            table.push(Column::new(quantity, values.content()), values);
        }
        ArrowTable::of(table)
    }

    /// The dispersed parameters of all samples of `plan`, as long as `goes_on`, which is called now and then.
    ///
    /// # Errors
    /// Where columns differ in length, or it does not go on.
    pub fn of_draws(plan: &Plan, mut goes_on: impl FnMut() -> bool) -> Result<Self, WorkflowError> {
        let mut batches = Vec::new();
        DrawnScenes::visit(plan, true, |drawn| {
            if !goes_on() {
                return Err(WorkflowError::Input("stopped".to_owned()));
            }
            batches.push(drawn_table::values(drawn).into_iter().map(array).collect());
            Ok::<(), WorkflowError>(())
        })?;
        ArrowTable::of_batches(&drawn_table::columns(plan), batches)
    }

    /// What the metadata of each column say of `key`.
    fn said(&self, key: &str) -> HashMap<String, String> {
        let text = |field: &Arc<Field>| (field.name().clone(), field.metadata().get(key).cloned().unwrap_or_default());
        self.schema.fields().iter().map(text).collect()
    }
}

#[pymethods]
impl ArrowTable {
    /// Arrow's C stream of the table. Columns keep their types, whatever schema is requested.
    #[pyo3(signature = (requested_schema = None))]
    fn __arrow_c_stream__<'py>(
        &self,
        py: Python<'py>,
        requested_schema: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyCapsule>> {
        drop(requested_schema);
        let batches = self.batches.clone().into_iter().map(Ok);
        let reader = RecordBatchIterator::new(batches, self.schema.clone());
        PyCapsule::new_with_value(py, FFI_ArrowArrayStream::new(Box::new(reader)), c"arrow_array_stream")
    }

    fn __len__(&self) -> usize {
        self.batches.iter().map(RecordBatch::num_rows).sum()
    }

    /// The names of the columns.
    #[getter]
    fn columns(&self) -> Vec<String> {
        self.schema.fields().iter().map(|field| field.name().clone()).collect()
    }

    /// The unit of each column; empty for a pure number.
    #[getter]
    fn units(&self) -> HashMap<String, String> {
        self.said("unit")
    }

    /// What each column is.
    #[getter]
    fn meanings(&self) -> HashMap<String, String> {
        self.said("meaning")
    }

    /// The values of a column, `None` where a row has none.
    fn __getitem__<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyList>> {
        let index = self.schema.index_of(name).map_err(|_| PyKeyError::new_err(name.to_owned()))?;
        let list = PyList::empty(py);
        for batch in &self.batches {
            let array = batch.column(index);
            match array.data_type() {
                DataType::Float64 => append(&list, array.as_primitive::<Float64Type>().iter())?,
                DataType::Int64 => append(&list, array.as_primitive::<Int64Type>().iter())?,
                DataType::Utf8 => append(&list, array.as_string::<i32>().iter())?,
                other => return Err(SpindriftError::new_err(format!("{name}: has the type {other}"))),
            }
        }
        Ok(list)
    }

    fn __repr__(&self) -> String {
        format!("<spindrift.Table: {} rows, {} columns>", self.__len__(), self.schema.fields().len())
    }
}

/// Appends `values` to `list`.
fn append<'py, T: IntoPyObject<'py>>(
    list: &Bound<'py, PyList>,
    mut values: impl Iterator<Item = Option<T>>,
) -> PyResult<()> {
    values.try_for_each(|value| list.append(value))
}
