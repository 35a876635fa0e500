//! [`DataFile`]: named columns of numbers in a CSV or Parquet file that a campaign names: values of an empirical
//! distribution, rows that are drawn or are a table of samples.
//!
//! A path counts from the folder of the campaign file. What a plan keeps of a file is its name and the SHA-256 of its
//! bytes, so that a plan's identity includes its data. Only the columns that are used are read, and how much memory
//! they take is known before anything is decompressed.

use super::data_columns::{ReadError, TextCells, csv_columns, parquet_columns};
use super::input_file::{self, InputError};
use sha2::{Digest, Sha256};
use std::io::Read;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

/// Folder beside a plan with copies of the files of numbers and the module that it names.
pub const COPIES: &str = "data";

/// The name of the copy of `file` in the folder [`COPIES`]: the SHA-256 of its bytes, and its extension.
pub fn copy_name(file: &Path, sha256: &str) -> String {
    let extension = file.extension().and_then(|extension| extension.to_str()).unwrap_or_default();
    format!("{sha256}.{}", extension.to_ascii_lowercase())
}

/// The bytes of a file of numbers.
///
/// # Errors
/// Where it cannot be read, or is not what a plan may name.
pub fn bytes(file: &Path) -> Result<Vec<u8>, InputError> {
    input_file::read(file, LARGEST_FILE)
}

/// Most numbers of all files of a campaign: 160 MB. A compressed column of equal values can be a thousand times as
/// large as its file.
pub const MOST_NUMBERS: u64 = 20_000_000;
/// Most tables of a campaign file that name a file of numbers: each is read for its table, in time that a user waits
/// for.
pub const MOST_FILES: usize = 100;
/// Largest file, bytes: [`MOST_NUMBERS`] in 25 characters each.
const LARGEST_FILE: u64 = 25 * MOST_NUMBERS;

/// A file of named columns of numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct DataFile {
    /// SHA-256 of the file's bytes, hexadecimal.
    pub sha256: String,
    /// The names of the columns.
    pub names: Vec<String>,
    /// What was read of each; `None` of those that are not used.
    columns: Vec<Option<TextCells>>,
    /// The number of the first row of data as people count them in this format.
    first_row: usize,
}

/// What is wrong with a file: value, what is allowed, remedy.
pub type Refusal = (String, String, String);

/// Why a file of numbers is not used.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Unused {
    /// What is wrong with it.
    pub refusal: Refusal,
    /// Whether that is only that it cannot be read now.
    pub is_unreadable: bool,
}

impl From<Refusal> for Unused {
    fn from(refusal: Refusal) -> Self {
        Unused { refusal, is_unreadable: false }
    }
}

impl DataFile {
    /// Reads the columns of the file whose names are `used`, at most `most` numbers.
    ///
    /// # Errors
    /// What keeps them from being read.
    pub fn read(path: &Path, most: u64, used: &dyn Fn(&str) -> bool) -> Result<Self, Unused> {
        let shown = path.display().to_string();
        let unreadable =
            |why: String, remedy: &str| (format!("{shown:?}"), format!("a readable file ({why})"), remedy.to_owned());
        let too_large = |size: String| {
            let others = if most < MOST_NUMBERS { format!(", {MOST_NUMBERS} in all files") } else { String::new() };
            let allowed = format!("a file of at most {most} numbers{others} (this one has {size})");
            (format!("{shown:?}"), allowed, "keep fewer rows, or name fewer columns".to_owned())
        };
        let (file, size) = input_file::open(path, LARGEST_FILE).map_err(|error| match error {
            InputError::Kind(kind) => {
                Unused::from(unreadable(kind.to_owned(), "name a regular file: what it has must not change or wait"))
            }
            InputError::Size(bytes) => Unused::from(too_large(format!("{bytes} bytes"))),
            InputError::Io(error) => Unused {
                is_unreadable: input_file::is_unreadable(&error),
                refusal: unreadable(error.to_string(), "its path counts from the folder of the campaign file"),
            },
        })?;
        let failed =
            |error: std::io::Error| Unused { refusal: unreadable(error.to_string(), "try again"), is_unreadable: true };
        let mut bytes = Vec::with_capacity(usize::try_from(size).unwrap_or(0));
        file.take(LARGEST_FILE + 1).read_to_end(&mut bytes).map_err(failed)?;
        if bytes.len() as u64 > LARGEST_FILE {
            return Err(too_large(format!("{LARGEST_FILE} bytes or more")).into());
        }
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

    /// How many numbers were read.
    pub fn numbers(&self) -> u64 {
        self.columns.iter().flatten().map(|cells| cells.numbers.len() as u64).sum()
    }

    /// The numbers of the column called `name`, all finite; `None` where there is no such column, or it was not to be
    /// read.
    ///
    /// # Errors
    /// The first cell that is not a finite number, or that there is none.
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

    fn small(compression: Compression) -> Vec<u8> {
        file("required", None, compression)
    }

    /// The same of a column that has to have values or not; `levels` says which of three rows have one.
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
        let found = DataFile::read(&path, MOST_NUMBERS, &|_| true)
            .map_err(|unused| unused.refusal)
            .and_then(|data| data.column("x").expect("the column"));
        std::fs::remove_file(&path).expect("removed");
        found
    }

    /// Law: a row without a value is refused, with its number, whichever it is; it is no zero.
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

    /// Law: Parquet with gzip is read as that without; with brotli it is refused by name, with the remedy.
    #[test]
    fn compressions_are_read_or_refused_in_words() {
        let gzip = small(Compression::GZIP(parquet::basic::GzipLevel::default()));
        for bytes in [&small(Compression::UNCOMPRESSED), &small(Compression::SNAPPY), &gzip] {
            assert_eq!(read("codec", bytes), Ok(vec![1.5, 2.5]));
        }
        // nothing here writes brotli: the footer of the gzip file is changed to name it (thrift's zigzag numbers 4 = 2
        // x 2, 8 = 2 x 4)
        let codecs = |bytes: &[u8]| {
            let path = std::env::temp_dir().join(format!("spindrift-{}-footer.parquet", std::process::id()));
            std::fs::write(&path, bytes).expect("written");
            let reader = SerializedFileReader::new(std::fs::File::open(&path).expect("a file"));
            std::fs::remove_file(&path).expect("removed");
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

    /// Law: a Parquet file with any byte changed is read or refused; the reader's panics do not end the program.
    #[test]
    fn damaged_tables_are_refused() {
        let whole = small(Compression::SNAPPY);
        std::panic::set_hook(Box::new(|_| {})); // the reader's panics are wanted
        let mut refused = 0;
        for at in 0..whole.len() {
            for change in [0x01, 0x80, 0xff] {
                let mut changed = whole.clone();
                changed[at] ^= change;
                refused += usize::from(catch_unwind(AssertUnwindSafe(|| read_or_absent(&changed))).expect("no panic"));
            }
        }
        let _ = std::panic::take_hook();
        assert!(refused > whole.len() / 2, "{refused} of {}", 3 * whole.len());
    }

    /// Whether a table is refused, or has no column x any more.
    fn read_or_absent(bytes: &[u8]) -> bool {
        let path = std::env::temp_dir().join(format!("spindrift-{}-damaged.parquet", std::process::id()));
        std::fs::write(&path, bytes).expect("written");
        let found = DataFile::read(&path, MOST_NUMBERS, &|_| true)
            .map(|data| data.column("x").is_none_or(|column| column.is_err()));
        std::fs::remove_file(&path).expect("removed");
        found.unwrap_or(true)
    }
}
