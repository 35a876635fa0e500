//! [`Layout`]: named columns with unit and meaning as a Parquet file.
//!
//! Arrow's schema (which carries unit and meaning as field metadata) beside Parquet's, with Parquet's typed column writer: columns are passed
//! from the memory of the rows to the encoder without a copy. The Arrow writer was rejected: it writes a third slower.
//! Floats have no dictionary (with one the file is a quarter larger and takes five times as long). The encoding
//! BYTE_STREAM_SPLIT makes their exponents compress.

use std::collections::{BTreeMap, HashMap};
use std::io::Write;
use std::sync::Arc;

use parquet::basic::{Compression, Encoding, ZstdLevel};
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType, Int64Type};
use parquet::errors::{ParquetError, Result};
use parquet::file::metadata::KeyValue;
use parquet::file::properties::{EnabledStatistics, WriterProperties};
use parquet::file::writer::{SerializedColumnWriter, SerializedFileWriter};
use parquet::schema::types::{ColumnPath, Type, TypePtr};

use crate::storage::arrow_metadata;

/// Why columns could not be encoded.
pub use parquet::errors::ParquetError as EncodingError;

pub use crate::storage::heading::{Content, Heading};

/// The values of a column.
#[derive(Clone, Debug)]
pub enum Cells<'a> {
    /// Real numbers; those that the mask calls absent are null, and so is what is no finite number: the maximum or the mean of a column is
    /// a number for every reader.
    Real(&'a [f64], Option<&'a [bool]>),
    /// Counts, with the same mask.
    Count(Vec<u64>, Option<&'a [bool]>),
    Word(Vec<&'static str>),
    /// Texts; absent ones are null.
    Text(Vec<Option<&'a str>>),
}

/// How a file is packed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Packing {
    /// BYTE_STREAM_SPLIT and LZ4: nearly as small as zstd at twice the speed.
    Lz4,
    /// BYTE_STREAM_SPLIT and zstd, level 1: the smallest file.
    Zstd,
    /// PLAIN and uncompressed: the fastest, half as large again.
    Plain,
}

/// The name of the root of a schema; readers take no notice of it.
const ROOT: &str = "arrow_schema";

/// What all files of one kind have in common.
#[derive(Clone, Debug)]
pub struct Layout {
    columns: Vec<Heading>,
    /// What every file says of itself, in order of the keys: that of a hash map changes from run to run, and files must not.
    metadata: BTreeMap<String, String>,
    root: TypePtr,
    /// Properties of every file, without its metadata.
    properties: WriterProperties,
    /// The schema as Arrow's readers look for it. It is encoded once: for a small part that costs as much as tens of runs.
    arrow_schema: KeyValue,
}

impl Layout {
    /// Files with these columns. `metadata` is written to every file.
    ///
    /// # Errors
    /// Where two columns have the same name.
    pub fn new(headings: &[Heading], metadata: HashMap<String, String>, packing: Packing) -> Result<Self> {
        let mut names: Vec<&str> = headings.iter().map(|heading| heading.quantity.name()).collect();
        names.sort_unstable();
        if let Some(twice) = names.windows(2).find(|pair| pair[0] == pair[1]) {
            return Err(ParquetError::General(format!("two columns have the name `{}`", twice[0])));
        }
        let columns = headings.iter().map(Heading::column).collect::<Result<Vec<TypePtr>>>()?;
        let root = Arc::new(Type::group_type_builder(ROOT).with_fields(columns).build()?);
        let properties = properties(headings, packing);
        let (arrow_schema, metadata) = (arrow_metadata::of(headings), metadata.into_iter().collect());
        Ok(Layout { columns: headings.to_vec(), metadata, root, properties, arrow_schema })
    }

    /// The same without the extremes of columns, which readers of the whole file need not know.
    #[must_use]
    pub fn without_statistics(self) -> Self {
        let properties = self.properties.into_builder().set_statistics_enabled(EnabledStatistics::None).build();
        Layout { properties, ..self }
    }

    pub fn columns(&self) -> &[Heading] {
        &self.columns
    }

    /// Writes one file: a row group of `cells`, column by column in the order of the headings, all of the same length.
    /// `own` is the metadata of this file only.
    ///
    /// # Errors
    /// Where writing fails.
    ///
    /// # Panics
    /// Where the type of the cells differs from the heading's.
    pub fn write<'a, W: Write + Send>(
        &self,
        out: W,
        own: &[(&str, String)],
        cells: impl Iterator<Item = Cells<'a>>,
    ) -> Result<()> {
        let mut writer = self.begin(out, own)?;
        writer.group(cells)?;
        writer.finish()
    }

    /// Begins a file of any number of row groups.
    ///
    /// # Errors
    /// Where writing fails.
    pub fn begin<W: Write + Send>(&self, out: W, own: &[(&str, String)]) -> Result<GroupWriter<'_, W>> {
        let writer = SerializedFileWriter::new(out, self.root.clone(), Arc::new(self.properties(own)))?;
        Ok(GroupWriter { layout: self, writer, scratch: ColumnBuffers::default() })
    }

    /// The properties of a file with the metadata `own`.
    fn properties(&self, own: &[(&str, String)]) -> WriterProperties {
        let pairs = self.metadata.iter().map(|(key, value)| (key.as_str(), value));
        let mut pairs: Vec<(&str, &String)> = pairs.chain(own.iter().map(|(key, value)| (*key, value))).collect();
        pairs.sort_unstable();
        let pairs = pairs.into_iter().map(|(key, value)| KeyValue::new(key.to_owned(), value.clone()));
        let pairs = pairs.chain([self.arrow_schema.clone()]).collect();
        self.properties.clone().into_builder().set_key_value_metadata(Some(pairs)).build()
    }
}

