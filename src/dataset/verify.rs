//! [`damage`]: whether the files of a part are what the manifest says.
//!
//! A part is damaged where its files are there and have something else, or are not there. A file that cannot be read now (an error of the disk or
//! the network, no permission) is no damage: nothing is known about it, and no part is given up for it.

use std::path::Path;

use crate::dataset::identity::sha256;
use crate::dataset::manifest::{FileRecord, PartRecord};
use crate::dataset::storage::{Storage, StorageError, at, is_absent};
use crate::dataset::stored_file::is_unfit;

/// What is wrong with the files of a part in the dataset `root`; `None` where they are what was written.
///
/// # Errors
/// Where a file cannot be read.
pub fn damage(storage: &dyn Storage, root: &Path, part: &PartRecord) -> Result<Option<String>, StorageError> {
    for file in &part.files {
        if let Some(what) = damage_of(storage, root, file)? {
            return Ok(Some(format!("{}: {what}", file.name)));
        }
    }
    Ok(None)
}

fn damage_of(storage: &dyn Storage, root: &Path, file: &FileRecord) -> Result<Option<String>, StorageError> {
    let path = root.join(&file.name);
    let bytes = match storage.read(&path, file.bytes) {
        Ok(bytes) => bytes,
        Err(error) if is_unfit(&error) || is_absent(storage, root, &path, &error)? => {
            return Ok(Some(error.to_string()));
        }
        Err(error) => return Err(at(&path)(error)),
    };
    Ok(if bytes.len() as u64 != file.bytes {
        Some(format!("{} bytes instead of {}", bytes.len(), file.bytes))
    } else if sha256(&bytes) != file.sha256 {
        Some("its content has changed".to_owned())
    } else {
        None
    })
}

/// The parts in `parts` that are damaged, by number, each with what is wrong; `threads` read at the same time.
///
/// # Errors
/// Where a file cannot be read: the first in the order of the parts of those that were tried.
pub fn damaged(
    storage: &dyn Storage,
    root: &Path,
    parts: &[PartRecord],
    threads: usize,
) -> Result<Vec<(u64, String)>, StorageError> {
    let next = std::sync::atomic::AtomicUsize::new(0);
    let check = || {
        let mut found = Vec::new();
        while let Some(part) = parts.get(next.fetch_add(1, std::sync::atomic::Ordering::Relaxed)) {
            let what = damage(storage, root, part).transpose();
            let is_unreadable = what.as_ref().is_some_and(Result::is_err);
            found.extend(what.map(|what| (part.part, what)));
            if is_unreadable {
                break;
            }
        }
        found
    };
    let mut found = std::thread::scope(|scope| {
        let readers: Vec<_> = (0..threads.clamp(1, parts.len().max(1))).map(|_| scope.spawn(check)).collect();
        let joined = readers.into_iter().map(|reader| reader.join());
        joined.flat_map(|found| found.unwrap_or_else(|panic| std::panic::resume_unwind(panic))).collect::<Vec<_>>()
    });
    found.sort_by_key(|(part, _)| *part);
    found.into_iter().map(|(part, what)| what.map(|what| (part, what))).collect()
}
