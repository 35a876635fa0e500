//! [`damaged`], [`derived_damage`]: whether the files of a dataset are what its manifest says, and their rows those of
//! its identity.
//!
//! A part is damaged where its files are there and have something else, or are not there. A file that cannot be read
//! now (an error of the disk or the network, no permission) is no damage: nothing is known about it, and no part is
//! given up for it.

use std::path::Path;

use crate::storage::disk::{Storage, StorageError, at, is_absent};
use crate::storage::identity::{in_rows, sha256};
use crate::storage::manifest::{FileRecord, Identity, PartRecord};
use crate::storage::names::RUNS;
use crate::storage::stored_file::is_unfit;

/// What is wrong with the files of a part in the dataset `root`, whose rows have the identity `identity`; `None` where
/// they are what was written.
fn damage(
    storage: &dyn Storage,
    root: &Path,
    identity: &Identity,
    part: &PartRecord,
) -> Result<Option<String>, StorageError> {
    for file in &part.files {
        let what = match content(storage, root, file)? {
            Err(what) => Some(what),
            Ok(bytes) if file.name.starts_with(RUNS) => foreign_rows(bytes, identity, part),
            Ok(_) => None,
        };
        if let Some(what) = what {
            return Ok(Some(format!("{}: {what}", file.name)));
        }
    }
    Ok(None)
}

/// What the metadata of the rows of `part` say that is not so: checksums alone say nothing about where a file comes
/// from.
fn foreign_rows(bytes: Vec<u8>, identity: &Identity, part: &PartRecord) -> Option<String> {
    match in_rows(bytes.into()) {
        Some((there, id, rows)) if there == *identity && id.0 == part.part && rows as u64 == part.rows => None,
        Some((there, ..)) if there != *identity => Some(format!(
            "has the rows of another plan (seed {} and row hash {}, not {} and {})",
            there.seed, there.row_hash, identity.seed, identity.row_hash
        )),
        Some((_, id, rows)) => Some(format!("has the {rows} rows of part {}", id.0)),
        None => Some("is not a file of rows".to_owned()),
    }
}

/// The content of a file; what is wrong with it, where it is not what was written.
fn content(storage: &dyn Storage, root: &Path, file: &FileRecord) -> Result<Result<Vec<u8>, String>, StorageError> {
    let path = root.join(&file.name);
    let bytes = match storage.read(&path, file.bytes) {
        Ok(bytes) => bytes,
        Err(error) if is_unfit(&error) || is_absent(storage, root, &path, &error)? => {
            return Ok(Err(error.to_string()));
        }
        Err(error) => return Err(at(&path)(error)),
    };
    Ok(if bytes.len() as u64 != file.bytes {
        Err(format!("{} bytes instead of {}", bytes.len(), file.bytes))
    } else if sha256(&bytes) != file.sha256 {
        Err("its content has changed".to_owned())
    } else {
        Ok(bytes)
    })
}

/// What is wrong with each of the files `derived` that follow from the rows of the dataset `root`.
///
/// # Errors
/// Where one cannot be read.
pub fn derived_damage<'f>(
    storage: &dyn Storage,
    root: &Path,
    derived: impl IntoIterator<Item = &'f FileRecord>,
) -> Result<Vec<String>, StorageError> {
    let mut found = Vec::new();
    for file in derived {
        found.extend(content(storage, root, file)?.err().map(|what| format!("{}: {what}", file.name)));
    }
    Ok(found)
}

/// The parts in `parts` that are damaged, by number, each with what is wrong; `threads` read at the same time.
///
/// # Errors
/// Where a file cannot be read: the first in the order of the parts of those that were tried.
pub fn damaged(
    storage: &dyn Storage,
    root: &Path,
    identity: &Identity,
    parts: &[PartRecord],
    threads: usize,
) -> Result<Vec<(u64, String)>, StorageError> {
    let next = std::sync::atomic::AtomicUsize::new(0);
    let check = || {
        let mut found = Vec::new();
        while let Some(part) = parts.get(next.fetch_add(1, std::sync::atomic::Ordering::Relaxed)) {
            let what = damage(storage, root, identity, part).transpose();
            let is_unreadable = what.as_ref().is_some_and(Result::is_err);
            found.extend(what.map(|what| (part.part, what)));
            if is_unreadable {
                break;
            }
        }
        found
    };
    let mut found = std::thread::scope(|scope| {
        let start = |_| std::thread::Builder::new().spawn_scoped(scope, check).ok();
        let readers: Vec<_> = (1..threads.min(parts.len())).map_while(start).collect();
        let own = check();
        let joined = readers.into_iter().map(|reader| reader.join());
        joined
            .flat_map(|found| found.unwrap_or_else(|panic| std::panic::resume_unwind(panic)))
            .chain(own)
            .collect::<Vec<_>>()
    });
    found.sort_by_key(|(part, _)| *part);
    found.into_iter().map(|(part, what)| what.map(|what| (part, what))).collect()
}
