//! Arrow's schema within the metadata of a Parquet file, where readers find the unit and the meaning of a column.
//!
//! The format: the message "Schema" of Arrow's IPC format with its length before it, in base64, under the key `ARROW:schema` (Apache Arrow,
//! *Columnar Format*, "Serialization and Interprocess Communication"; Arrow's C++ library defines the key). The feature `arrow` of the parquet
//! crate does the same; it is a minute of build for two functions.

use arrow_ipc::writer::{DictionaryTracker, IpcDataGenerator, IpcWriteOptions};
use arrow_schema::Schema;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use parquet::file::metadata::KeyValue;

/// The key.
const KEY: &str = "ARROW:schema";

/// What comes before the length of a message.
const CONTINUATION: [u8; 4] = [0xff; 4];

/// The entry of the metadata that contains `schema`.
pub fn of(schema: &Schema) -> KeyValue {
    let mut dictionaries = DictionaryTracker::new(true);
    let options = IpcWriteOptions::default();
    let message =
        IpcDataGenerator::default().schema_to_bytes_with_dictionary_tracker(schema, &mut dictionaries, &options);
    let length = u32::try_from(message.ipc_message.len()).expect("a schema is smaller than 4 GB");
    let bytes = [&CONTINUATION[..], &length.to_le_bytes(), &message.ipc_message].concat();
    KeyValue::new(KEY.to_owned(), STANDARD.encode(bytes))
}

#[cfg(test)]
mod tests {
    use super::*;
    use arrow_ipc::convert::try_schema_from_ipc_buffer;
    use arrow_schema::{DataType, Field};
    use std::collections::HashMap;

    /// Law: the schema comes back, with the metadata of its fields.
    #[test]
    fn the_schema_comes_back() {
        let metadata = HashMap::from([("unit".to_owned(), "m".to_owned()), ("meaning".to_owned(), "A µ.".to_owned())]);
        let field = |name, of, nullable| Field::new(name, of, nullable).with_metadata(metadata.clone());
        let fields = [("x", DataType::Float64, true), ("n", DataType::Int64, false), ("s", DataType::Utf8, false)];
        let schema = Schema::new(fields.map(|(name, of, nullable)| field(name, of, nullable)).to_vec());
        let entry = of(&schema);
        let bytes = STANDARD.decode(entry.value.unwrap()).unwrap();
        assert_eq!((entry.key.as_str(), try_schema_from_ipc_buffer(&bytes).unwrap()), ("ARROW:schema", schema));
    }
}
