//! [`Identity`] of rows: of a plan and its columns ([`of`]), as the metadata of a file of rows ([`metadata`]), and read
//! from there ([`in_rows`]).

use bytes::Bytes;
use parquet::file::metadata::ParquetMetaDataReader;
use sha2::{Digest, Sha256};
use std::collections::{BTreeMap, HashMap};

use crate::campaign::Plan;
use crate::ensemble::{Part, PartId};
use crate::sampling::SampleId;
use crate::storage::manifest::{ARITHMETIC, FORMAT, Identity};
use crate::table::Column;

/// What an [`Identity`] calls itself.
const MARK: &str = "dataset";
/// Keys of the metadata of a file of rows: version of the format.
const FORMAT_KEY: &str = "spindrift.format";
const ARITHMETIC_KEY: &str = "spindrift.arithmetic";
/// Hash of the row plan.
const ROW_HASH_KEY: &str = "spindrift.row_hash";
const SEED_KEY: &str = "spindrift.seed";
const COLUMNS_KEY: &str = "spindrift.columns";
pub const PART_KEY: &str = "spindrift.part";
const FIRST_KEY: &str = "spindrift.first_sample";
const SAMPLES_KEY: &str = "spindrift.samples";

/// SHA-256 of `bytes`, in hexadecimal.
pub fn sha256(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

/// The identity of rows of `plan` with these columns.
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

/// What every file of rows says of them.
pub fn metadata(identity: &Identity) -> [(&'static str, String); 5] {
    [
        (FORMAT_KEY, identity.format.to_string()),
        (ARITHMETIC_KEY, identity.arithmetic.to_string()),
        (ROW_HASH_KEY, identity.row_hash.clone()),
        (SEED_KEY, identity.seed.to_string()),
        (COLUMNS_KEY, identity.columns.clone()),
    ]
}

/// What the file of rows of one part says of it: `first` is the number of its first sample.
pub fn part_metadata(part: Part, first: SampleId) -> [(&'static str, String); 3] {
    [(PART_KEY, part.id.0.to_string()), (FIRST_KEY, first.to_string()), (SAMPLES_KEY, part.count.to_string())]
}

/// The rows of a file, and number and size of its part, as its metadata say; `None` where the bytes are no file of
/// rows.
pub fn in_rows(bytes: Bytes) -> Option<(Identity, PartId, usize)> {
    let read = std::panic::catch_unwind(|| ParquetMetaDataReader::new().parse_and_finish(&bytes).ok());
    let metadata = read.ok().flatten()?;
    let pairs = metadata.file_metadata().key_value_metadata()?.iter();
    let pairs: HashMap<&str, &str> = pairs.filter_map(|pair| Some((&*pair.key, pair.value.as_deref()?))).collect();
    let identity = Identity {
        spindrift: MARK.to_owned(),
        format: pairs.get(FORMAT_KEY)?.parse().ok()?,
        arithmetic: pairs.get(ARITHMETIC_KEY)?.parse().ok()?,
        row_hash: (*pairs.get(ROW_HASH_KEY)?).to_owned(),
        seed: pairs.get(SEED_KEY)?.parse().ok()?,
        columns: (*pairs.get(COLUMNS_KEY)?).to_owned(),
    };
    Some((identity, PartId(pairs.get(PART_KEY)?.parse().ok()?), pairs.get(SAMPLES_KEY)?.parse().ok()?))
}

/// Identity of the rows and the row plan, for files of rows: all that changes them, and nothing else. The name of the
/// campaign, the version of the program and the instruction set are not part of it: no bit of a row depends on them.
pub fn row_provenance(plan: &Plan, identity: &Identity) -> BTreeMap<String, String> {
    let plan = ("spindrift.row_plan", plan.row_text());
    let pairs = metadata(identity).into_iter().chain([plan]);
    pairs.map(|(key, value)| (key.to_owned(), value)).collect()
}

/// Version of the program, campaign, seed, and the plan with its hash. The instruction set is not part of it: no bit of
/// a row depends on it.
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
