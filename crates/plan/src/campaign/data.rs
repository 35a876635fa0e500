//! [`DataFile`]: named columns of numbers in a CSV or Parquet file of a campaign.
//!
//! Paths are relative to the campaign file's folder. A plan keeps name and SHA-256, so that its identity includes its
//! data. Only used columns are read, and their memory is bounded before decompression.

use super::data_columns::{ReadError, TextCells, csv_columns, parquet_columns};
use super::input_file::{self, InputError};
use sha2::{Digest, Sha256};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

/// Folder next to a plan with copies of its data files and module.
pub const COPIES: &str = "data";

/// The name of a file's copy in [`COPIES`]: its SHA-256 and extension.
pub fn copy_name(file: &Path, sha256: &str) -> String {
    let extension = file.extension().and_then(|extension| extension.to_str()).unwrap_or_default();
    format!("{sha256}.{}", extension.to_ascii_lowercase())
}

/// The bytes of a data file.
///
/// # Errors
/// An unreadable, too large or irregular file.
pub fn bytes(file: &Path) -> Result<Vec<u8>, InputError> {
    input_file::read(file, LARGEST_FILE)
}

/// Most numbers of a campaign's data files: 160 MB. A compressed column of equal values may be a thousand times larger
/// than its file.
pub const MOST_NUMBERS: u64 = 20_000_000;
/// Most tables that name a data file, each of which is read separately.
pub const MOST_FILES: usize = 100;
const LARGEST_FILE: u64 = 25 * MOST_NUMBERS;

#[derive(Clone, Debug, PartialEq)]
pub struct DataFile {
    pub sha256: String,
    pub names: Vec<String>,
    /// Their cells; `None` for unused columns.
    columns: Vec<Option<TextCells>>,
    /// The number of the first row by the format's convention.
    first_row: usize,
}

/// Value, allowed values and remedy of a problem.
pub type Refusal = (String, String, String);

/// Why a data file is not used.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Unused {
    pub refusal: Refusal,
    /// True if the only problem is that it is unreadable now.
    pub is_unreadable: bool,
}

impl From<Refusal> for Unused {
    fn from(refusal: Refusal) -> Self {
        Unused { refusal, is_unreadable: false }
    }
}

impl DataFile {
    /// Reads the columns whose names are `used`, at most `most` numbers.
    ///
    /// # Errors
    /// Why they are not read.
    pub fn read(path: &Path, most: u64, used: &dyn Fn(&str) -> bool) -> Result<Self, Unused> {
        let shown = path.display().to_string();
        let unreadable =
            |why: String, remedy: &str| (format!("{shown:?}"), format!("a readable file ({why})"), remedy.to_owned());
        let too_large = |size: String| {
            let others = if most < MOST_NUMBERS { format!(", {MOST_NUMBERS} in all files") } else { String::new() };
            let allowed = format!("a file of at most {most} numbers{others} (this one has {size})");
            (format!("{shown:?}"), allowed, "keep fewer rows, or name fewer columns".to_owned())
        };
        let bytes = bytes(path).map_err(|error| match error {
            InputError::Kind(kind) => {
                Unused::from(unreadable(kind.to_owned(), "name a regular file: what it has must not change or wait"))
            }
            InputError::Size(bytes) => Unused::from(too_large(format!("{bytes} bytes"))),
            InputError::Io(error) => Unused {
                is_unreadable: input_file::is_unreadable(&error),
                refusal: unreadable(error.to_string(), "its path counts from the folder of the campaign file"),
            },
        })?;
        let sha256 = Sha256::digest(&bytes).iter().map(|byte| format!("{byte:02x}")).collect();
        let refused = |error: ReadError| match error {
            ReadError::Format(why) => unreadable(why, "correct the file"),
            ReadError::Codec(codec) => unreadable(
                format!("it is compressed with {codec}"),
                "write it with gzip, zstd, snappy, lz4 or no compression, or as .csv",
            ),
            ReadError::Size(numbers) => too_large(format!("{numbers} numbers or more")),
            ReadError::Row(allowed) => {
                (format!("{shown:?}"), allowed, "is this a table of numbers? If so, write it again".to_owned())
            }
        };
        let extension = path.extension().and_then(|extension| extension.to_str()).map(str::to_ascii_lowercase);
        let (names, columns, first_row) = match extension.as_deref() {
            Some("csv") => {
                let (names, columns) = csv_columns(&bytes, most, used).map_err(refused)?;
                (names, columns, 2)
            }
            Some("parquet") => {
                // the Parquet reader panics on some damaged files
                let read = catch_unwind(AssertUnwindSafe(|| parquet_columns(bytes.into(), most, used)));
                let damaged =
                    |_| Err(ReadError::Format("it is damaged: the Parquet reader cannot decode it".to_owned()));
                let (names, columns) = read.unwrap_or_else(damaged).map_err(refused)?;
                (names, columns, 1)
            }
            _ => {
                let allowed = "a file whose name ends in .csv or .parquet".to_owned();
                return Err((format!("{shown:?}"), allowed, "convert it, or rename it".to_owned()).into());
            }
        };
        Ok(DataFile { sha256, names, columns, first_row })
    }

    pub fn numbers(&self) -> u64 {
        self.columns.iter().flatten().map(|cells| cells.numbers.len() as u64).sum()
    }

