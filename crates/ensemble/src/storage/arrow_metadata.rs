//! Arrow's schema in the metadata of a Parquet file, from which readers take the units and meanings of columns.
//!
//! The message "Schema" of Arrow's IPC format, preceded by its length, in base64 under the key `ARROW:schema` (Apache
//! Arrow, *Columnar Format*, "Serialization and Interprocess Communication", `Message.fbs`, `Schema.fbs`). The
//! FlatBuffer is written by hand: the crate that encodes it takes a sixth of a cold build.

use crate::table::{Column, Content};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use parquet::file::metadata::KeyValue;

const KEY: &str = "ARROW:schema";

const CONTINUATION: [u8; 4] = [0xff; 4];

const VERSION: i16 = 4;

const SCHEMA: u8 = 1;

/// The metadata entry with the columns, their units and meanings.
pub fn of(columns: &[Column]) -> KeyValue {
    let mut message = message(columns);
    message.resize(message.len().next_multiple_of(8), 0);
    let length = u32::try_from(message.len()).expect("a schema is smaller than 4 GB");
    let bytes = [&CONTINUATION[..], &length.to_le_bytes(), &message].concat();
    KeyValue::new(KEY.to_owned(), STANDARD.encode(bytes))
}

fn message(columns: &[Column]) -> Vec<u8> {
    let mut buffer = FlatBuffer(vec![0; 4]);
    let message = buffer.table(0, &[Slot::Short(VERSION), Slot::Byte(SCHEMA), Slot::Reference]);
    let schema = buffer.table(message[2], &[Slot::Default, Slot::Reference]);
    for (place, column) in buffer.vector(schema[1], columns.len()).into_iter().zip(columns) {
        buffer.field(place, column);
    }
    buffer.0
}

#[derive(Clone, Copy)]
enum Slot {
    Default,
    Byte(u8),
    Short(i16),
    Int(i32),
    /// Place of a table, vector or text written later.
    Reference,
}

/// A FlatBuffer written front to back, references first. Every field takes four bytes, so that all are aligned.
struct FlatBuffer(Vec<u8>);

impl FlatBuffer {
    /// Writes a table referred to at `referring`; returns the place of each field.
    fn table(&mut self, referring: usize, slots: &[Slot]) -> Vec<usize> {
        let size = |count: usize| u16::try_from(4 + count).expect("tables of the format have few fields");
        let stored = slots.iter().filter(|slot| !matches!(slot, Slot::Default)).count();
        // the table, directly behind its list of fields, is aligned
        self.0.resize((self.0.len() + 2 * slots.len()).next_multiple_of(4) - 2 * slots.len(), 0);
        let list = self.0.len();
        self.0.extend(size(2 * slots.len()).to_le_bytes());
        self.0.extend(size(4 * stored).to_le_bytes());
        let mut next = 4_u16;
        for slot in slots {
            let place = if matches!(slot, Slot::Default) { 0 } else { next };
            self.0.extend(place.to_le_bytes());
            next += if place == 0 { 0 } else { 4 };
        }
        let table = self.0.len();
        self.refer(referring, table);
        self.0.extend(distance(list, table).to_le_bytes());
        let mut places = Vec::with_capacity(slots.len());
        for slot in slots {
            places.push(self.0.len());
            let bytes = match *slot {
                Slot::Default => continue,
                Slot::Byte(value) => [value, 0, 0, 0],
                Slot::Short(value) => i32::from(value).to_le_bytes(),
                Slot::Int(value) => value.to_le_bytes(),
                Slot::Reference => [0; 4],
            };
            self.0.extend(bytes);
        }
        places
    }

    /// Writes a vector of `length` references; returns their places.
    fn vector(&mut self, referring: usize, length: usize) -> Vec<usize> {
        self.refer(referring, self.0.len());
        self.0.extend(distance(0, length).to_le_bytes());
        let start = self.0.len();
        self.0.resize(start + 4 * length, 0);
        (start..start + 4 * length).step_by(4).collect()
    }

