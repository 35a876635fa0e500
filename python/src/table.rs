//! [`Table`]: columns with units and meanings, which Arrow's C interface hands over without a copy.
//!
//! Apache Arrow, *The Arrow PyCapsule Interface*: polars, pyarrow, pandas, DuckDB and others take an object with `__arrow_c_stream__`.

use std::collections::HashMap;
use std::sync::Arc;

use arrow_array::builder::{Float64Builder, Int64Builder, StringBuilder};
use arrow_array::cast::AsArray;
use arrow_array::ffi_stream::FFI_ArrowArrayStream;
use arrow_array::types::{Float64Type, Int64Type};
use arrow_array::{Array, ArrayRef, Float64Array, Int64Array, RecordBatch, RecordBatchIterator, StringArray};
use arrow_schema::{ArrowError, DataType, Field, Schema, SchemaRef};
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;
use pyo3::types::{PyCapsule, PyList};
use spindrift::campaign::Plan;
use spindrift::cli::columns::ColumnSection;
use spindrift::ensemble::{DrawnScenes, Ensemble};
use spindrift::storage::columnar::{Cells, Heading};
use spindrift::storage::described_table::DescribedColumn;
use spindrift::storage::drawn_table;
use spindrift::storage::rows_file;
use spindrift::storage::rows_reader::{DecodedColumn, PartReader, RowsError};
use spindrift::storage::timeseries::TimeSeries;
use spindrift::workflow::{Results, WorkflowError};

use crate::SpindriftError;

/// A table.
#[pyclass(module = "spindrift._native", frozen)]
pub struct Table {
    schema: SchemaRef,
    batches: Vec<RecordBatch>,
}

/// A column as Arrow's; what is no finite number is null, as in files.
fn array(cells: &Cells<'_>) -> ArrayRef {
    match cells {
        Cells::Real(values, mask) => {
            let is_there = |row: usize| values[row].is_finite() && mask.is_none_or(|mask| mask[row]);
            reals(values.to_vec(), (0..values.len()).map(is_there).collect())
        }
        Cells::Count(values, mask) => {
            let values = values.iter().map(|value| value.cast_signed()).collect();
            counts(values, mask.map(<[bool]>::to_vec))
        }
        Cells::Word(words) => Arc::new(StringArray::from(words.clone())),
        Cells::Text(texts) => Arc::new(StringArray::from(texts.clone())),
    }
}

fn reals(values: Vec<f64>, there: Vec<bool>) -> ArrayRef {
    if there.iter().all(|there| *there) {
        return Arc::new(Float64Array::from(values));
    }
    let mut builder = Float64Builder::with_capacity(values.len());
    builder.append_values(&values, &there);
    Arc::new(builder.finish())
}

fn counts(values: Vec<i64>, there: Option<Vec<bool>>) -> ArrayRef {
    let Some(there) = there else { return Arc::new(Int64Array::from(values)) };
    let mut builder = Int64Builder::with_capacity(values.len());
    builder.append_values(&values, &there);
    Arc::new(builder.finish())
}

/// One value for each row: the next of `values` where there is one, else `absent`; and which rows have one.
fn spread<T: Copy>(values: Vec<T>, present: &[i16], absent: T) -> (Vec<T>, Vec<bool>) {
    let mut values = values.into_iter();
    present
        .iter()
        .map(|level| if *level == 1 { (values.next().unwrap_or(absent), true) } else { (absent, false) })
        .unzip()
}

/// A column of a file as Arrow's.
fn decoded(column: DecodedColumn) -> ArrayRef {
    match column {
        DecodedColumn::Real(values, None) => Arc::new(Float64Array::from(values)),
        DecodedColumn::Real(values, Some(present)) => {
            let (values, there) = spread(values, &present, f64::NAN);
            reals(values, there)
        }
        DecodedColumn::Count(values, None) => counts(values, None),
        DecodedColumn::Count(values, Some(present)) => {
            let (values, there) = spread(values, &present, 0);
            counts(values, Some(there))
        }
        DecodedColumn::Text(texts, present) => {
            let mut builder = StringBuilder::new();
            let mut texts = texts.iter().map(|text| String::from_utf8_lossy(text.data()));
            match present {
                None => texts.for_each(|text| builder.append_value(text)),
                Some(present) => {
                    present
                        .iter()
                        .for_each(|level| builder.append_option(if *level == 1 { texts.next() } else { None }));
                }
            }
            Arc::new(builder.finish())
        }
    }
}

/// A field with unit and meaning in its metadata.
fn field(name: &str, of: DataType, unit: &str, meaning: &str) -> Field {
    let metadata = [("unit", unit), ("meaning", meaning)].into_iter().filter(|(_, text)| !text.is_empty());
    let metadata: HashMap<String, String> = metadata.map(|(key, text)| (key.to_owned(), text.to_owned())).collect();
    Field::new(name, of, true).with_metadata(metadata)
}

fn headed(heading: &Heading, array: &ArrayRef) -> Field {
    let quantity = &heading.quantity;
    field(quantity.name(), array.data_type().clone(), quantity.unit(), quantity.meaning())
}

fn broken(error: ArrowError) -> WorkflowError {
    WorkflowError::files(error)
}

impl Table {
    fn of_batches(schema: SchemaRef, batches: Vec<RecordBatch>) -> Self {
        Table { schema, batches }
    }