    /// The finite numbers of the column `name`; `None` for a missing or unread column.
    ///
    /// # Errors
    /// The first cell that is not a finite number, or an empty column.
    pub fn column(&self, name: &str) -> Option<Result<Vec<f64>, Refusal>> {
        let index = self.names.iter().position(|known| known == name)?;
        let TextCells { numbers, text, other } = self.columns[index].as_ref()?;
        if let Some(other) = other {
            let allowed = format!("a column of finite numbers ({name:?})");
            return Some(Err(((*other).to_owned(), allowed, "write its numbers as numbers".to_owned())));
        }
        if let Some(row) = numbers.iter().position(|number| !number.is_finite()) {
            let value = match text {
                Some((first, text)) if *first == row => format!("{text:?}"),
                _ => numbers[row].to_string(),
            };
            let allowed = format!("a column of finite numbers ({name:?}, row {})", row + self.first_row);
            return Some(Err((value, allowed, "correct or delete that row of the file".to_owned())));
        }
        if numbers.is_empty() {
            let allowed = format!("a column with at least one number ({name:?})");
            return Some(Err(("0 rows".to_owned(), allowed, "add rows to the file".to_owned())));
        }
        Some(Ok(numbers.clone()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use parquet::basic::Compression;
    use parquet::data_type::DoubleType;
    use parquet::file::properties::WriterProperties;
    use parquet::file::reader::{FileReader, SerializedFileReader};
    use parquet::file::writer::SerializedFileWriter;
    use parquet::schema::parser::parse_message_type;
    use std::sync::Arc;

    /// `levels` marks the rows of three that have a value.
    fn file(kind: &str, levels: Option<&[i16]>, compression: Compression) -> Vec<u8> {
        let schema = Arc::new(parse_message_type(&format!("message m {{ {kind} double x; }}")).expect("a schema"));
        let properties = Arc::new(WriterProperties::builder().set_compression(compression).build());
        let mut bytes = Vec::new();
        let mut writer = SerializedFileWriter::new(&mut bytes, schema, properties).expect("a writer");
        let mut group = writer.next_row_group().expect("a group");
        let mut column = group.next_column().expect("a column").expect("one");
        column.typed::<DoubleType>().write_batch(&[1.5, 2.5], levels, None).expect("written");
        column.close().expect("closed");
        group.close().expect("closed");
        writer.close().expect("closed");
        bytes
    }

    fn read(name: &str, bytes: &[u8]) -> Result<Vec<f64>, Refusal> {
        let path = std::env::temp_dir().join(format!("spindrift-{}-{name}.parquet", std::process::id()));
        std::fs::write(&path, bytes).expect("written");
        let found = DataFile::read(&path, MOST_NUMBERS, &|_| true).map_err(|unused| unused.refusal);
        std::fs::remove_file(&path).expect("removed");
        let absent = || (String::new(), "a column x".to_owned(), String::new());
        found.and_then(|data| data.column("x").unwrap_or_else(|| Err(absent())))
    }

    /// Law: a row without a value is refused by its number, not read as zero.
    #[test]
    fn a_row_without_a_value_is_refused() {
        for at in 0..3 {
            let levels: Vec<i16> = (0..3).map(|row| i16::from(row != at)).collect();
            let found = read("absent", &file("optional", Some(&levels), Compression::UNCOMPRESSED));
            let refused = format!("{:?}", found.expect_err("a row without a value"));
            assert!(refused.contains(&format!("row {}", at + 1)), "{refused}");
        }
        let whole = read("present", &file("optional", Some(&[1, 1]), Compression::UNCOMPRESSED));
        assert_eq!(whole, Ok(vec![1.5, 2.5]));
    }

    /// Law: codecs that are read give the same numbers; brotli is refused by name.
    #[test]
    fn compressions_are_read_or_refused_in_words() {
        let gzip = file("required", None, Compression::GZIP(parquet::basic::GzipLevel::default()));
        for bytes in
            [&file("required", None, Compression::UNCOMPRESSED), &file("required", None, Compression::SNAPPY), &gzip]
        {
            assert_eq!(read("codec", bytes), Ok(vec![1.5, 2.5]));
        }
        // nothing here writes brotli: change the codec in the footer (thrift zigzag 4 to 8)
        let codecs = |bytes: &[u8]| {
            let reader = SerializedFileReader::new(bytes::Bytes::copy_from_slice(bytes));
            reader.ok().map(|reader| reader.metadata().row_group(0).column(0).compression())
        };
        let brotli = (gzip.len() / 2..gzip.len()).filter(|at| gzip[*at] == 4).find_map(|at| {
            let mut changed = gzip.clone();
            changed[at] = 8;
            let found = catch_unwind(AssertUnwindSafe(|| codecs(&changed))).ok().flatten();
            found.filter(|codec| matches!(codec, Compression::BROTLI(_))).map(|_| changed)
        });
        let (_, allowed, remedy) = read("brotli", &brotli.expect("a footer with brotli")).expect_err("brotli");
        assert_eq!(allowed, "a readable file (it is compressed with brotli)");
        assert_eq!(remedy, "write it with gzip, zstd, snappy, lz4 or no compression, or as .csv");
    }

    /// Law: a Parquet file with any byte changed is read or refused without a panic.
    #[test]
    fn damaged_tables_are_refused() {
        let whole = file("required", None, Compression::SNAPPY);
        std::panic::set_hook(Box::new(|_| {})); // the reader's panics are wanted
        let mut refused = 0;
        for at in 0..whole.len() {
            for change in [0x01, 0x80, 0xff] {
                let mut changed = whole.clone();
                changed[at] ^= change;
                refused += usize::from(catch_unwind(|| read("damaged", &changed).is_err()).expect("no panic"));
            }
        }
        let _ = std::panic::take_hook();
        assert!(refused > whole.len() / 2, "{refused} of {}", 3 * whole.len());
    }
}
