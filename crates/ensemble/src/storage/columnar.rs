//! Tables as Parquet; files of one kind share a [`Layout`].
//!
//! Arrow's schema (with units and meanings) is stored besides Parquet's; the typed column writer encodes rows from
//! their memory without a copy. The Arrow writer is a third slower. Floats have no dictionary (a file would be a
//! quarter larger and take five times as long); BYTE_STREAM_SPLIT lets their exponents compress.

use crate::storage::arrow_metadata;
use crate::table::{Column, Content, Table, Values};
use parquet::basic::{Compression, Encoding, LogicalType, Repetition, Type as Physical, ZstdLevel};
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType, Int64Type};
use parquet::errors::{ParquetError, Result};
use parquet::file::metadata::KeyValue;
use parquet::file::properties::{EnabledStatistics, WriterProperties};
use parquet::file::writer::{SerializedColumnWriter, SerializedFileWriter};
use parquet::schema::types::{ColumnPath, Type, TypePtr};
use std::borrow::Borrow;
use std::collections::BTreeMap;
use std::io::Write;
use std::sync::Arc;

pub use parquet::errors::ParquetError as EncodingError;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Packing {
    /// BYTE_STREAM_SPLIT and LZ4: nearly as small as zstd at twice the speed.
    Lz4,
    /// BYTE_STREAM_SPLIT and zstd, level 1: the smallest file.
    Zstd,
    /// PLAIN and uncompressed: the fastest, half as large again.
    Plain,
}

const ROOT: &str = "arrow_schema";

/// The common part of all files of one kind.
#[derive(Clone, Debug)]
pub struct Layout {
    columns: Vec<Column>,
    /// Metadata of every file, in order of the keys: files must not vary with a hash map.
    metadata: BTreeMap<String, String>,
    root: TypePtr,
    properties: WriterProperties,
    /// Arrow's schema, encoded once: for a small part that costs as much as tens of runs.
    arrow_schema: KeyValue,
}

impl Layout {
    /// Files with these columns and `metadata`.
    ///
    /// # Errors
    /// Two columns of one name.
    pub fn new(columns: &[Column], metadata: BTreeMap<String, String>, packing: Packing) -> Result<Self> {
        let mut names: Vec<&str> = columns.iter().map(|column| column.quantity.name()).collect();
        names.sort_unstable();
        if let Some(twice) = names.windows(2).find(|pair| pair[0] == pair[1]) {
            return Err(ParquetError::General(format!("two columns have the name `{}`", twice[0])));
        }
        let fields = columns.iter().map(field).collect::<Result<Vec<TypePtr>>>()?;
        let root = Arc::new(Type::group_type_builder(ROOT).with_fields(fields).build()?);
        let (properties, arrow_schema) = (properties(columns, packing), arrow_metadata::of(columns));
        Ok(Layout { columns: columns.to_vec(), metadata, root, properties, arrow_schema })
    }

    /// Omits the extremes of columns, which readers of whole files do not need.
    #[must_use]
    pub fn without_statistics(self) -> Self {
        let properties = self.properties.into_builder().set_statistics_enabled(EnabledStatistics::None).build();
        Layout { properties, ..self }
    }

    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// Writes a file with one [group](GroupWriter::group) of `values`; `own` is its own metadata.
    ///
    /// # Errors
    /// A failure of writing.
    pub fn write<'a, W: Write + Send>(
        &self,
        out: W,
        own: &[(&str, String)],
        values: impl Iterator<Item = impl Borrow<Values<'a>>>,
    ) -> Result<()> {
        let mut writer = self.begin(out, own)?;
        writer.group(values)?;
        writer.finish()
    }

    /// Begins a file of any number of row groups.
    pub fn begin<W: Write + Send>(&self, out: W, own: &[(&str, String)]) -> Result<GroupWriter<'_, W>> {
        let writer = SerializedFileWriter::new(out, self.root.clone(), Arc::new(self.properties(own)))?;
        Ok(GroupWriter { layout: self, writer, scratch: ColumnBuffers::default() })
    }

    fn properties(&self, own: &[(&str, String)]) -> WriterProperties {
        let pairs = self.metadata.iter().map(|(key, value)| (key.as_str(), value));
        let mut pairs: Vec<(&str, &String)> = pairs.chain(own.iter().map(|(key, value)| (*key, value))).collect();
        pairs.sort_unstable();
        let pairs = pairs.into_iter().map(|(key, value)| KeyValue::new(key.to_owned(), value.clone()));
        let pairs = pairs.chain([self.arrow_schema.clone()]).collect();
        self.properties.clone().into_builder().set_key_value_metadata(Some(pairs)).build()
    }
}

