//! [`replace`]: a finished dataset replaces an older one, which stays whole until then.
//!
//! The new dataset is made in the folder `.<name>.<digits>.new` beside the old one, with the digits of its
//! `dataset.json`. When it is complete, the old dataset is renamed to `.<name>.<digits>.old`, the new one takes its
//! place, and the old one is removed. These names allow an interruption at any point to be completed.
//!
//! Only files that a dataset lists or names are ever removed.

use super::store::{Result, Store};
use crate::storage::dataset::{Head, unfinish};
use crate::storage::disk::{above, sync_folder};
use crate::storage::folder_error::FolderError;
use crate::storage::found::{Found, contents};
use crate::storage::identity::sha256;
use crate::storage::lock::lock;
use crate::storage::names::{FOLDERS, HEAD, is_digits};
use crate::storage::store::{OpenFolder, at};
use std::ffi::OsString;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::{fs, io};

fn beside(root: &Path, digits: &str, what: &str) -> PathBuf {
    let mut name = OsString::from(".");
    name.push(root.file_name().unwrap_or_default());
    name.push(format!(".{digits}.{what}"));
    root.with_file_name(name)
}

fn digits(head: &[u8]) -> String {
    sha256(head)[..16].to_owned()
}

/// The digits of the dataset in `store`, if its head is readable.
fn digits_of(store: &dyn Store) -> Result<Option<String>> {
    Ok(store.read(HEAD)?.ok().map(|head| digits(&head)))
}

type Begun = (String, Arc<dyn Store>);

/// The replacements begun beside `root`, with their digits.
fn begun(folders: &OpenFolder<'_>, root: &Path) -> Result<Vec<Begun>> {
    let start = format!(".{}.", root.file_name().unwrap_or_default().to_string_lossy());
    let parent = folders(above(root));
    let mut found = Vec::new();
    for entry in parent.list("").map_err(parent.at(""))? {
        let named = entry.name.strip_prefix(&start).and_then(|rest| rest.strip_suffix(".new"));
        let Some(named) = named.filter(|named| entry.is_folder && is_digits(named)) else { continue };
        let new = folders(&beside(root, named, "new"));
        if digits_of(&*new)?.as_deref() == Some(named) {
            found.push((named.to_owned(), new));
        }
    }
    Ok(found)
}

/// The folder beside `root` for a dataset with this head; removes leftovers of other replacements.
///
/// # Errors
/// A `root` that cannot be renamed, or a failed file operation.
pub(super) fn begin(folders: &OpenFolder<'_>, root: &Path, head: &Head) -> Result<Arc<dyn Store>, FolderError> {
    check_movable(root).map_err(|why| FolderError::Immovable { folder: root.display().to_string(), why })?;
    let own = digits(&head.bytes());
    for (other, store) in begun(folders, root)? {
        if other != own {
            remove(&*store)?;
        }
    }
    Ok(folders(&beside(root, &own, "new")))
}

/// True if `root` can be renamed: not a mount point, nor a folder in use.
fn check_movable(root: &Path) -> io::Result<()> {
    if let (Ok(here), Ok(there)) = (std::env::current_dir(), root.canonicalize())
        && here.starts_with(there)
    {
        return Err(io::Error::new(ErrorKind::ResourceBusy, "it is the current folder, or one above it"));
    }
    if !cfg!(unix) {
        return Ok(());
    }
    // renaming into itself always fails; any other obstacle is reported first
    match fs::rename(root, root.join("_")) {
        Err(error) if error.kind() == ErrorKind::InvalidInput => Ok(()),
        Err(error) => Err(error),
        Ok(()) => Err(io::Error::other("a folder was renamed into itself")),
    }
}

