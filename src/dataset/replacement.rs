//! [`replace`]: a finished dataset takes the place of an older one, which stays whole until then; and what is removed on the way.
//!
//! Only files that a dataset lists, or that have names of its own, are ever removed.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use crate::dataset::found::{Contents, Found, contents};
use crate::dataset::manifest::{Identity, PartRecord};
use crate::dataset::names::{FOLDERS, MANIFEST, SUCCESS, UNFINISHED, is_of_parts, is_ours};
use crate::dataset::storage::{Storage, StorageError, at, entries_in};

/// Where a dataset is made that is to replace `root`.
pub(super) fn replacement(root: &Path) -> PathBuf {
    beside(root, "new")
}

fn beside(root: &Path, what: &str) -> PathBuf {
    let name = root.file_name().map_or_else(|| "result".to_owned(), |name| name.to_string_lossy().into_owned());
    root.with_file_name(format!(".{name}.{what}"))
}

/// Removes the dataset in `root`, if there is one of other rows than `identity`, or of more than `most` samples.
pub(super) fn remove_dataset(
    storage: &dyn Storage,
    root: &Path,
    identity: &Identity,
    most: u64,
) -> Result<(), StorageError> {
    if let Contents::Dataset(found) = contents(storage, root)?
        && (found.identity.as_ref() != Some(identity) || found.extent() > most)
    {
        remove(storage, root, &found)?;
    }
    Ok(())
}

/// Removes the files of a dataset, and its folders where nothing else is in them: first the marks, so that a partly removed dataset is never
/// taken for a whole one.
fn remove(storage: &dyn Storage, root: &Path, found: &Found) -> Result<(), StorageError> {
    let success = root.join(SUCCESS);
    storage.remove(&success).map_err(at(&success))?;
    let listed = found.listed();
    for folder in FOLDERS {
        let path = root.join(folder);
        for entry in entries_in(storage, root, &path)? {
            let name = format!("{folder}/{}", entry.name);
            let is_listed = listed.contains(&name);
            let is_leftover = !found.is_finished || name.ends_with(UNFINISHED);
            if entry.is_file && is_ours(folder, &entry.name) && (!is_of_parts(folder) || is_listed || is_leftover) {
                let file = path.join(&entry.name);
                storage.remove(&file).map_err(at(&file))?;
            }
        }
        if storage.list(&path).map_err(at(&path))?.is_empty() {
            storage.remove_folder(&path).map_err(at(&path))?;
        }
    }
    for entry in storage.list(root).map_err(at(root))? {
        if entry.is_file && is_ours("", &entry.name) && !entry.name.starts_with(MANIFEST) {
            let file = root.join(&entry.name);
            storage.remove(&file).map_err(at(&file))?;
        }
    }
    let manifest = root.join(MANIFEST);
    storage.remove(&manifest).map_err(at(&manifest))?;
    if storage.list(root).map_err(at(root))?.is_empty() {
        storage.remove_folder(root).map_err(at(root))?;
    }
    Ok(())
}

/// Puts the finished dataset `new` in the place of `root`, and removes what was there.
///
/// # Errors
/// Where a file operation fails; the old result is then still whole, in its place or beside it.
pub fn replace(storage: &dyn Storage, new: &Path, root: &Path) -> Result<(), StorageError> {
    let old = beside(root, "old");
    storage.rename(root, &old).map_err(at(root))?;
    storage.rename(new, root).map_err(at(new))?;
    let parent = root.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
    storage.sync_folder(parent).map_err(at(parent))?;
    remove_old(storage, &old)
}

fn remove_old(storage: &dyn Storage, old: &Path) -> Result<(), StorageError> {
    if let Contents::Dataset(found) = contents(storage, old)? {
        remove(storage, old, &found)?;
    }
    Ok(())
}

/// Ends a replacement that was interrupted between its two renames, or before the old result was removed.
pub(super) fn complete_replacement(storage: &dyn Storage, root: &Path) -> Result<(), StorageError> {
    let (old, new) = (beside(root, "old"), replacement(root));
    if storage.list(&old).map_err(at(&old))?.is_empty() {
        return Ok(());
    }
    if storage.list(root).map_err(at(root))?.is_empty() {
        let is_new_whole = matches!(contents(storage, &new)?, Contents::Dataset(found) if found.is_finished);
        let from = if is_new_whole { &new } else { &old };
        storage.rename(from, root).map_err(at(from))?;
    }
    remove_old(storage, &old)
}

/// Removes what an interrupted process left in an unfinished dataset: temporary files, and files of parts that it did not come to list. The
/// campaign may have fewer samples now, and then no part would replace these.
pub(super) fn remove_unfinished(storage: &dyn Storage, root: &Path, parts: &[PartRecord]) -> Result<(), StorageError> {
    let listed: BTreeSet<&str> = parts.iter().flat_map(|part| &part.files).map(|file| file.name.as_str()).collect();
    for folder in FOLDERS.into_iter().chain([""]) {
        let path = root.join(folder);
        for entry in entries_in(storage, root, &path)? {
            let is_unlisted = is_of_parts(folder) && !listed.contains(format!("{folder}/{}", entry.name).as_str());
            let is_left = entry.name.ends_with(UNFINISHED) || is_unlisted;
            if entry.is_file && is_left && is_ours(folder, &entry.name) {
                let file = path.join(&entry.name);
                storage.remove(&file).map_err(at(&file))?;
            }
        }
    }
    Ok(())
}
