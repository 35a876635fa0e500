//! [`RowsReader`]: reads the rows of a result by column names, one part at a time.
//!
//! Parquet's typed column reader decodes a column to a list of numbers without Arrow's arrays. Memory does not depend
//! on the number of rows. Panics of the Parquet reader on damaged files become errors.

use super::store::Store;
use crate::ensemble::threads::Threads;
use crate::run::Status;
use crate::sampling::SampleId;
use crate::storage::parallel::in_order;
use crate::storage::rows_file::{REASON, SAMPLE_ID, STATUS};
use crate::table::Values;
use bytes::Bytes;
use parquet::column::reader::{ColumnReader, ColumnReaderImpl};
use parquet::data_type::{ByteArray, DataType};
use parquet::errors::ParquetError;
use parquet::file::reader::{FileReader, SerializedFileReader};
use std::borrow::Cow;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use thiserror::Error;

#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("{path}: {what}")]
pub struct RowsError {
    pub path: String,
    pub what: String,
}

pub type Result<T, E = RowsError> = std::result::Result<T, E>;

/// The parts of a result, in the order of their samples.
#[derive(Clone, Debug)]
pub struct RowsReader {
    store: Arc<dyn Store>,
    /// Names of the files of rows and of bands.
    files: Vec<String>,
    bands: Vec<String>,
}

/// One file of rows, in memory.
pub struct PartReader {
    path: String,
    reader: SerializedFileReader<Bytes>,
    rows: usize,
}

impl RowsReader {
    /// A reader of `files` in `store` and their `bands`, in sample order.
    pub fn new(store: Arc<dyn Store>, files: Vec<String>, bands: Vec<String>) -> Self {
        RowsReader { store, files, bands }
    }

    pub fn store(&self) -> &dyn Store {
        &*self.store
    }

    pub fn bands(&self) -> &[String] {
        &self.bands
    }

    /// Opens a part; `None` after the last.
    ///
    /// # Errors
    /// A file that cannot be opened or is not Parquet.
    pub fn part(&self, index: usize) -> Option<Result<PartReader>> {
        self.files.get(index).map(|name| PartReader::open(&*self.store, name))
    }

    /// The parts with the first `rows` rows, in order.
    pub fn first_parts(&self, rows: usize) -> impl Iterator<Item = Result<PartReader>> + '_ {
        let mut opened = 0;
        (0..self.files.len()).map_while(move |index| {
            let part = self.part(index).filter(|_| opened < rows)?;
            opened += part.as_ref().map_or(0, PartReader::rows);
            Some(part)
        })
    }

    /// Reads every part on `threads` threads: `read` on any thread, `merge` in order. Few parts
    /// are held at a time.
    ///
    /// # Errors
    /// The first part, in order, that cannot be opened or for which `read` or `merge` fails.
    pub fn visit<T: Send, E: From<RowsError> + Send>(
        &self,
        threads: Threads,
        read: impl Fn(&mut PartReader) -> Result<T, E> + Sync,
        merge: impl FnMut(T) -> Result<(), E> + Send,
    ) -> Result<(), E> {
        let read_part = |index: usize| {
            let part = PartReader::open(&*self.store, &self.files[index]);
            part.map_err(E::from).and_then(|mut part| read(&mut part))
        };
        in_order(self.files.len(), threads, read_part, merge)
    }
}

/// The result of `read`, with a panic of the Parquet reader as an error.
fn caught<T>(path: &str, read: impl FnOnce() -> Result<T, ParquetError>) -> Result<T> {
    let what = match catch_unwind(AssertUnwindSafe(read)) {
        Ok(Ok(found)) => return Ok(found),
        Ok(Err(error)) => error.to_string(),
        Err(_) => "the file is damaged: the Parquet reader cannot decode it".to_owned(),
    };
    Err(RowsError { path: path.to_owned(), what })
}

fn general(what: impl Into<String>) -> ParquetError {
    ParquetError::General(what.into())
}