/// Removes the files of a dataset, and its folders if then empty: marks first, so that the rest never looks whole; the
/// head last.
pub(super) fn remove(store: &dyn Store) -> Result<(), FolderError> {
    let Some(found) = dataset(store)? else { return Ok(()) };
    unfinish(store)?;
    let unlisted: Vec<&str> = found.unlisted().collect();
    let others = found.files.iter().map(String::as_str).filter(|name| *name != HEAD && !unlisted.contains(name));
    for name in others.chain([HEAD]) {
        store.remove(name).map_err(store.at(name))?;
    }
    for folder in FOLDERS.into_iter().chain([""]) {
        match store.list(folder) {
            Ok(entries) if entries.is_empty() => store.remove(folder).map_err(store.at(folder))?,
            Err(error) if error.kind() != ErrorKind::NotFound => return Err(store.at(folder)(error).into()),
            _ => {}
        }
    }
    Ok(())
}

/// The dataset in `store`; `None` for anything else.
fn dataset(store: &dyn Store) -> Result<Option<Found>, FolderError> {
    match contents(store) {
        Err(FolderError::Old { .. } | FolderError::Foreign { .. }) => Ok(None),
        found => found.map(Some),
    }
}

fn rename(from: &dyn Store, to: &Path) -> Result<()> {
    from.rename(to).map_err(from.at(""))
}

fn sync_above(root: &Path) -> Result<()> {
    sync_folder(above(root)).map_err(at(above(root)))
}

/// Replaces `root` by the finished dataset `new`.
///
/// # Errors
/// A failed file operation, or foreign files in `root`; the old result is then whole, in its place or beside it.
pub fn replace(folders: &OpenFolder<'_>, new: &Arc<dyn Store>, root: &Path) -> Result<(), FolderError> {
    let old = folders(root);
    let not_ours = match contents(&*old) {
        Err(FolderError::Foreign { entry, .. }) => Some(entry),
        Err(FolderError::Old { .. }) => None,
        found => found?.not_its_own().map(str::to_owned),
    };
    if let Some(entry) = not_ours {
        let why =
            format!("contains `{entry}`, which is not part of the result; move it away, and run the command again");
        return Err(old.at("")(io::Error::other(why)).into());
    }
    let own = digits_of(&**new)?.ok_or_else(|| new.at(HEAD)(ErrorKind::NotFound.into()))?;
    rename(&*old, &beside(root, &own, "old"))?;
    rename(&**new, root)?;
    // durable together, so that a loss of power leaves one of both in place
    sync_above(root)?;
    remove(&*folders(&beside(root, &own, "old")))
}

/// Removes the dataset that `root` has replaced, if still there.
///
/// # Errors
/// A failed file operation.
pub(super) fn remove_replaced(folders: &OpenFolder<'_>, root: &Path, found: &Found) -> Result<(), FolderError> {
    let own = digits_of(&*folders(root))?.filter(|_| found.identity.is_some());
    let old = own.map(|own| beside(root, &own, "old")).filter(|old| old.exists());
    old.map_or(Ok(()), |old| remove(&*folders(&old)))
}

/// Completes a replacement of `root` interrupted between its two renames.
///
/// # Errors
/// A failed file operation.
pub(super) fn complete(folders: &OpenFolder<'_>, root: &Path) -> Result<(), FolderError> {
    if fs::read_dir(root).is_ok_and(|mut entries| entries.next().is_some()) || !above(root).is_dir() {
        return Ok(());
    }
    let begun = match begun(folders, root) {
        // the user may not list the folder above
        Err(error) if error.source.kind() == ErrorKind::PermissionDenied => return Ok(()),
        begun => begun?,
    };
    for (digits, new) in begun {
        let old = folders(&beside(root, &digits, "old"));
        if !old.root().exists() {
            continue;
        }
        let _lock = lock(&*new, false)?;
        let is_new_whole = dataset(&*new)?.is_some_and(|found| found.is_finished);
        rename(if is_new_whole { &*new } else { &*old }, root)?;
        return Ok(sync_above(root)?);
    }
    Ok(())
}