pub struct GroupWriter<'l, W: Write + Send> {
    layout: &'l Layout,
    writer: SerializedFileWriter<W>,
    scratch: ColumnBuffers,
}

impl<W: Write + Send> GroupWriter<'_, W> {
    /// Writes a row group of `values`, column by column, all of the same length.
    ///
    /// # Errors
    /// A failure of writing.
    ///
    /// # Panics
    /// If values and column differ in type.
    pub fn group<'a>(&mut self, values: impl Iterator<Item = impl Borrow<Values<'a>>>) -> Result<()> {
        let mut group = self.writer.next_row_group()?;
        for (column, values) in self.layout.columns.iter().zip(values) {
            let Some(mut writer) = group.next_column()? else { break };
            self.scratch.write(&mut writer, values.borrow(), column.nullable)?;
            writer.close()?;
        }
        group.close()?;
        Ok(())
    }

    pub fn finish(self) -> Result<()> {
        self.writer.close()?;
        Ok(())
    }
}

/// Encodes `table` with its notes and `metadata`.
///
/// # Errors
/// Two columns of one name, or a failed encoding.
pub fn encoded(table: &Table<'_>, mut metadata: BTreeMap<String, String>, packing: Packing) -> Result<Vec<u8>> {
    metadata.extend(table.notes.clone());
    let mut bytes = Vec::new();
    Layout::new(&table.columns, metadata, packing)?.write(&mut bytes, &[], table.values.iter())?;
    Ok(bytes)
}

fn field(column: &Column) -> Result<TypePtr> {
    let (physical, logical) = match column.content {
        Content::Real => (Physical::DOUBLE, None),
        // table engines have no unsigned integers (Spark, Trino), and no count is near 2^63
        Content::Count => (Physical::INT64, None),
        Content::Word => (Physical::BYTE_ARRAY, Some(LogicalType::String)),
    };
    let repetition = if column.nullable { Repetition::OPTIONAL } else { Repetition::REQUIRED };
    let field = Type::primitive_type_builder(column.quantity.name(), physical);
    field.with_repetition(repetition).with_logical_type(logical).build().map(Arc::new)
}