impl PartReader {
    /// Opens the file `name`.
    ///
    /// # Errors
    /// A file that cannot be opened or is not Parquet.
    pub fn open(store: &dyn Store, name: &str) -> Result<Self> {
        let shown = store.path(name).display().to_string();
        let bytes = store.get(name);
        let bytes = bytes.map_err(|error| RowsError { path: shown.clone(), what: error.to_string() })?;
        let (reader, rows) = caught(&shown, || {
            let reader = SerializedFileReader::new(Bytes::from(bytes))?;
            // thousands of small groups would take minutes
            let groups = reader.metadata().row_groups();
            let [group] = groups else {
                return Err(general(format!("has {} row groups, and a file of a result has one", groups.len())));
            };
            let rows = usize::try_from(group.num_rows()).map_err(|_| general("a negative number of rows"))?;
            Ok((reader, rows))
        })?;
        Ok(PartReader { path: shown, reader, rows })
    }

    /// The file, for messages.
    pub fn path(&self) -> &str {
        &self.path
    }

    pub fn rows(&self) -> usize {
        self.rows
    }

    pub fn metadata(&self, key: &str) -> Option<&str> {
        let pairs = self.reader.metadata().file_metadata().key_value_metadata()?;
        pairs.iter().find(|pair| pair.key == key)?.value.as_deref()
    }

    /// The names of the columns, in their order.
    pub fn names(&self) -> Vec<String> {
        let schema = self.reader.metadata().file_metadata().schema_descr();
        schema.columns().iter().map(|column| column.name().to_owned()).collect()
    }

    pub fn samples(&self) -> Result<Vec<SampleId>> {
        match self.values(SAMPLE_ID)? {
            Values::Count(values) => Ok(values.into_iter().map(SampleId).collect()),
            _ => Err(self.failed(format!("`{SAMPLE_ID}` is not a column of whole numbers without gaps"))),
        }
    }

    /// The statuses by row.
    ///
    /// # Errors
    /// A missing or damaged column, or an unknown status.
    pub fn statuses(&self) -> Result<Vec<Status>> {
        let (Decoded::Text(texts), None) = self.decoded(STATUS)? else {
            return Err(self.failed(format!("`{STATUS}` is not a column of texts without gaps")));
        };
        let status = |text: &ByteArray| {
            let found = Status::ALL.into_iter().find(|status| status.name().as_bytes() == text.data());
            found.ok_or_else(|| self.failed(format!("unknown status {:?}", String::from_utf8_lossy(text.data()))))
        };
        texts.iter().map(status).collect()
    }

    /// Why each run is not `ok`, by row.
    pub fn reasons(&self) -> Result<Vec<Option<String>>> {
        match self.values(REASON)? {
            Values::Text(texts) => Ok(texts.into_iter().map(|text| text.map(Cow::into_owned)).collect()),
            _ => Err(self.failed(format!("`{REASON}` is not a column of texts"))),
        }
    }

    /// The numbers of the column `name` by row: counts as doubles, null as NaN.
    ///
    /// # Errors
    /// A missing or damaged column, or one without numbers.
    pub fn numbers(&self, name: &str) -> Result<Vec<f64>> {
        match self.values(name)? {
            Values::Real(values) | Values::Counted(values) => Ok(values.into_owned()),
            Values::Count(values) => Ok(values.into_iter().map(|value| value as f64).collect()),
            Values::Text(_) => Err(self.failed(format!("`{name}` is not a column of numbers"))),
        }
    }

