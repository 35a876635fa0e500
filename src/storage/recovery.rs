//! [`begin_again`]: the manifest of a dataset that has lost it.
//!
//! What the files of rows say of themselves is whose they are; that they have what was written then, nothing says. So
//! the new manifest has the identity and the plan and lists no part: the parts are computed again.

use std::path::Path;

use crate::storage::disk::{Storage, StorageError, at, entries_in};
use crate::storage::folder::begin;
use crate::storage::identity::in_rows;
use crate::storage::manifest::Identity;
use crate::storage::names::{MANIFEST, PLAN, RUNS, is_ours};
use crate::storage::stored_file::is_unfit;

/// Whether there is a plan with files of rows in `root`, and no manifest.
///
/// # Errors
/// Where a folder cannot be read.
pub fn is_lost(storage: &dyn Storage, root: &Path) -> Result<bool, StorageError> {
    let top = storage.list(root).map_err(at(root))?;
    let has = |name: &str| top.iter().any(|entry| entry.name == name);
    Ok(has(PLAN) && has(RUNS) && !has(MANIFEST))
}

/// Writes the manifest of the dataset in `root`, where a file of rows of its plan is there; whether it was written.
/// `plan` is the text of the plan.
///
/// # Errors
/// Where a file operation fails.
pub fn begin_again(
    storage: &dyn Storage,
    root: &Path,
    (plan, identity): (&str, &Identity),
) -> Result<bool, StorageError> {
    let folder = root.join(RUNS);
    for entry in entries_in(storage, root, &folder)?.into_iter().filter(|entry| is_ours(RUNS, &entry.name)) {
        let path = folder.join(entry.name);
        let bytes = match storage.read(&path, u64::MAX) {
            Ok(bytes) => bytes,
            Err(error) if is_unfit(&error) => continue,
            Err(error) => return Err(at(&path)(error)),
        };
        if in_rows(bytes.into()).is_some_and(|(there, ..)| there == *identity) {
            begin(storage, root, (plan, identity), MANIFEST)?;
            return Ok(true);
        }
    }
    Ok(false)
}
