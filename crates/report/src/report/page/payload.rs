//! [`Payload`]: the numbers of the page as binary.

use std::io::Write;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use flate2::{Compression, GzBuilder};
use serde_json::{Value, json};

#[derive(Clone, Debug, Default)]
pub struct Payload {
    doubles: Vec<u8>,
    is_inline: bool,
}

impl Payload {
    /// No payload: numbers stay in the JSON.
    pub fn inline() -> Self {
        Payload { is_inline: true, ..Payload::default() }
    }

    /// Adds doubles; returns their location, or inline the numbers.
    pub fn array(&mut self, values: &[f64]) -> Value {
        if self.is_inline {
            return json!(values);
        }
        let at = self.doubles.len();
        values.iter().for_each(|value| self.doubles.extend((value + 0.0).to_le_bytes()));
        json!([at, values.len(), 8])
    }

    /// Adds single-precision numbers, for animations; returns their location.
    pub fn singles(&mut self, values: &[f64]) -> Value {
        let at = self.doubles.len();
        values.iter().for_each(|value| self.doubles.extend((*value as f32).to_le_bytes()));
        // align doubles
        self.doubles.resize(self.doubles.len().next_multiple_of(8), 0);
        json!([at, values.len(), 4])
    }

    /// All numbers, little-endian, compressed, as text.
    pub fn text(&self) -> String {
        packed(&self.doubles)
    }
}

/// Bytes compressed with gzip, as Base64 (RFC 4648); reproducible, without time and name in the header. Level 6: level
/// 9 takes twice as long for less than 1% of the page.
pub fn packed(bytes: &[u8]) -> String {
    let mut encoder = GzBuilder::new().mtime(0).write(Vec::new(), Compression::default());
    // writing to memory does not fail
    let compressed = encoder.write_all(bytes).and_then(|()| encoder.finish()).unwrap_or_default();
    encoded(&compressed)
}

pub fn encoded(bytes: &[u8]) -> String {
    STANDARD.encode(bytes)
}
