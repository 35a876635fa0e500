//! [`replace`]: a finished dataset takes the place of an older one, which stays whole until then; and what is removed
//! on the way.
//!
//! The new dataset is made in the folder `.<name>.<digits>.new` beside the old one. The digits are drawn, and the file
//! `_REPLACEMENT` in it, which is the first one there, repeats them: a folder without that proof, or with that of
//! another name, was not made for this, and is neither used nor changed. When it is complete, the old dataset is
//! renamed to `.<name>.<digits>.old`, the new one takes its place, and the old one, to which the proof in the new one
//! leads, is removed; the proof is removed last. An interruption at any point is completed from the proof.
//!
//! Only files that a dataset lists, or that have names of its own, are ever removed.

use std::collections::BTreeSet;
use std::ffi::OsString;
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

use crate::storage::disk::{Storage, StorageError, above, at, entries_in, is_absent, no_link};
use crate::storage::found::{FolderContents, Found, contents};
use crate::storage::manifest::{Identity, PartRecord};
use crate::storage::names::{
    FOLDERS, MANIFEST, REPLACEMENT, SUCCESS, UNFINISHED, is_of_parts, is_ours, is_unique, unique,
};
use crate::storage::stored_file::is_unfit;
use crate::storage::whole_file::place;

/// Most bytes of a proof that is read.
const MOST_PROOF: u64 = 64;

/// The folder beside `root` that these digits name, for the new dataset or the old one.
fn beside(root: &Path, digits: &str, what: &str) -> PathBuf {
    let mut name = OsString::from(".");
    name.push(root.file_name().unwrap_or_default());
    name.push(format!(".{digits}.{what}"));
    root.with_file_name(name)
}

/// The digits that the proof in `folder` repeats; `None` where there is no proof.
fn proof(storage: &dyn Storage, folder: &Path) -> Result<Option<String>, StorageError> {
    let path = folder.join(REPLACEMENT);
    match storage.read(&path, MOST_PROOF) {
        Ok(bytes) => {
            Ok(String::from_utf8(bytes).ok().map(|text| text.trim_end().to_owned()).filter(|text| is_unique(text)))
        }
        Err(error) if is_unfit(&error) || is_absent(storage, folder, &path, &error)? => Ok(None),
        Err(error) => Err(at(&path)(error)),
    }
}

/// The digits of the folders beside `root` in which a dataset was made that is to replace it.
fn begun(storage: &dyn Storage, root: &Path) -> Result<Vec<String>, StorageError> {
    let name = root.file_name().unwrap_or_default().to_string_lossy();
    let (start, parent) = (format!(".{name}."), above(root));
    let mut found = Vec::new();
    for entry in storage.list(parent).map_err(at(parent))? {
        let digits = entry.name.strip_prefix(&start).and_then(|rest| rest.strip_suffix(".new"));
        if let Some(digits) = digits.filter(|digits| entry.is_folder && is_unique(digits))
            && proof(storage, &beside(root, digits, "new"))?.as_deref() == Some(digits)
        {
            found.push(digits.to_owned());
        }
    }
    Ok(found)
}

/// The folder, with a proof, in which a dataset with this identity and at most so many samples is made that is to
/// replace `root`: one that an interrupted process left, or a new one. What others left is removed.
///
/// # Errors
/// Where a file operation fails.
pub(super) fn begin(
    storage: &dyn Storage,
    root: &Path,
    identity: &Identity,
    most: u64,
) -> Result<PathBuf, StorageError> {
    let mut kept = None;
    for digits in begun(storage, root)? {
        let new = beside(root, &digits, "new");
        match contents(storage, &new)? {
            FolderContents::Foreign(_) => {}
            FolderContents::Dataset(found)
                if kept.is_none() && found.identity.as_ref() == Some(identity) && found.extent() <= most =>
            {
                kept = Some(new);
            }
            FolderContents::Dataset(found) => remove(storage, &new, &found)?,
            FolderContents::Blank => remove(storage, &new, &Found::default())?,
        }
    }
    if let Some(kept) = kept {
        return Ok(kept);
    }
    let digits = unique();
    let new = beside(root, &digits, "new");
    let above = above(&new);
    // its name is made durable after the proof in it
    let made = (storage.create_folder(&new).map_err(at(&new)))
        .and_then(|()| place(storage, &new.join(REPLACEMENT), format!("{digits}\n").as_bytes()))
        .and_then(|()| storage.sync_folder(&new).map_err(at(&new)))
        .and_then(|()| storage.sync_folder(above).map_err(at(above)));
    made.inspect_err(|_| {
        // the first error is reported; an empty folder may be left
        let _ = remove(storage, &new, &Found::default());
    })?;
    Ok(new)
}

