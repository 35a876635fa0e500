//! [`Identity`] of rows, recorded by every file of rows; [`seal`], by which a file proves its own bytes.

use crate::campaign::Plan;
use crate::ensemble::Part;
use crate::sampling::SampleId;
use crate::table::Column;
use bytes::Bytes;
use parquet::file::metadata::ParquetMetaDataReader;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::collections::{BTreeMap, HashMap};

/// Version of the files of a dataset: counts are Int64 since 2, parts have other sizes and bands coarser buckets since
/// 3; since 4 every file of rows has the whole [`Identity`]; since 5 bands of large campaigns count the first runs
/// only; since 6 `dataset.json` records the identity and the sizes of parts, and every file of rows is sealed.
pub const FORMAT: u32 = 6;

/// Version of the arithmetic of rows, which changes if the same row plan would give other bits; the instruction set is
/// no part of it. Since 2 Taylor steps have more orders and integrals of thrust are those of the direction cosine
/// matrix. Since 3 the Taylor series of the gravity gradient follow the orbit in the frame of the body; since 4
/// estimates count steps in part shadow in full. Since 5 what Taylor steps leave out under effects that change within
/// an arc is added up as vectors, and their growth of errors is averaged. Since 6 estimates follow errors through
/// repeated periods, past separatrices, and from perigee to perigee. Since 7 steps in penumbra count with their ratio
/// of error to estimate. Since 8 control loops read what depends on the orbit alone from series in time, their arcs
/// start with the step that their controller knows, and their errors are carried on through the closed loop. Since 9
/// densities are powers of two, torques of plates are fused, and short arcs of loops take steps of order five.
pub const ARITHMETIC: u32 = 9;

/// The identity of rows. Rows of two datasets with the same identity can be mixed.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Identity {
    /// Always `dataset`, the mark of a folder.
    pub spindrift: String,
    pub format: u32,
    pub arithmetic: u32,
    /// SHA-256 of the row plan, in hexadecimal.
    pub row_hash: String,
    pub seed: u64,
    /// SHA-256 of names and types of the columns, in hexadecimal.
    pub columns: String,
}

const MARK: &str = "dataset";
/// Metadata keys of a file of rows.
const FORMAT_KEY: &str = "spindrift.format";
const ARITHMETIC_KEY: &str = "spindrift.arithmetic";
const ROW_HASH_KEY: &str = "spindrift.row_hash";
const SEED_KEY: &str = "spindrift.seed";
const COLUMNS_KEY: &str = "spindrift.columns";
pub const PART_KEY: &str = "spindrift.part";
const FIRST_KEY: &str = "spindrift.first_sample";
const SAMPLES_KEY: &str = "spindrift.samples";
/// SHA-256 of the part's file of bands.
pub const BANDS_KEY: &str = "spindrift.part_bands_sha256";
/// The key, in Parquet's metadata or JSON, of the SHA-256 of all bytes with [`UNSEALED`] as the seal.
pub const SEAL_KEY: &str = "spindrift.seal";
pub const UNSEALED: &str = "0000000000000000000000000000000000000000000000000000000000000000";

fn hexadecimal(sha256: Sha256) -> String {
    sha256.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
}

pub fn sha256(bytes: &[u8]) -> String {
    hexadecimal(Sha256::new().chain_update(bytes))
}

/// Position of the first digit of the seal, after the key and two bytes of Parquet or up to four of JSON, none of them
/// a hexadecimal digit.
fn digits_of_seal(bytes: &[u8]) -> Option<usize> {
    let key = bytes.windows(SEAL_KEY.len()).rposition(|window| window == SEAL_KEY.as_bytes())? + SEAL_KEY.len();
    let start = (key..key + 5).find(|at| bytes.get(*at).is_some_and(u8::is_ascii_hexdigit))?;
    (start + UNSEALED.len() <= bytes.len()).then_some(start)
}

/// The seal that `bytes` should have at `start`, and the SHA-256 of the whole with `seal` there.
fn checksums(bytes: &[u8], start: usize, seal: Option<&[u8]>) -> [String; 2] {
    let (before, after) = (Sha256::new().chain_update(&bytes[..start]), &bytes[start + UNSEALED.len()..]);
    let expected = hexadecimal(before.clone().chain_update(UNSEALED).chain_update(after));
    let whole = before.chain_update(seal.unwrap_or(expected.as_bytes())).chain_update(after);
    [expected, hexadecimal(whole)]
}

/// Seals a file with [`UNSEALED`] under [`SEAL_KEY`]; returns its SHA-256, hexadecimal.
///
/// # Panics
/// If it has no such key.
pub fn seal(bytes: &mut [u8]) -> String {
    let start = digits_of_seal(bytes).expect("the key of the seal is there");
    let [seal, sha256] = checksums(bytes, start, None);
    bytes[start..start + seal.len()].copy_from_slice(seal.as_bytes());
    sha256
}