/// A file that is written row group by row group.
pub struct GroupWriter<'l, W: Write + Send> {
    layout: &'l Layout,
    writer: SerializedFileWriter<W>,
    scratch: ColumnBuffers,
}

impl<W: Write + Send> GroupWriter<'_, W> {
    /// Writes a row group: `cells`, column by column in the order of the headings, all of the same length.
    ///
    /// # Errors
    /// Where writing fails.
    ///
    /// # Panics
    /// Where the type of the cells differs from the heading's.
    pub fn group<'a>(&mut self, cells: impl Iterator<Item = Cells<'a>>) -> Result<()> {
        let mut group = self.writer.next_row_group()?;
        for (heading, cells) in self.layout.columns.iter().zip(cells) {
            let Some(mut column) = group.next_column()? else { break };
            self.scratch.write(&mut column, cells, heading.nullable)?;
            column.close()?;
        }
        group.close()?;
        Ok(())
    }

    /// Ends the file.
    ///
    /// # Errors
    /// Where writing fails.
    pub fn finish(self) -> Result<()> {
        self.writer.close()?;
        Ok(())
    }
}

/// Encodings and compression of the columns.
fn properties(columns: &[Heading], packing: Packing) -> WriterProperties {
    let (compression, reals) = match packing {
        Packing::Lz4 => (Compression::LZ4_RAW, Encoding::BYTE_STREAM_SPLIT),
        Packing::Zstd => (Compression::ZSTD(ZstdLevel::default()), Encoding::BYTE_STREAM_SPLIT),
        Packing::Plain => (Compression::UNCOMPRESSED, Encoding::PLAIN),
    };
    // most columns are real numbers: theirs is the encoding of columns without one of their own
    let mut properties = WriterProperties::builder().set_dictionary_enabled(false).set_encoding(reals);
    properties = properties.set_compression(compression);
    for column in columns {
        let path = || ColumnPath::from(column.quantity.name());
        properties = match column.content {
            Content::Word => {
                properties.set_column_dictionary_enabled(path(), true).set_column_encoding(path(), Encoding::PLAIN)
            }
            Content::Count => properties.set_column_encoding(path(), Encoding::DELTA_BINARY_PACKED),
            Content::Real => properties,
        };
    }
    properties.build()
}

/// Buffers for what Parquet takes separately: which values are present, and those values without gaps.
#[derive(Default)]
struct ColumnBuffers {
    levels: Vec<i16>,
    reals: Vec<f64>,
    counts: Vec<i64>,
}

impl ColumnBuffers {
    fn write(&mut self, column: &mut SerializedColumnWriter<'_>, cells: Cells<'_>, nullable: bool) -> Result<()> {
        match cells {
            Cells::Real(values, mask) => {
                let levels = self.levels(values.len(), mask, nullable);
                let is_whole = !mask.is_some_and(|mask| mask.contains(&false)) && values.iter().all(|x| x.is_finite());
                let values = if is_whole {
                    values
                } else {
                    self.levels.iter_mut().zip(values).for_each(|(level, x)| *level &= i16::from(x.is_finite()));
                    self.reals.clear();
                    self.reals
                        .extend(values.iter().zip(&self.levels).filter(|(_, level)| **level == 1).map(|(x, _)| *x));
                    &self.reals
                };
                column.typed::<DoubleType>().write_batch(values, levels.then_some(&self.levels[..]), None)?;
            }
            Cells::Count(values, mask) => {
                let levels = self.levels(values.len(), mask, nullable);
                self.counts.clear();
                match mask {
                    Some(mask) => self.counts.extend(present(&values, mask).map(u64::cast_signed)),
                    None => self.counts.extend(values.iter().map(|value| value.cast_signed())),
                }
                column.typed::<Int64Type>().write_batch(&self.counts, levels.then_some(&self.levels[..]), None)?;
            }
            Cells::Word(words) => {
                let levels = self.levels(words.len(), None, nullable);
                // the same word again shares its memory
                let mut last = ("", ByteArray::from(""));
                let shared = |word| {
                    if last.0 != word {
                        last = (word, ByteArray::from(word));
                    }
                    last.1.clone()
                };
                let words: Vec<ByteArray> = words.into_iter().map(shared).collect();
                column.typed::<ByteArrayType>().write_batch(&words, levels.then_some(&self.levels[..]), None)?;
            }
            Cells::Text(texts) => {
                let mask: Vec<bool> = texts.iter().map(Option::is_some).collect();
                let levels = self.levels(texts.len(), Some(&mask), nullable);
                let texts: Vec<ByteArray> = texts.into_iter().flatten().map(ByteArray::from).collect();
                column.typed::<ByteArrayType>().write_batch(&texts, levels.then_some(&self.levels[..]), None)?;
            }
        }
        Ok(())
    }