fn properties(columns: &[Column], packing: Packing) -> WriterProperties {
    let (compression, reals) = match packing {
        Packing::Lz4 => (Compression::LZ4_RAW, Encoding::BYTE_STREAM_SPLIT),
        Packing::Zstd => (Compression::ZSTD(ZstdLevel::default()), Encoding::BYTE_STREAM_SPLIT),
        Packing::Plain => (Compression::UNCOMPRESSED, Encoding::PLAIN),
    };
    // real numbers, in most columns, have the default encoding
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

/// Presence, and the present values without gaps, which Parquet takes separately.
#[derive(Default)]
struct ColumnBuffers {
    levels: Vec<i16>,
    reals: Vec<f64>,
    counts: Vec<i64>,
}

impl ColumnBuffers {
    fn write(&mut self, column: &mut SerializedColumnWriter<'_>, values: &Values<'_>, nullable: bool) -> Result<()> {
        match values {
            Values::Real(values) => {
                let is_whole = values.iter().all(|value| value.is_finite());
                self.set_levels(nullable, values.iter().map(|value| is_whole || value.is_finite()));
                let values = if is_whole {
                    values
                } else {
                    self.reals.clear();
                    self.reals.extend(values.iter().filter(|value| value.is_finite()));
                    &self.reals[..]
                };
                column.typed::<DoubleType>().write_batch(values, nullable.then_some(&self.levels[..]), None)?;
            }
            Values::Counted(values) => {
                self.set_levels(nullable, values.iter().map(|value| value.is_finite()));
                let present = values.iter().filter(|value| value.is_finite());
                self.write_counts(column, nullable, present.map(|value| *value as u64))?;
            }
            Values::Count(values) => {
                self.set_levels(nullable, values.iter().map(|_| true));
                self.write_counts(column, nullable, values.iter().copied())?;
            }
            Values::Text(texts) => {
                self.set_levels(nullable, texts.iter().map(Option::is_some));
                // the same text again shares its memory
                let mut last = ("", ByteArray::from(""));
                let shared = |text| {
                    if last.0 != text {
                        last = (text, ByteArray::from(text));
                    }
                    last.1.clone()
                };
                let texts: Vec<ByteArray> = texts.iter().filter_map(Option::as_deref).map(shared).collect();
                column.typed::<ByteArrayType>().write_batch(&texts, nullable.then_some(&self.levels[..]), None)?;
            }
        }
        Ok(())
    }

    fn write_counts(
        &mut self,
        column: &mut SerializedColumnWriter<'_>,
        nullable: bool,
        counts: impl Iterator<Item = u64>,
    ) -> Result<()> {
        self.counts.clear();
        self.counts.extend(counts.map(u64::cast_signed));
        column.typed::<Int64Type>().write_batch(&self.counts, nullable.then_some(&self.levels[..]), None)?;
        Ok(())
    }

    fn set_levels(&mut self, nullable: bool, present: impl Iterator<Item = bool>) {
        self.levels.clear();
        if nullable {
            self.levels.extend(present.map(i16::from));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::Quantity;
    use crate::table::{Cell, tests::every_kind};
    use parquet::file::reader::{FileReader, SerializedFileReader};
    use parquet::record::Field;

    fn written(packing: Packing) -> Vec<u8> {
        let table = Table { notes: BTreeMap::from([("part".into(), "3".into())]), ..every_kind() };
        encoded(&table, BTreeMap::from([("seed".into(), "7".into())]), packing).unwrap()
    }

    fn read(bytes: Vec<u8>) -> SerializedFileReader<bytes::Bytes> {
        SerializedFileReader::new(bytes::Bytes::from(bytes)).unwrap()
    }

    /// Law: cells of every kind come back from Parquet bit for bit, in every packing; absent and non-finite ones are
    /// null.
    #[test]
    fn parquet_comes_back() {
        let table = every_kind();
        for packing in [Packing::Lz4, Packing::Zstd, Packing::Plain] {
            let file = read(written(packing));
            let lines: Vec<_> = file.get_row_iter(None).unwrap().map(|row| row.unwrap().into_columns()).collect();
            assert_eq!(lines.len(), table.rows());
            for (row, line) in lines.into_iter().enumerate() {
                for ((column, values), (name, found)) in table.columns.iter().zip(&table.values).zip(line) {
                    assert_eq!(name, column.quantity.name());
                    match (values.cell(row), found) {
                        (Cell::Null, Field::Null) => {}
                        (Cell::Real(number), Field::Double(found)) => assert_eq!(found.to_bits(), number.to_bits()),
                        (Cell::Count(count), Field::Long(found)) => assert_eq!(found.cast_unsigned(), count),
                        (Cell::Text(text), Field::Str(found)) => assert_eq!(found, text),
                        (cell, found) => panic!("{name}, row {row}: {cell:?} came back as {found:?}"),
                    }
                }
            }
        }
    }

    /// Law: a file has its notes and metadata, and floats have no dictionary.
    #[test]
    fn a_file_explains_itself() {
        let file = read(written(Packing::Zstd));
        let pairs = file.metadata().file_metadata().key_value_metadata().unwrap();
        let value = |key: &str| pairs.iter().find(|pair| pair.key == key).and_then(|pair| pair.value.clone());
        assert_eq!((value("seed"), value("part")), (Some("7".to_owned()), Some("3".to_owned())));
        let floats = file.metadata().row_group(0).column(1);
        assert!(floats.dictionary_page_offset().is_none());
        assert!(floats.encodings().any(|encoding| encoding == Encoding::BYTE_STREAM_SPLIT));
        assert!(matches!(floats.compression(), Compression::ZSTD(_)));
    }

    #[test]
    fn files_are_reproducible() {
        assert_eq!(written(Packing::Zstd), written(Packing::Zstd));
        assert_ne!(written(Packing::Zstd), written(Packing::Plain));
        assert_ne!(written(Packing::Zstd), written(Packing::Lz4));
    }

    #[test]
    fn two_columns_of_one_name_are_refused() {
        let column = Column::new(Quantity::new("x", "", ""), Content::Real);
        let refused = Layout::new(&[column.clone(), column], BTreeMap::new(), Packing::Plain).unwrap_err();
        assert!(refused.to_string().contains("two columns have the name `x`"), "{refused}");
    }
}