    /// Writes length, bytes and a zero.
    fn text(&mut self, referring: usize, text: &str) {
        self.refer(referring, self.0.len());
        self.0.extend(distance(0, text.len()).to_le_bytes());
        self.0.extend(text.as_bytes());
        self.0.resize((self.0.len() + 1).next_multiple_of(4), 0);
    }

    /// The table `Field`, its type and its `KeyValue`s.
    fn field(&mut self, referring: usize, column: &Column) {
        // members of the union `Type`: Int (bits, signed), FloatingPoint (precision: 2 is double), Utf8
        let (member, slots): (u8, &[Slot]) = match column.content {
            Content::Count => (2, &[Slot::Int(64), Slot::Byte(1)]),
            Content::Real => (3, &[Slot::Short(2)]),
            Content::Word => (5, &[]),
        };
        // name, nullable, member and table of the type, dictionary, children, metadata
        let (nullable, member, reference) =
            (Slot::Byte(u8::from(column.nullable)), Slot::Byte(member), Slot::Reference);
        let field =
            self.table(referring, &[reference, nullable, member, reference, Slot::Default, reference, reference]);
        let quantity = &column.quantity;
        self.text(field[0], quantity.name());
        self.table(field[3], slots);
        self.vector(field[5], 0); // Arrow's C++ library wants it, even empty
        let pairs = [("unit", quantity.unit()), ("meaning", quantity.meaning())];
        for (place, (key, value)) in self.vector(field[6], pairs.len()).into_iter().zip(pairs) {
            let places = self.table(place, &[Slot::Reference, Slot::Reference]);
            self.text(places[0], key);
            self.text(places[1], value);
        }
    }

    /// Points the four bytes at `referring` to `place`.
    fn refer(&mut self, referring: usize, place: usize) {
        self.0[referring..referring + 4].copy_from_slice(&distance(referring, place).to_le_bytes());
    }
}

/// The distance between two places, or a length.
fn distance(from: usize, to: usize) -> u32 {
    u32::try_from(to - from).expect("a schema is smaller than 4 GB")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::Quantity;
    use arrow_ipc::convert::try_schema_from_ipc_buffer;
    use arrow_schema::{DataType, Field, Schema};
    use std::collections::HashMap;

    /// Law: Arrow's own reader, which verifies a buffer, finds every column with its type and metadata, at every
    /// alignment.
    #[test]
    fn arrow_reads_the_schema() {
        let types =
            [(Content::Real, DataType::Float64), (Content::Count, DataType::Int64), (Content::Word, DataType::Utf8)];
        for count in [0, 1, 30] {
            let (columns, fields): (Vec<Column>, Vec<Field>) = (0..count)
                .map(|index: usize| {
                    let (content, of) = types[index % 3].clone();
                    let (name, unit, meaning) = ("n".repeat(index + 1), "m".repeat(index % 5), "µ".repeat(index % 7));
                    let metadata = [("unit", &unit), ("meaning", &meaning)];
                    let metadata: HashMap<_, _> = metadata.map(|(key, value)| (key.to_owned(), value.clone())).into();
                    let field = Field::new(&name, of, index.is_multiple_of(2)).with_metadata(metadata);
                    let quantity = Quantity::named(name, unit, meaning);
                    (Column { nullable: index.is_multiple_of(2), ..Column::new(quantity, content) }, field)
                })
                .unzip();
            let entry = of(&columns);
            let bytes = STANDARD.decode(entry.value.unwrap()).unwrap();
            assert_eq!(entry.key, "ARROW:schema");
            assert_eq!(bytes.len() % 8, 0, "messages are padded");
            assert_eq!(try_schema_from_ipc_buffer(&bytes).unwrap(), Schema::new(fields), "{count} columns");
        }
    }
}
