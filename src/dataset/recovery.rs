//! [`rebuild`]: the manifest of a dataset that has lost it, from what the files of rows say of themselves.
//!
//! The checksums are then those of the files as they are: whether their rows are those of the plan is found out by computing them again.

use std::path::Path;

use crate::dataset::identity::in_rows;
use crate::dataset::manifest::{FileRecord, Identity, Manifest, PartRecord};
use crate::dataset::names::{MANIFEST, bands_of, rows_of};
use crate::dataset::storage::{Storage, StorageError, at, is_absent};
use crate::dataset::stored_file::is_unfit;
use crate::dataset::whole_file::place;
use crate::ensemble::Parts;

/// Writes the manifest of the dataset in `root` with those of `parts` whose files have rows of `identity`; how many these are. `plan` is the
/// text of the plan. Where there are none, nothing is written.
///
/// # Errors
/// Where a file operation fails.
pub fn rebuild(
    storage: &dyn Storage,
    root: &Path,
    (plan, identity): (&str, &Identity),
    (parts, has_bands): (Parts, bool),
) -> Result<usize, StorageError> {
    let mut records = Vec::new();
    for part in parts {
        let Some(rows) = read(storage, root, &rows_of(part.id))? else { continue };
        let mut files = vec![FileRecord::of(&rows_of(part.id), &rows)];
        if has_bands {
            let Some(bands) = read(storage, root, &bands_of(part.id))? else { continue };
            files.push(FileRecord::of(&bands_of(part.id), &bands));
        }
        let is_its = |found: &(Identity, _, usize)| found.0 == *identity && found.1 == part.id && found.2 == part.count;
        if in_rows(rows.into()).is_some_and(|found| is_its(&found)) {
            records.push(PartRecord { part: part.id.0, first_sample: part.first.0, rows: part.count as u64, files });
        }
    }
    if !records.is_empty() {
        let text = Manifest::text(identity, plan, records.iter(), None);
        place(storage, &root.join(MANIFEST), text.as_bytes())?;
        storage.sync_folder(root).map_err(at(root))?;
    }
    Ok(records.len())
}

/// The content of a file of the dataset in `root`; `None` where there is none.
fn read(storage: &dyn Storage, root: &Path, name: &str) -> Result<Option<Vec<u8>>, StorageError> {
    let path = root.join(name);
    match storage.read(&path, u64::MAX) {
        Ok(bytes) => Ok(Some(bytes)),
        Err(error) if is_unfit(&error) || is_absent(storage, root, &path, &error)? => Ok(None),
        Err(error) => Err(at(&path)(error)),
    }
}