    /// Sets the definition levels (1 = present); false for a column that has none.
    fn levels(&mut self, length: usize, mask: Option<&[bool]>, nullable: bool) -> bool {
        self.levels.clear();
        if nullable {
            match mask {
                Some(mask) => self.levels.extend(mask.iter().map(|present| i16::from(*present))),
                None => self.levels.resize(length, 1),
            }
        }
        nullable
    }
}

fn present<'a, T: Copy>(values: &'a [T], mask: &'a [bool]) -> impl Iterator<Item = T> + 'a {
    values.iter().zip(mask).filter(|(_, present)| **present).map(|(value, _)| *value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::Quantity;
    use parquet::file::reader::{FileReader, SerializedFileReader};
    use parquet::record::Field as Cell;

    fn heading(name: &str, content: Content, nullable: bool) -> Heading {
        Heading { quantity: Quantity::named(name.into(), "m".to_owned(), format!("The {name}.")), content, nullable }
    }

    fn written(packing: Packing) -> Vec<u8> {
        let headings = [
            heading("id", Content::Count, false),
            heading("word", Content::Word, false),
            heading("x", Content::Real, true),
            heading("y", Content::Real, true),
        ];
        let layout = Layout::new(&headings, HashMap::from([("seed".into(), "7".into())]), packing).unwrap();
        let mut bytes = Vec::new();
        let cells = [
            Cells::Count(vec![0, 1, i64::MAX.unsigned_abs()], None),
            Cells::Word(vec!["ok", "ok", "bad"]),
            Cells::Real(&[1.5, f64::NAN, 2.5], Some(&[true, true, false])),
            Cells::Real(&[f64::INFINITY, -0.0, f64::NEG_INFINITY], None),
        ];
        layout.write(&mut bytes, &[("part", "3".into())], cells.into_iter()).unwrap();
        bytes
    }

    fn read(bytes: Vec<u8>) -> SerializedFileReader<bytes::Bytes> {
        SerializedFileReader::new(bytes::Bytes::from(bytes)).unwrap()
    }

    /// Law: what is written is read back, in every packing; absent is null, and so is what is no finite number, with a mask and without.
    #[test]
    fn values_come_back() {
        for packing in [Packing::Lz4, Packing::Zstd, Packing::Plain] {
            let file = read(written(packing));
            let rows = file.get_row_iter(None).unwrap();
            let rows = rows.map(|row| row.unwrap().into_columns().into_iter().map(|(_, cell)| cell).collect());
            let rows: Vec<Vec<Cell>> = rows.collect();
            let text = |text: &str| Cell::Str(text.to_owned());
            assert_eq!(rows[0], [Cell::Long(0), text("ok"), Cell::Double(1.5), Cell::Null]);
            assert_eq!(rows[1], [Cell::Long(1), text("ok"), Cell::Null, Cell::Double(-0.0)]);
            assert_eq!(rows[2], [Cell::Long(i64::MAX), text("bad"), Cell::Null, Cell::Null]);
            assert_eq!(rows.len(), 3);
        }
    }

    /// Law: the file says what it is told to say, and floats have no dictionary.
    #[test]
    fn a_file_explains_itself() {
        let file = read(written(Packing::Zstd));
        let pairs = file.metadata().file_metadata().key_value_metadata().unwrap();
        let value = |key: &str| pairs.iter().find(|pair| pair.key == key).and_then(|pair| pair.value.clone());
        assert_eq!((value("seed"), value("part")), (Some("7".to_owned()), Some("3".to_owned())));
        let floats = file.metadata().row_group(0).column(2);
        assert!(floats.dictionary_page_offset().is_none());
        assert!(floats.encodings().any(|encoding| encoding == Encoding::BYTE_STREAM_SPLIT));
        assert!(matches!(floats.compression(), Compression::ZSTD(_)));
    }

    /// Law: the same cells give the same bytes.
    #[test]
    fn files_are_reproducible() {
        assert_eq!(written(Packing::Zstd), written(Packing::Zstd));
        assert_ne!(written(Packing::Zstd), written(Packing::Plain));
        assert_ne!(written(Packing::Zstd), written(Packing::Lz4));
    }

    #[test]
    fn two_columns_of_one_name_are_refused() {
        let headings = [heading("x", Content::Real, false), heading("x", Content::Real, false)];
        let refused = Layout::new(&headings, HashMap::new(), Packing::Plain).unwrap_err();
        assert!(refused.to_string().contains("two columns have the name `x`"), "{refused}");
    }
}
