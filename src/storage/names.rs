//! The names of the files of a dataset. What has another name is not ours, and is never changed.

use std::hash::{BuildHasher, RandomState};
use std::path::{Path, PathBuf};

use crate::ensemble::PartId;

pub const PLAN: &str = "plan.toml";
/// What the dataset consists of.
pub const MANIFEST: &str = "manifest.jsonl";
/// The empty file that says that everything is there.
pub const SUCCESS: &str = "_SUCCESS";
pub const SUMMARY: &str = "summary.json";
pub const STATISTICS: &str = "statistics.parquet";
/// The observables that the file derives, sample by sample.
pub const OBSERVABLES: &str = "observables.parquet";
pub const SENSITIVITY: &str = "sensitivity.parquet";
pub const BANDS: &str = "bands.parquet";
pub const REPORT: &str = "report.html";
/// Folder of the files of rows.
pub const RUNS: &str = "runs";
/// Folder of the bands of parts.
pub const PART_BANDS: &str = "bands";
/// Folder of the manifests of shards.
pub const SHARDS: &str = "shards";
/// Folder of the time series that are kept.
pub const TRAJECTORIES: &str = "trajectories";
/// Folder of copies of the files of numbers and the module that the plan names, each by its SHA-256.
pub const DATA: &str = crate::campaign::data::COPIES;
/// Suffix of a file that is not whole yet.
pub const UNFINISHED: &str = ".tmp";
/// The file that proves that a folder was made to replace another one ([`super::replacement`]).
pub const REPLACEMENT: &str = "_REPLACEMENT";

/// The files at the top of a dataset.
pub const TOP_FILES: [&str; 9] =
    [PLAN, MANIFEST, SUCCESS, SUMMARY, STATISTICS, OBSERVABLES, SENSITIVITY, BANDS, REPORT];

/// The folders of a dataset.
pub const FOLDERS: [&str; 5] = [RUNS, PART_BANDS, SHARDS, TRAJECTORIES, DATA];

/// The name of the file of rows of `part`, below the folder of the dataset.
pub fn rows_of(part: PartId) -> String {
    format!("{RUNS}/part-{:06}.parquet", part.0)
}

/// The name of the file of bands of `part`, below the folder of the dataset.
pub fn bands_of(part: PartId) -> String {
    format!("{PART_BANDS}/part-{:06}.parquet", part.0)
}

/// The name of the manifest of shard `shard` of `shards`, counted from 1.
pub fn manifest_of(shard: u64, shards: u64) -> String {
    format!("{SHARDS}/{shard}-of-{shards}.jsonl")
}

/// Whether the files in `folder` are those of parts, which the manifest lists.
pub fn is_of_parts(folder: &str) -> bool {
    folder == RUNS || folder == PART_BANDS
}

/// Whether the file `name`, below the folder of a dataset, follows from plan and rows: the last line of the manifest
/// lists it.
pub fn is_derived(name: &str) -> bool {
    let (folder, file) = name.split_once('/').unwrap_or(("", name));
    let is_own = [MANIFEST, SUCCESS, REPLACEMENT].contains(&name) || is_of_parts(folder) || folder == SHARDS;
    !is_own && !file.ends_with(UNFINISHED) && is_ours(folder, file)
}

/// Hexadecimal digits that no other process draws, on no machine, and no other call: from the random keys of a hash.
pub fn unique() -> String {
    format!("{:016x}", RandomState::new().hash_one(std::process::id()))
}

/// Whether `text` is what [`unique`] draws.
pub fn is_unique(text: &str) -> bool {
    text.len() == 16 && text.bytes().all(|byte| byte.is_ascii_digit() || (b'a'..=b'f').contains(&byte))
}

/// The name under which the file `path` is written until it is whole: processes that write it at the same time have a
/// name each.
pub fn unfinished(path: &Path) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(format!(".{}{UNFINISHED}", unique()));
    PathBuf::from(name)
}

/// The name that the file `name` has when it is whole.
fn whole(name: &str) -> &str {
    let Some(name) = name.strip_suffix(UNFINISHED) else { return name };
    match name.rsplit_once('.') {
        Some((whole, digits)) if is_unique(digits) => whole,
        _ => name,
    }
}

/// Whether a dataset may have a file `name` in `folder`, whole or not.
pub fn is_ours(folder: &str, name: &str) -> bool {
    let name = whole(name);
    let numbered = |start: &str, end: &str, digits: usize| {
        let number = name.strip_prefix(start).and_then(|rest| rest.strip_suffix(end));
        number.is_some_and(|number| number.len() >= digits && number.bytes().all(|byte| byte.is_ascii_digit()))
    };
    match folder {
        "" => TOP_FILES.contains(&name) || name == REPLACEMENT,
        RUNS | PART_BANDS => numbered("part-", ".parquet", 6),
        TRAJECTORIES => numbered("sample-", ".parquet", 6),
        DATA => name.split_once('.').is_some_and(|(sha256, extension)| {
            let is_checksum = sha256.len() == 64 && sha256.bytes().all(|byte| byte.is_ascii_hexdigit());
            is_checksum && ["csv", "parquet", "wasm"].contains(&extension)
        }),
        SHARDS => shard_of(name).is_some(),
        _ => false,
    }
}

/// Shard and number of shards of the manifest `name` in the folder of shards.
pub fn shard_of(name: &str) -> Option<(u64, u64)> {
    let (shard, shards) = name.strip_suffix(".jsonl")?.split_once("-of-")?;
    Some((shard.parse().ok()?, shards.parse().ok()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: every name that a dataset gives is its own, whole or not; names of other programs are not.
    #[test]
    fn own_names_are_recognised() {
        for name in [rows_of(PartId(3)), bands_of(PartId(3)), rows_of(PartId(12_345_678)), manifest_of(2, 13)] {
            let (folder, file) = name.split_once('/').unwrap();
            assert!(is_ours(folder, file) && is_ours(folder, &format!("{file}{UNFINISHED}")), "{name}");
            let (one, other) = (unfinished(Path::new(file)), unfinished(Path::new(file)));
            assert!(one != other && is_ours(folder, one.to_str().unwrap()), "{one:?} and {other:?}");
        }
        assert!(TOP_FILES.iter().all(|name| is_ours("", name)));
        assert_eq!(shard_of("2-of-13.jsonl"), Some((2, 13)));
        for (folder, name) in [
            ("", "terraform.plan"),
            ("", "notes.txt"),
            (RUNS, "part-00000-6f1c.snappy.parquet"),
            (RUNS, "part-.parquet"),
            (RUNS, "part-000000.parquet.bak.tmp"),
            (SHARDS, "x.jsonl"),
            (DATA, "table.csv"),
            ("other", "part-000000.parquet"),
        ] {
            assert!(!is_ours(folder, name), "{folder}/{name}");
        }
    }
}
