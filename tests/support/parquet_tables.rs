//! Parquet files as Arrow's arrays, through Parquet's record reader.

use super::prelude::*;
use std::sync::Arc;

use arrow_array::{ArrayRef, Float64Array, Int64Array, StringArray};
use arrow_ipc::convert::try_schema_from_ipc_buffer;
use arrow_schema::Schema;
use base64::{Engine, engine::general_purpose::STANDARD};
use parquet::{basic::Type, record::Field};

pub fn groups(path: &Path) -> Vec<RecordBatch> {
    let reader = SerializedFileReader::new(File::open(path).unwrap()).unwrap();
    (0..reader.num_row_groups()).map(|index| group(&reader, index)).collect()
}

fn group(reader: &SerializedFileReader<File>, index: usize) -> RecordBatch {
    let schema = reader.metadata().file_metadata().schema_descr();
    let rows = reader.get_row_group(index).unwrap();
    let mut columns: Vec<Vec<Field>> = vec![Vec::new(); schema.num_columns()];
    for row in rows.get_row_iter(None).unwrap() {
        for (column, (_, cell)) in columns.iter_mut().zip(row.unwrap().into_columns()) {
            column.push(cell);
        }
    }
    let arrays = schema.columns().iter().zip(columns).map(|(column, cells)| {
        (column.name().to_owned(), array(column.physical_type(), cells), column.self_type().is_optional())
    });
    RecordBatch::try_from_iter_with_nullable(arrays).unwrap()
}

fn array(physical: Type, cells: Vec<Field>) -> ArrayRef {
    match physical {
        Type::DOUBLE => Arc::new(Float64Array::from_iter(cells.into_iter().map(|cell| match cell {
            Field::Double(value) => Some(value),
            Field::Null => None,
            other => panic!("{other:?}"),
        }))),
        Type::INT64 => Arc::new(Int64Array::from_iter(cells.into_iter().map(|cell| match cell {
            Field::Long(value) => Some(value),
            Field::Null => None,
            other => panic!("{other:?}"),
        }))),
        Type::BYTE_ARRAY => Arc::new(StringArray::from_iter(cells.into_iter().map(|cell| match cell {
            Field::Str(value) => Some(value),
            Field::Null => None,
            other => panic!("{other:?}"),
        }))),
        other => panic!("no file has columns of {other}"),
    }
}

pub fn schema(reader: &SerializedFileReader<File>) -> Schema {
    let pairs = reader.metadata().file_metadata().key_value_metadata().unwrap();
    let entry = pairs.iter().find(|pair| pair.key == "ARROW:schema").unwrap();
    let bytes = STANDARD.decode(entry.value.as_ref().unwrap()).unwrap();
    try_schema_from_ipc_buffer(&bytes).unwrap()
}
