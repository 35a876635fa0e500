//! [`DataFile`]: named columns of numbers in a CSV or Parquet file that a campaign names: values of an empirical distribution, rows of a
//! table of samples.
//!
//! A path counts from the folder of the campaign file. What a plan keeps of a file is its name and the SHA-256 of its bytes,
//! so that a plan's identity includes its data.

use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::{Field, Row};
use sha2::{Digest, Sha256};
use std::path::Path;

/// A file of named columns of numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct DataFile {
    /// SHA-256 of the file's bytes, hexadecimal.
    pub sha256: String,
    /// The names of the columns.
    pub names: Vec<String>,
    /// The cells of each column as numbers or as the text that is none.
    columns: Vec<Vec<Result<f64, String>>>,
    /// The number of the first row of data as people count them in this format.
    first_row: usize,
}

/// What is wrong with a file: value, what is allowed, remedy.
pub type Refusal = (String, String, String);

impl DataFile {
    /// Reads the whole file.
    ///
    /// # Errors
    /// What keeps it from being read.
    pub fn read(path: &Path) -> Result<Self, Refusal> {
        let shown = path.display().to_string();
        let unreadable =
            |why: String, remedy: &str| (format!("{shown:?}"), format!("a readable file ({why})"), remedy.to_owned());
        let bytes = std::fs::read(path)
            .map_err(|error| unreadable(error.to_string(), "its path counts from the folder of the campaign file"))?;
        let sha256 = Sha256::digest(&bytes).iter().map(|byte| format!("{byte:02x}")).collect();
        let extension = path.extension().and_then(|extension| extension.to_str()).map(str::to_ascii_lowercase);
        let (names, columns, first_row) = match extension.as_deref() {
            Some("csv") => {
                let (names, columns) =
                    csv_columns(&bytes).map_err(|error| unreadable(error.to_string(), "correct the file"))?;
                (names, columns, 2)
            }
            Some("parquet") => {
                let file = std::fs::File::open(path).map_err(|error| unreadable(error.to_string(), "try again"))?;
                let (names, columns) =
                    parquet_columns(file).map_err(|error| unreadable(error.to_string(), "correct the file"))?;
                (names, columns, 1)
            }
            _ => {
                let allowed = "a file whose name ends in .csv or .parquet".to_owned();
                return Err((format!("{shown:?}"), allowed, "convert it, or rename it".to_owned()));
            }
        };
        Ok(DataFile { sha256, names, columns, first_row })
    }

    /// The numbers of the column called `name`, all finite; `None` where there is no such column.
    ///
    /// # Errors
    /// The first cell that is not a finite number, or that there is none.
    pub fn column(&self, name: &str) -> Option<Result<Vec<f64>, Refusal>> {
        let index = self.names.iter().position(|known| known == name)?;
        let mut numbers = Vec::with_capacity(self.columns[index].len());
        for (row, cell) in self.columns[index].iter().enumerate() {
            match cell {
                Ok(number) if number.is_finite() => numbers.push(*number),
                other => {
                    let value = match other {
                        Ok(number) => number.to_string(),
                        Err(text) => format!("{text:?}"),
                    };
                    let allowed = format!("a column of finite numbers ({name:?}, row {})", row + self.first_row);
                    return Some(Err((value, allowed, "correct or delete that row of the file".to_owned())));
                }
            }
        }
        if numbers.is_empty() {
            let allowed = format!("a column with at least one number ({name:?})");
            return Some(Err(("0 rows".to_owned(), allowed, "add rows to the file".to_owned())));
        }
        Some(Ok(numbers))
    }
}

/// Names and columns of cells.
type Columns = (Vec<String>, Vec<Vec<Result<f64, String>>>);

fn csv_columns(bytes: &[u8]) -> Result<Columns, csv::Error> {
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).comment(Some(b'#')).from_reader(bytes);
    let names: Vec<String> = reader.headers()?.iter().map(str::to_owned).collect();
    let mut columns = vec![Vec::new(); names.len()];
    for record in reader.records() {
        for (column, cell) in columns.iter_mut().zip(record?.iter()) {
            column.push(cell.parse::<f64>().map_err(|_| cell.to_owned()));
        }
    }
    Ok((names, columns))
}

fn parquet_columns(file: std::fs::File) -> Result<Columns, parquet::errors::ParquetError> {
    let reader = SerializedFileReader::new(file)?;
    let schema = reader.metadata().file_metadata().schema_descr_ptr();
    let names: Vec<String> = schema.root_schema().get_fields().iter().map(|field| field.name().to_owned()).collect();
    let mut columns = vec![Vec::new(); names.len()];
    for row in reader.get_row_iter(None)? {
        let row: Row = row?;
        for (column, (_, field)) in columns.iter_mut().zip(row.get_column_iter()) {
            column.push(cell(field));
        }
    }
    Ok((names, columns))
}

/// A Parquet value as a number.
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