/// Whether `root` can be replaced by `new`, before any work: its folder must be one that can be renamed, which a mount
/// point cannot, and not one in which somebody works.
///
/// # Errors
/// What keeps it from being renamed; `new` is then removed, if nothing is in it.
pub(super) fn check_replaceable(storage: &dyn Storage, new: &Path, root: &Path) -> io::Result<()> {
    let check = || {
        if let (Ok(here), Ok(there)) = (std::env::current_dir(), root.canonicalize())
            && here.starts_with(there)
        {
            return Err(io::Error::new(ErrorKind::ResourceBusy, "it is the current folder, or one above it"));
        }
        if !cfg!(unix) {
            return Ok(());
        }
        // `new` is not empty, so this cannot succeed; where nothing else is in the way, that is the error
        match storage.rename(root, new) {
            Err(error) if [ErrorKind::DirectoryNotEmpty, ErrorKind::AlreadyExists].contains(&error.kind()) => Ok(()),
            Err(error) => Err(error),
            Ok(()) => Err(io::Error::other("a folder that is not empty was replaced")),
        }
    };
    check().inspect_err(|_| {
        if let Ok(FolderContents::Blank) = contents(storage, new) {
            // the first error is reported; what is left has a proof, and the next replacement removes it
            let _ = remove(storage, new, &Found::default());
        }
    })
}

