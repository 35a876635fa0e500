//! [`Payload`]: the numbers of the page as binary.

use std::io::Write;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use flate2::{Compression, GzBuilder};
use serde_json::{Value, json};

/// Arrays of numbers, one after the other.
#[derive(Clone, Debug, Default)]
pub struct Payload {
    doubles: Vec<u8>,
    /// Whether numbers stand where they are used, and not here.
    is_inline: bool,
}

impl Payload {
    /// No payload: numbers stand where they are used.
    pub fn inline() -> Self {
        Payload { is_inline: true, ..Payload::default() }
    }

    /// Adds numbers in full precision; returns the place where the page finds them.
    pub fn array(&mut self, values: &[f64]) -> Value {
        if self.is_inline {
            return json!(values);
        }
        let at = self.doubles.len();
        values.iter().for_each(|value| self.doubles.extend((value + 0.0).to_le_bytes()));
        json!([at, values.len(), 8])
    }

    /// Adds numbers in single precision, for pictures of motion; returns the place where the page finds them.
    pub fn singles(&mut self, values: &[f64]) -> Value {
        let at = self.doubles.len();
        values.iter().for_each(|value| self.doubles.extend((*value as f32).to_le_bytes()));
        // doubles begin at multiples of their size
        self.doubles.resize(self.doubles.len().next_multiple_of(8), 0);
        json!([at, values.len(), 4])
    }

    /// All numbers, little-endian, compressed, as text.
    pub fn text(&self) -> String {
        packed(&self.doubles)
    }
}

/// Bytes compressed with gzip, as Base64 (RFC 4648). The same bytes give the same text: the header has no time and no
/// name.
///
/// At level 6: at level 9 compressing takes twice as long, for a page that is less than 1% shorter.
pub fn packed(bytes: &[u8]) -> String {
    let mut encoder = GzBuilder::new().mtime(0).write(Vec::new(), Compression::default());
    // writing to memory does not fail
    let compressed = encoder.write_all(bytes).and_then(|()| encoder.finish()).unwrap_or_default();
    encoded(&compressed)
}

/// Bytes as Base64.
pub fn encoded(bytes: &[u8]) -> String {
    STANDARD.encode(bytes)
}
