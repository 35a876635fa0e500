//! [`csv_columns`], [`parquet_columns`]: the used columns of a table as numbers.
//!
//! A small file may hold much data, so the sizes of columns and rows are limited before decompression.

use parquet::basic::{Compression, Repetition, Type as PhysicalType};
use parquet::file::metadata::ParquetMetaData;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::{Field, Row};
use parquet::schema::types::{Type, TypePtr};
use std::cell::Cell;
use std::io::{self, Read};

/// Most bytes of a CSV row, with the comments before it.
const LONGEST_ROW: usize = 1 << 20;
/// Most decompressed bytes of a Parquet column for each row: eight for the widest number, twice with a dictionary,
/// fewer for its index and level.
const MOST_BYTES_OF_A_ROW: u64 = 24;
/// Most bytes of page headers in a row group.
const MOST_BYTES_OF_HEADERS: u64 = 1 << 20;
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct TextCells {
    /// NaN for a text that is not a number.
    pub numbers: Vec<f64>,
    /// Row and text of the first cell that is not a number.
    pub text: Option<(usize, String)>,
    /// The content of a column without numbers, which is not read.
    pub other: Option<&'static str>,
}

impl TextCells {
    fn push(&mut self, cell: Result<f64, String>) {
        if let (Err(text), None) = (&cell, &self.text) {
            self.text = Some((self.numbers.len(), text.clone()));
        }
        self.numbers.push(cell.unwrap_or(f64::NAN));
    }
}

pub(super) enum ReadError {
    Format(String),
    Codec(&'static str),
    /// At least so many numbers.
    Size(u64),
    Row(String),
}

pub(super) type Columns = (Vec<String>, Vec<Option<TextCells>>);

/// Checks that `rows` x `columns` is at most `most`.
fn fits(rows: u64, columns: usize, most: u64) -> Result<(), ReadError> {
    let numbers = rows.saturating_mul(columns as u64);
    if numbers > most { Err(ReadError::Size(numbers)) } else { Ok(()) }
}

/// Bytes with an error after a row that is too long, which the CSV reader would buffer.
struct Rows<'b> {
    bytes: &'b [u8],
    /// Bytes left before the next row.
    left: &'b Cell<usize>,
}

impl Read for Rows<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.bytes.read(buffer)?;
        let left = self.left.get().checked_sub(count).ok_or(io::ErrorKind::FileTooLarge)?;
        self.left.set(left);
        Ok(count)
    }
}

/// The `used` columns of a CSV file, at most `most` numbers.
pub(super) fn csv_columns(bytes: &[u8], most: u64, used: &dyn Fn(&str) -> bool) -> Result<Columns, ReadError> {
    let format = |error: csv::Error| match error.kind() {
        csv::ErrorKind::Io(_) => ReadError::Row(format!("a file with rows of at most {LONGEST_ROW} bytes")),
        _ => ReadError::Format(error.to_string()),
    };
    let left = Cell::new(LONGEST_ROW);
    let rows = Rows { bytes, left: &left };
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).comment(Some(b'#')).from_reader(rows);
    let names: Vec<String> = reader.headers().map_err(format)?.iter().map(str::to_owned).collect();
    let mut columns: Vec<_> = names.iter().map(|name| used(name).then(TextCells::default)).collect();
    let count = columns.iter().flatten().count();
    for (row, record) in reader.records().enumerate() {
        left.set(LONGEST_ROW);
        fits(row as u64 + 1, count, most)?;
        for (column, cell) in columns.iter_mut().zip(record.map_err(format)?.iter()) {
            if let Some(column) = column {
                column.push(cell.parse::<f64>().map_err(|_| cell.to_owned()));
            }
        }
    }
    Ok((names, columns))
}