    pub fn values(&self, name: &str) -> Result<Values<'static>> {
        Ok(match self.decoded(name)? {
            (Decoded::Real(values), None) => Values::Real(values.into()),
            (Decoded::Real(values), Some(levels)) => Values::Real(spread(values.into_iter(), &levels, f64::NAN)),
            (Decoded::Count(values), None) => Values::Count(values.into_iter().map(i64::cast_unsigned).collect()),
            (Decoded::Count(values), Some(levels)) => {
                let values = values.into_iter().map(|value| value.cast_unsigned() as f64);
                Values::Counted(spread(values, &levels, f64::NAN))
            }
            (Decoded::Text(texts), levels) => {
                let texts = texts.iter().map(|text| Some(String::from_utf8_lossy(text.data()).into_owned().into()));
                Values::Text(spread(texts, &levels.unwrap_or_else(|| vec![1; self.rows]), None))
            }
        })
    }

    fn failed(&self, what: String) -> RowsError {
        RowsError { path: self.path.clone(), what }
    }

    /// The values of the column `name` without gaps, and the present rows (1) unless all are.
    fn decoded(&self, name: &str) -> Result<(Decoded, Option<Vec<i16>>)> {
        caught(&self.path, || {
            let schema = self.reader.metadata().file_metadata().schema_descr_ptr();
            let index = schema.columns().iter().position(|column| column.name() == name);
            let Some(index) = index else { return Err(general(format!("there is no column `{name}`"))) };
            let mut levels = match schema.column(index).max_def_level() {
                0 => None,
                1 => Some(Vec::with_capacity(self.rows)),
                _ => return Err(general(format!("`{name}` is nested"))),
            };
            let values = match self.reader.get_row_group(0)?.get_column_reader(index)? {
                ColumnReader::DoubleColumnReader(reader) => Decoded::Real(self.column(reader, &mut levels)?),
                ColumnReader::Int64ColumnReader(reader) => Decoded::Count(self.column(reader, &mut levels)?),
                ColumnReader::ByteArrayColumnReader(reader) => Decoded::Text(self.column(reader, &mut levels)?),
                _ => {
                    let of = schema.column(index).physical_type();
                    return Err(general(format!("`{name}` has the type {of}, which no file of rows has")));
                }
            };
            Ok((values, levels.filter(|levels| levels.contains(&0))))
        })
    }

    fn column<T: DataType>(
        &self,
        mut reader: ColumnReaderImpl<T>,
        levels: &mut Option<Vec<i16>>,
    ) -> Result<Vec<T::T>, ParquetError> {
        let (mut values, mut read) = (Vec::with_capacity(self.rows), 0);
        while read < self.rows {
            let (records, _, _) = reader.read_records(self.rows - read, levels.as_mut(), None, &mut values)?;
            if records == 0 {
                return Err(general(format!("a column has {read} values where the file has {} rows", self.rows)));
            }
            read += records;
        }
        Ok(values)
    }
}

enum Decoded {
    Real(Vec<f64>),
    Count(Vec<i64>),
    Text(Vec<ByteArray>),
}

