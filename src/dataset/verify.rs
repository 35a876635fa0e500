//! [`damage`]: whether the files of a part are what the manifest says.

use std::path::Path;

use crate::dataset::identity::sha256;
use crate::dataset::manifest::PartRecord;
use crate::dataset::storage::Storage;

/// What is wrong with the files of a part in the dataset `root`; `None` where they are what was written.
pub fn damage(storage: &dyn Storage, root: &Path, part: &PartRecord) -> Option<String> {
    part.files.iter().find_map(|file| {
        let bytes = match storage.read(&root.join(&file.name), file.bytes) {
            Ok(bytes) => bytes,
            Err(error) => return Some(format!("{}: {error}", file.name)),
        };
        if bytes.len() as u64 != file.bytes {
            return Some(format!("{}: {} bytes instead of {}", file.name, bytes.len(), file.bytes));
        }
        (sha256(&bytes) != file.sha256).then(|| format!("{}: its content has changed", file.name))
    })
}

/// The parts in `parts` that are damaged, by number, each with what is wrong; `threads` read at the same time.
pub fn damaged(storage: &dyn Storage, root: &Path, parts: &[PartRecord], threads: usize) -> Vec<(u64, String)> {
    let next = std::sync::atomic::AtomicUsize::new(0);
    let check = || {
        let mut found = Vec::new();
        while let Some(part) = parts.get(next.fetch_add(1, std::sync::atomic::Ordering::Relaxed)) {
            found.extend(damage(storage, root, part).map(|what| (part.part, what)));
        }
        found
    };
    let mut found = std::thread::scope(|scope| {
        let readers: Vec<_> = (0..threads.clamp(1, parts.len().max(1))).map(|_| scope.spawn(check)).collect();
        readers.into_iter().flat_map(|reader| reader.join().unwrap_or_default()).collect::<Vec<_>>()
    });
    found.sort();
    found
}