/// The `used` columns of a Parquet file, at most `most` numbers.
pub(super) fn parquet_columns(
    file: bytes::Bytes,
    most: u64,
    used: &dyn Fn(&str) -> bool,
) -> Result<Columns, ReadError> {
    let format = |error: parquet::errors::ParquetError| ReadError::Format(error.to_string());
    let reader = SerializedFileReader::new(file).map_err(format)?;
    let chunks = reader.metadata().row_groups().iter().flat_map(|group| group.columns());
    let unread = |codec: Compression| match codec {
        Compression::BROTLI(_) => Some("brotli"),
        Compression::LZO => Some("LZO"),
        _ => None,
    };
    if let Some(codec) = chunks.into_iter().find_map(|chunk| unread(chunk.compression())) {
        return Err(ReadError::Codec(codec));
    }
    let schema = reader.metadata().file_metadata().schema_descr_ptr();
    let fields = schema.root_schema().get_fields();
    let names: Vec<String> = fields.iter().map(|field| field.name().to_owned()).collect();
    let cells = |field: &TypePtr| {
        used(field.name()).then(|| TextCells { other: other_than_numbers(field), ..TextCells::default() })
    };
    let mut columns: Vec<_> = fields.iter().map(cells).collect();
    let is_read = |column: &Option<TextCells>| column.as_ref().is_some_and(|cells| cells.other.is_none());
    let read: Vec<TypePtr> =
        fields.iter().zip(&columns).filter(|(_, column)| is_read(column)).map(|(field, _)| field.clone()).collect();
    if read.is_empty() {
        return Ok((names, columns));
    }
    let rows = u64::try_from(reader.metadata().file_metadata().num_rows()).unwrap_or(u64::MAX);
    fits(rows, read.len(), most)?;
    check_sizes(reader.metadata(), &read)?;
    let count = read.len();
    let projection = Type::group_type_builder(schema.name()).with_fields(read).build().map_err(format)?;
    for (row, found) in reader.get_row_iter(Some(projection)).map_err(format)?.enumerate() {
        // the metadata may be wrong
        fits(row as u64 + 1, count, most)?;
        let found: Row = found.map_err(format)?;
        let numbers = columns.iter_mut().flatten().filter(|cells| cells.other.is_none());
        for (column, (_, field)) in numbers.zip(found.get_column_iter()) {
            column.push(cell(field));
        }
    }
    Ok((names, columns))
}

/// The content of a column whose type excludes numbers.
fn other_than_numbers(field: &Type) -> Option<&'static str> {
    if field.is_group() {
        return Some("a table within the table");
    }
    if field.get_basic_info().repetition() == Repetition::REPEATED {
        return Some("lists");
    }
    match field.get_physical_type() {
        PhysicalType::BYTE_ARRAY | PhysicalType::FIXED_LEN_BYTE_ARRAY => Some("text or bytes"),
        PhysicalType::INT96 => Some("times"),
        PhysicalType::BOOLEAN
        | PhysicalType::INT32
        | PhysicalType::INT64
        | PhysicalType::FLOAT
        | PhysicalType::DOUBLE => None,
    }
}

/// Checks that decompressed columns are no larger than numbers are.
fn check_sizes(metadata: &ParquetMetaData, read: &[TypePtr]) -> Result<(), ReadError> {
    for group in metadata.row_groups() {
        let rows = u64::try_from(group.num_rows()).unwrap_or(u64::MAX);
        let most = rows.saturating_mul(MOST_BYTES_OF_A_ROW).saturating_add(MOST_BYTES_OF_HEADERS);
        let is_read = |path: &[String]| path.len() == 1 && read.iter().any(|field| field.name() == path[0]);
        let sizes = group.columns().iter().filter(|chunk| is_read(chunk.column_path().parts()));
        let largest = sizes.map(|chunk| u64::try_from(chunk.uncompressed_size()).unwrap_or(u64::MAX)).max();
        if let Some(bytes) = largest.filter(|bytes| *bytes > most) {
            return Err(ReadError::Row(format!(
                "a file with columns of at most {most} bytes for {rows} rows, before compression (this one has {bytes})"
            )));
        }
    }
    Ok(())
}

fn cell(field: &Field) -> Result<f64, String> {
    Ok(match field {
        Field::Bool(value) => f64::from(u8::from(*value)),
        Field::Byte(value) => f64::from(*value),
        Field::Short(value) => f64::from(*value),
        Field::Int(value) => f64::from(*value),
        Field::Long(value) => *value as f64,
        Field::UByte(value) => f64::from(*value),
        Field::UShort(value) => f64::from(*value),
        Field::UInt(value) => f64::from(*value),
        Field::ULong(value) => *value as f64,
        Field::Float(value) => f64::from(*value),
        Field::Double(value) => *value,
        other => return Err(other.to_string()),
    })
}