/// The SHA-256 of a file with a valid seal.
pub fn sealed(bytes: &[u8]) -> Option<String> {
    let start = digits_of_seal(bytes)?;
    let seal = &bytes[start..start + UNSEALED.len()];
    let [expected, sha256] = checksums(bytes, start, Some(seal));
    (expected.as_bytes() == seal).then_some(sha256)
}

pub fn of(plan: &Plan, columns: &[Column]) -> Identity {
    let line = |column: &Column| format!("{} {:?} {}\n", column.quantity.name(), column.content, column.nullable);
    let columns: String = columns.iter().map(line).collect();
    Identity {
        spindrift: MARK.to_owned(),
        format: FORMAT,
        arithmetic: ARITHMETIC,
        row_hash: plan.row_hash(),
        seed: plan.seed,
        columns: sha256(columns.as_bytes()),
    }
}

/// Metadata of a part in its file; `first` is the number of its first sample.
pub fn part_metadata(part: Part, first: SampleId) -> [(&'static str, String); 3] {
    [(PART_KEY, part.id.0.to_string()), (FIRST_KEY, first.to_string()), (SAMPLES_KEY, part.count.to_string())]
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RowsMetadata {
    pub identity: Identity,
    pub part: u64,
    pub first: u64,
    pub rows: u64,
    /// SHA-256 of the file of bands, if any.
    pub bands: Option<String>,
}

impl RowsMetadata {
    /// Reads the metadata; `None` unless it is a file of rows.
    pub fn of(bytes: Bytes) -> Option<Self> {
        let read = std::panic::catch_unwind(|| ParquetMetaDataReader::new().parse_and_finish(&bytes).ok());
        let metadata = read.ok().flatten()?;
        let pairs = metadata.file_metadata().key_value_metadata()?.iter();
        let pairs: HashMap<&str, &str> = pairs.filter_map(|pair| Some((&*pair.key, pair.value.as_deref()?))).collect();
        let number = |key: &str| pairs.get(key)?.parse::<u64>().ok();
        let text = |key: &str| pairs.get(key).map(|text| (*text).to_owned());
        let version = |key: &str| number(key)?.try_into().ok();
        let identity = Identity {
            spindrift: MARK.to_owned(),
            format: version(FORMAT_KEY)?,
            arithmetic: version(ARITHMETIC_KEY)?,
            row_hash: text(ROW_HASH_KEY)?,
            seed: number(SEED_KEY)?,
            columns: text(COLUMNS_KEY)?,
        };
        let [part, first, rows] = [number(PART_KEY)?, number(FIRST_KEY)?, number(SAMPLES_KEY)?];
        Some(RowsMetadata { identity, part, first, rows, bands: text(BANDS_KEY) })
    }
}

/// Identity and row plan for files of rows: all that changes rows. Name of the campaign, version of the program and
/// instruction set do not.
pub fn row_provenance(plan: &Plan, identity: &Identity) -> BTreeMap<String, String> {
    let pairs = [
        (FORMAT_KEY, identity.format.to_string()),
        (ARITHMETIC_KEY, identity.arithmetic.to_string()),
        (ROW_HASH_KEY, identity.row_hash.clone()),
        (SEED_KEY, identity.seed.to_string()),
        (COLUMNS_KEY, identity.columns.clone()),
        ("spindrift.row_plan", plan.row_text()),
    ];
    pairs.map(|(key, value)| (key.to_owned(), value)).into()
}

/// Version of the program, campaign, seed, and the plan with its hash, without the instruction set.
pub fn provenance(plan: &Plan) -> BTreeMap<String, String> {
    let pairs = [
        ("spindrift.version", env!("CARGO_PKG_VERSION").to_owned()),
        ("spindrift.campaign", plan.name.clone()),
        ("spindrift.seed", plan.seed.to_string()),
        ("spindrift.plan_hash", plan.hash()),
        ("spindrift.plan", plan.text()),
    ];
    pairs.map(|(key, value)| (key.to_owned(), value)).into()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: a sealed file has the returned SHA-256; any changed bit or truncation breaks its seal.
    #[test]
    fn every_changed_bit_breaks_the_seal() {
        let mut bytes = format!("{{\"a\": 1, \"{SEAL_KEY}\": \"{UNSEALED}\"}}\n").into_bytes();
        assert_eq!(sealed(&bytes), None);
        let whole = seal(&mut bytes);
        assert_eq!((sealed(&bytes), sha256(&bytes)), (Some(whole.clone()), whole));
        for bit in 0..8 * bytes.len() {
            let mut changed = bytes.clone();
            changed[bit / 8] ^= 1 << (bit % 8);
            assert_eq!(sealed(&changed), None, "bit {bit}");
            assert_eq!(sealed(&bytes[..bit / 8]), None, "the first {} bytes", bit / 8);
        }
    }
}