    fn of_arrays(fields: Vec<Field>, arrays: Vec<ArrayRef>) -> Result<Self, WorkflowError> {
        let schema = Arc::new(Schema::new(fields));
        let batch = RecordBatch::try_new(schema.clone(), arrays).map_err(broken)?;
        Ok(Table::of_batches(schema, vec![batch]))
    }

    fn of_cells<'a>(columns: impl Iterator<Item = (&'a Heading, Cells<'a>)>) -> Result<Self, WorkflowError> {
        let columns = columns.map(|(heading, cells)| {
            let array = array(&cells);
            (headed(heading, &array), array)
        });
        let (fields, arrays) = columns.unzip();
        Table::of_arrays(fields, arrays)
    }

    /// The rows of a result.
    ///
    /// # Errors
    /// Where a file cannot be read.
    pub fn of_rows(results: &Results<'_>) -> Result<Self, WorkflowError> {
        let headings = rows_file::headings(&Ensemble::new(results.plan(), spindrift::workflow::isa()?));
        let mut parts: Vec<Vec<ArrayRef>> = Vec::new();
        let read = |part: &mut PartReader| {
            let columns = headings.iter().map(|heading| part.cells(heading.quantity.name()).map(decoded));
            columns.collect::<Result<Vec<_>, RowsError>>()
        };
        let merge = |part| {
            parts.push(part);
            Ok(())
        };
        results.rows().visit(None, read, merge).map_err(WorkflowError::files)?;
        let first = parts.first().map_or(&[][..], Vec::as_slice);
        let fields: Vec<Field> = headings.iter().zip(first).map(|(heading, array)| headed(heading, array)).collect();
        let schema = Arc::new(Schema::new(fields));
        let batches = parts.into_iter().map(|part| RecordBatch::try_new(schema.clone(), part).map_err(broken));
        Ok(Table::of_batches(schema.clone(), batches.collect::<Result<_, WorkflowError>>()?))
    }

    /// A small file of a result, which says itself what its columns are.
    ///
    /// # Errors
    /// Where it cannot be read.
    pub fn of_part(part: &PartReader) -> Result<Self, WorkflowError> {
        let columns = part.names().into_iter().map(|name| {
            let array = decoded(part.cells(&name).map_err(WorkflowError::files)?);
            Ok::<_, WorkflowError>((field(&name, array.data_type().clone(), "", ""), array))
        });
        let (fields, arrays) = columns.collect::<Result<Vec<_>, WorkflowError>>()?.into_iter().unzip();
        Table::of_arrays(fields, arrays)
    }

    /// A table of the end of a campaign.
    ///
    /// # Errors
    /// Where its columns differ in length.
    pub fn of_described(columns: &[DescribedColumn]) -> Result<Self, WorkflowError> {
        Table::of_cells(columns.iter().map(|column| (column.heading(), column.cells())))
    }

    /// A run over time.
    ///
    /// # Errors
    /// Where its columns differ in length.
    pub fn of_series(series: &TimeSeries) -> Result<Self, WorkflowError> {
        let columns = series.headings().iter().zip(series.columns());
        Table::of_cells(columns.map(|(heading, (_, values))| (heading, Cells::Real(values, None))))
    }

    /// The dispersed parameters of all samples of `plan`.
    ///
    /// # Errors
    /// Where columns differ in length.
    pub fn of_draws(plan: &Plan) -> Result<Self, WorkflowError> {
        let headings = drawn_table::headings(plan);
        let (mut schema, mut batches) = (None, Vec::new());
        DrawnScenes::visit(plan, true, |drawn| {
            let table = Table::of_cells(headings.iter().zip(drawn_table::cells(drawn)))?;
            batches.extend(table.batches);
            schema.get_or_insert(table.schema);
            Ok::<(), WorkflowError>(())
        })?;
        Ok(Table::of_batches(schema.unwrap_or_else(|| Arc::new(Schema::empty())), batches))
    }

    /// The columns of sections: group, name, unit, meaning, and in which scenes there are those.
    ///
    /// # Errors
    /// Where columns differ in length.
    pub fn of_sections(sections: &[ColumnSection]) -> PyResult<Self> {
        let rows =
            || sections.iter().flat_map(|one| one.columns.iter().map(move |column| (one.title.as_str(), column)));
        let texts = |of: &dyn Fn(&str, &spindrift::run::Quantity, &str) -> String| {
            let texts = rows().map(|(title, (quantity, needs))| Some(of(title, quantity, needs)));
            Arc::new(texts.collect::<StringArray>()) as ArrayRef
        };
        let columns: [(&str, ArrayRef); 5] = [
            ("group", texts(&|title, _, _| title.to_owned())),
            ("name", texts(&|_, quantity, _| quantity.name().to_owned())),
            ("unit", texts(&|_, quantity, _| quantity.unit().to_owned())),
            ("meaning", texts(&|_, quantity, _| quantity.meaning().to_owned())),
            ("only", texts(&|_, _, needs| needs.to_owned())),
        ];
        let (fields, arrays) =
            columns.into_iter().map(|(name, array)| (field(name, DataType::Utf8, "", ""), array)).unzip();
        Table::of_arrays(fields, arrays).map_err(crate::raised)
    }

    /// What the metadata of each column say of `key`.
    fn said(&self, key: &str) -> HashMap<String, String> {
        let text = |field: &Arc<Field>| (field.name().clone(), field.metadata().get(key).cloned().unwrap_or_default());
        self.schema.fields().iter().map(text).collect()
    }
}

#[pymethods]
impl Table {
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