/// The next of `values` for each present row (1), else `none`.
fn spread<T: Clone, C: FromIterator<T>>(mut values: impl Iterator<Item = T>, levels: &[i16], none: T) -> C {
    let mut value = |level: &i16| if *level == 1 { values.next() } else { None };
    levels.iter().map(|level| value(level).unwrap_or_else(|| none.clone())).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::Quantity;
    use crate::storage::columnar::{Layout, Packing};
    use crate::storage::disk::folder as store;
    use crate::storage::scratch::Scratch;
    use crate::table::{Column, Content};
    use std::collections::BTreeMap;
    use std::fs::File;
    use std::path::Path;

    fn reader_of(folder: &Path, files: Vec<String>) -> RowsReader {
        RowsReader::new(store(folder), files, Vec::new())
    }

    fn heading(name: &'static str, content: Content) -> Column {
        Column::new(Quantity::new(name, "", "A column."), content)
    }

    fn file(folder: &Path, first: u64) -> String {
        let headings = [
            heading(SAMPLE_ID, Content::Count),
            heading(STATUS, Content::Word),
            heading(REASON, Content::Word).nullable(),
            heading("x", Content::Real).nullable(),
            heading("steps", Content::Count).nullable(),
        ];
        let layout = Layout::new(&headings, BTreeMap::new(), Packing::Lz4).expect("a layout");
        let name = format!("part-{first:06}.parquet");
        let out = File::create(folder.join(&name)).expect("a file");
        let x = [first as f64 + 0.5, f64::NAN, 41.5];
        let values = [
            Values::Count((first..first + 3).collect()),
            Values::words(["ok", "step_limit", "ok"]),
            Values::Text(vec![None, Some("too long".into()), None]),
            Values::Real((&x).into()),
            Values::Counted(vec![7.0, f64::NAN, 9.0].into()),
        ];
        layout.write(out, &[], values.into_iter()).expect("written");
        name
    }

    /// Law: rows are read as written; null is NaN, counts are doubles.
    #[test]
    fn rows_are_read_as_written() {
        let folder = Scratch::new("rows-read");
        let reader = reader_of(&folder, vec![file(&folder, 40)]);
        let part = reader.part(0).expect("one part").expect("readable");
        assert_eq!((part.rows(), part.samples()), (3, Ok(vec![SampleId(40), SampleId(41), SampleId(42)])));
        assert_eq!(part.statuses(), Ok(vec![Status::Done, Status::StepLimit, Status::Done]));
        assert_eq!(part.reasons(), Ok(vec![None, Some("too long".to_owned()), None]));
        assert_eq!(part.names(), [SAMPLE_ID, STATUS, REASON, "x", "steps"]);
        let (x, steps) = (part.numbers("x").expect("x"), part.numbers("steps").expect("steps"));
        assert!(x[0] == 40.5 && x[1].is_nan() && x[2] == 41.5, "{x:?}");
        assert!(steps[0] == 7.0 && steps[1].is_nan() && steps[2] == 9.0, "{steps:?}");
        assert!(part.numbers("y").expect_err("no such column").to_string().ends_with("there is no column `y`"));
        assert!(part.numbers(STATUS).expect_err("words").what.contains("not a column of numbers"));
        assert!(reader.part(1).is_none());
    }

    /// Law: a file with other than one row group is refused.
    #[test]
    fn files_of_many_groups_are_refused() {
        let folder = Scratch::new("rows-groups");
        let layout =
            Layout::new(&[heading(SAMPLE_ID, Content::Count)], BTreeMap::new(), Packing::Lz4).expect("a layout");
        let opened = |groups: u64| {
            let path = folder.join(format!("{groups}.parquet"));
            let mut writer = layout.begin(File::create(&path).expect("a file"), &[]).expect("begun");
            for group in 0..groups {
                writer.group(std::iter::once(Values::Count(vec![group]))).expect("written");
            }
            writer.finish().expect("finished");
            PartReader::open(&*store(&folder), &format!("{groups}.parquet")).map(|part| part.rows())
        };
        assert_eq!(opened(1), Ok(1));
        for groups in [0, 2, 6000] {
            assert!(opened(groups).is_err_and(|error| error.what.contains(&format!("has {groups} row groups"))));
        }
    }

    /// Law: the fewest parts with the first n rows are read.
    #[test]
    fn the_first_parts_have_the_first_rows() {
        let folder = Scratch::new("rows-first");
        let reader = reader_of(&folder, (0..3).map(|k| file(&folder, 3 * k)).collect());
        let parts = |rows: usize| reader.first_parts(rows).map(|part| part.expect("readable").rows()).sum::<usize>();
        assert_eq!([0, 1, 3, 4, 6, 7, 9, 100].map(parts), [0, 3, 3, 6, 6, 9, 9, 9]);
        let missing = reader_of(&folder, vec!["none.parquet".to_owned()]);
        assert!(missing.first_parts(1).next().is_some_and(|part| part.is_err()));
    }

    /// Law: a file damaged at any byte is an error that names it, never a panic.
    #[test]
    fn damaged_files_are_errors() {
        let folder = Scratch::new("rows-damaged");
        let whole = file(&folder, 0);
        let bytes = std::fs::read(folder.join(whole)).expect("bytes");
        let path = folder.join("damaged.parquet");
        let read = |content: &[u8]| -> Result<()> {
            std::fs::write(&path, content).expect("written");
            let part = PartReader::open(&*store(&folder), "damaged.parquet")?;
            part.samples()?;
            part.statuses()?;
            part.reasons()?;
            part.numbers("x")?;
            part.numbers("steps").map(|_| ())
        };
        assert_eq!(read(&bytes), Ok(()), "the counter-test: the whole file is read");
        let mut errors = 0;
        for at in (0..bytes.len()).step_by(7) {
            let mut damaged = bytes.clone();
            damaged[at] ^= 0x55;
            if let Err(error) = read(&damaged) {
                assert!(error.path.ends_with("damaged.parquet"), "{error}");
                errors += 1;
            }
        }
        assert!(errors > 20, "{errors} of {} flips are noticed", bytes.len() / 7);
        for length in [0, 3, bytes.len() / 2, bytes.len() - 1] {
            assert!(read(&bytes[..length]).is_err(), "{length} bytes");
        }
        std::fs::remove_file(&path).expect("removed");
        assert!(PartReader::open(&*store(&folder), "damaged.parquet").is_err());
    }
}