/// Removes the files of a dataset, and its folders where nothing else is in them: first the marks, so that a partly
/// removed dataset is never taken for a whole one; the proof last.
fn remove(storage: &dyn Storage, root: &Path, found: &Found) -> Result<(), StorageError> {
    let top = storage.list(root).map_err(at(root))?;
    if top.is_empty() {
        return storage.remove_folder(root).map_err(at(root));
    }
    no_link(root).map_err(at(root))?;
    let success = root.join(SUCCESS);
    storage.remove(&success).map_err(at(&success))?;
    let listed = found.listed();
    for folder in FOLDERS.into_iter().filter(|name| top.iter().any(|entry| entry.is_folder && entry.name == *name)) {
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
    let last = [MANIFEST, REPLACEMENT];
    let others = top.iter().filter(|entry| entry.is_file && is_ours("", &entry.name));
    for name in others.map(|entry| entry.name.as_str()).filter(|name| !last.contains(name)).chain(last) {
        let file = root.join(name);
        storage.remove(&file).map_err(at(&file))?;
    }
    if storage.list(root).map_err(at(root))?.is_empty() {
        storage.remove_folder(root).map_err(at(root))?;
    }
    Ok(())
}

/// Puts the finished dataset `new` in the place of `root`, and removes what was there.
///
/// # Errors
/// Where a file operation fails, or something was put into `root` that is not part of its dataset; the old result is
/// then still whole, in its place or beside it.
pub fn replace(storage: &dyn Storage, new: &Path, root: &Path) -> Result<(), StorageError> {
    let digits = proof(storage, new)?.ok_or_else(|| at(new)(io::Error::other("its file _REPLACEMENT is gone")))?;
    no_link(root).map_err(at(root))?;
    let not_ours = match contents(storage, root)? {
        FolderContents::Dataset(found) => found.not_its_own().cloned(),
        FolderContents::Foreign(entry) => Some(entry),
        FolderContents::Blank => None,
    };
    if let Some(entry) = not_ours {
        let why =
            format!("contains `{entry}`, which is not part of the result; move it away, and run the command again");
        return Err(at(root)(io::Error::other(why)));
    }
    storage.rename(root, &beside(root, &digits, "old")).map_err(at(root))?;
    storage.rename(new, root).map_err(at(new))?;
    // both at once: a loss of power leaves the old result or the new one in its place
    storage.sync_folder(above(root)).map_err(at(above(root)))?;
    remove_replaced(storage, root)
}

/// Removes the dataset that `root` has replaced, if it is still there, and then the proof.
///
/// # Errors
/// Where a file operation fails.
pub(super) fn remove_replaced(storage: &dyn Storage, root: &Path) -> Result<(), StorageError> {
    let Some(digits) = proof(storage, root)? else { return Ok(()) };
    let old = beside(root, &digits, "old");
    match contents(storage, &old)? {
        FolderContents::Dataset(found) => remove(storage, &old, &found)?,
        FolderContents::Blank => remove(storage, &old, &Found::default())?,
        FolderContents::Foreign(_) => {}
    }
    storage.sync_folder(above(root)).map_err(at(above(root)))?;
    let path = root.join(REPLACEMENT);
    storage.remove(&path).map_err(at(&path))?;
    storage.sync_folder(root).map_err(at(root))
}

/// The new dataset of a replacement of `root` that was interrupted between its two renames; `None` where there was
/// none.
///
/// # Errors
/// Where a file operation fails.
pub(super) fn interrupted(storage: &dyn Storage, root: &Path) -> Result<Option<PathBuf>, StorageError> {
    let begun = match storage.entries(root) {
        Ok(entries) if entries.is_empty() => match begun(storage, root) {
            // a folder that was given may be in one that this user cannot list
            Err(error) if error.source.kind() == ErrorKind::PermissionDenied => Vec::new(),
            begun => begun?,
        },
        Err(error) if error.kind() == ErrorKind::NotFound => begun(storage, root)?,
        entries => entries.map(|_| Vec::new()).map_err(at(root))?,
    };
    for digits in begun {
        let old = beside(root, &digits, "old");
        if !storage.list(&old).map_err(at(&old))?.is_empty() {
            return Ok(Some(beside(root, &digits, "new")));
        }
    }
    Ok(None)
}

/// Ends the replacement that [`interrupted`] found: a dataset takes the place of `root` again.
///
/// # Errors
/// Where a file operation fails.
pub(super) fn complete(storage: &dyn Storage, new: &Path, root: &Path) -> Result<(), StorageError> {
    let Some(digits) = proof(storage, new)? else { return Ok(()) };
    let is_new_whole = matches!(contents(storage, new)?, FolderContents::Dataset(found) if found.is_finished);
    let old = beside(root, &digits, "old");
    let from = if is_new_whole { new } else { &old };
    storage.rename(from, root).map_err(at(from))?;
    storage.sync_folder(above(root)).map_err(at(above(root)))
}

/// Removes what an interrupted process left in an unfinished dataset: temporary files, and files of parts that it did
/// not come to list. The campaign may have fewer samples now, and then no part would replace these.
pub(super) fn remove_unfinished(storage: &dyn Storage, root: &Path, parts: &[PartRecord]) -> Result<(), StorageError> {
    let listed: BTreeSet<&str> = parts.iter().flat_map(|part| &part.files).map(|file| file.name.as_str()).collect();
    for folder in FOLDERS.into_iter().chain([""]) {
        let path = root.join(folder);
        for entry in entries_in(storage, root, &path)? {
            let is_unlisted = is_of_parts(folder) && !listed.contains(format!("{folder}/{}", entry.name).as_str());
            let is_left = entry.name.ends_with(UNFINISHED) || is_unlisted;
            if entry.is_file && is_left && is_ours(folder, &entry.name) {
                no_link(&path).map_err(at(&path))?;
                let file = path.join(&entry.name);
                storage.remove(&file).map_err(at(&file))?;
            }
        }
    }
    Ok(())
}
