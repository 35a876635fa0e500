//! [`place`]: files of a dataset, which have their names only when they are whole.

use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

use crate::storage::disk::{Storage, StorageError, at};
use crate::storage::names::unfinished;

/// Writes a file of a dataset under a temporary name, checks it, and renames it.
///
/// # Errors
/// Where a file operation fails; the temporary file is removed.
pub fn place(storage: &dyn Storage, path: &Path, bytes: &[u8]) -> Result<(), StorageError> {
    let temporary = written(storage, path, bytes)?;
    let placed = storage.rename(&temporary, path).map_err(at(path));
    if placed.is_err() {
        // the first error is reported; a file that cannot be removed is recognised by its name
        let _ = storage.remove(&temporary);
    }
    placed
}

/// The same, unless there is a file of this name: that one stays.
///
/// # Errors
/// As [`place`].
pub(super) fn place_new(storage: &dyn Storage, path: &Path, bytes: &[u8]) -> Result<(), StorageError> {
    let temporary = written(storage, path, bytes)?;
    let placed = match storage.link(&temporary, path) {
        Err(error) if error.kind() == ErrorKind::AlreadyExists => Ok(()),
        // a file system where a file has one name; without locks, another process that has begun meanwhile clears
        // unfinished files away
        Err(error)
            if [ErrorKind::PermissionDenied, ErrorKind::Unsupported, ErrorKind::NotFound].contains(&error.kind()) =>
        {
            if storage.open(path).is_ok() {
                Ok(())
            } else {
                storage.rename(&temporary, path)
            }
        }
        linked => linked,
    };
    let removed = storage.remove(&temporary).map_err(at(&temporary));
    placed.map_err(at(path)).and(removed)
}

/// Writes a file under a temporary name for `path`, which is returned, and checks it.
fn written(storage: &dyn Storage, path: &Path, bytes: &[u8]) -> Result<PathBuf, StorageError> {
    let temporary = unfinished(path);
    let write = || {
        storage.create(&temporary, bytes).map_err(at(&temporary))?;
        if !storage.has(&temporary, bytes).map_err(at(&temporary))? {
            let differs = io::Error::other("what was read back is not what was written");
            return Err(at(&temporary)(differs));
        }
        Ok(())
    };
    let remove = || storage.remove(&temporary).map_err(at(&temporary));
    let Err(first) = write() else { return Ok(temporary) };
    // after a failed flush the state of the file is unknown: it is written again, once
    remove().and_then(|()| write()).map(|()| temporary.clone()).map_err(|_| {
        // the first error is reported; a file that cannot be removed is recognised by its name
        let _ = remove();
        first
    })
}
