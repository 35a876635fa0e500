//! The names of the files of a dataset. Files with other names are foreign and never changed.

use crate::ensemble::PartId;
use std::hash::{BuildHasher, RandomState};
use std::path::{Path, PathBuf};

/// Identity of the dataset.
pub const HEAD: &str = "dataset.json";
pub const PLAN: &str = "plan.toml";
/// List of the files of a finished dataset.
pub const MANIFEST: &str = "manifest.json";
/// The empty file that marks a finished dataset.
pub const SUCCESS: &str = "_SUCCESS";
pub const SUMMARY: &str = "summary.json";
pub const STATISTICS: &str = "statistics.parquet";
/// Derived observables, sample by sample.
pub const OBSERVABLES: &str = "observables.parquet";
pub const SENSITIVITY: &str = "sensitivity.parquet";
pub const BANDS: &str = "bands.parquet";
pub const REPORT: &str = "report.html";
pub const RUNS: &str = "runs";
pub const PART_BANDS: &str = "bands";
/// Retained time series.
pub const TRAJECTORIES: &str = "trajectories";
/// Copies of the data files and the module of the plan, named by SHA-256.
pub const DATA: &str = crate::campaign::data::COPIES;
/// Suffix of an unfinished file.
pub const UNFINISHED: &str = ".tmp";

pub const TOP_FILES: [&str; 10] =
    [HEAD, PLAN, MANIFEST, SUCCESS, SUMMARY, STATISTICS, OBSERVABLES, SENSITIVITY, BANDS, REPORT];

pub const FOLDERS: [&str; 4] = [RUNS, PART_BANDS, TRAJECTORIES, DATA];

pub fn rows_of(part: PartId) -> String {
    format!("{RUNS}/part-{:06}.parquet", part.0)
}

pub fn bands_of(part: PartId) -> String {
    format!("{PART_BANDS}/part-{:06}.parquet", part.0)
}

/// The part whose file of rows has this name.
pub fn part_of(name: &str) -> Option<PartId> {
    let number = name.strip_prefix(RUNS)?.strip_prefix("/part-")?.strip_suffix(".parquet")?.parse().ok()?;
    Some(PartId(number)).filter(|part| rows_of(*part) == name)
}

pub fn is_of_part(name: &str) -> bool {
    [RUNS, PART_BANDS].contains(&name.split('/').next().unwrap_or_default())
}

/// A temporary name for the file `path`, different in each process.
pub fn unfinished(path: &Path) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(format!(".{:016x}{UNFINISHED}", RandomState::new().hash_one(std::process::id())));
    PathBuf::from(name)
}

/// True if `text` is 16 hexadecimal digits.
pub fn is_digits(text: &str) -> bool {
    text.len() == 16 && text.bytes().all(|byte| byte.is_ascii_digit() || (b'a'..=b'f').contains(&byte))
}

/// True if a dataset may have a file `name`, whole or not.
pub fn is_ours(name: &str) -> bool {
    let whole = match name.strip_suffix(UNFINISHED).and_then(|name| name.rsplit_once('.')) {
        Some((whole, digits)) if is_digits(digits) => whole,
        _ => name,
    };
    let (folder, file) = whole.split_once('/').unwrap_or(("", whole));
    let is_numbered = |start: &str| {
        let number = file.strip_prefix(start).and_then(|rest| rest.strip_suffix(".parquet"));
        number.is_some_and(|number| number.len() >= 6 && number.bytes().all(|byte| byte.is_ascii_digit()))
    };
    match folder {
        "" => TOP_FILES.contains(&file),
        RUNS | PART_BANDS => is_numbered("part-"),
        TRAJECTORIES => is_numbered("sample-"),
        DATA => file.split_once('.').is_some_and(|(sha256, extension)| {
            let is_checksum = sha256.len() == 64 && sha256.bytes().all(|byte| byte.is_ascii_hexdigit());
            is_checksum && ["csv", "parquet", "wasm"].contains(&extension)
        }),
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: a dataset recognises its own names, whole or not, and no others.
    #[test]
    fn own_names_are_recognised() {
        let parts = [rows_of(PartId(3)), bands_of(PartId(3)), rows_of(PartId(12_345_678))];
        for name in parts.iter().map(String::as_str).chain(TOP_FILES) {
            let temporary = [(); 2].map(|()| unfinished(Path::new(name)));
            assert!(temporary[0] != temporary[1] && is_ours(temporary[0].to_str().unwrap()), "{temporary:?}");
            assert!(is_ours(name), "{name}");
        }
        assert_eq!([&*parts[0], &*parts[1], "runs/part-3.parquet"].map(part_of), [Some(PartId(3)), None, None]);
        for name in [
            "terraform.plan",
            "notes.txt",
            "plan.toml.tmp",
            "runs/part-00000-6f1c.snappy.parquet",
            "runs/part-.parquet",
            "runs/part-000000.parquet.bak.tmp",
            "runs/a/part-000000.parquet",
            "data/table.csv",
            "other/part-000000.parquet",
            "../runs/part-000000.parquet",
        ] {
            assert!(!is_ours(name), "{name}");
        }
    }
}
