//! [`Storage`]: the file operations that a dataset is made of, so that tests can let any of them fail.
//!
//! The idea of SQLite's test layer: everything that a dataset does to the disk, and every read of its files
//! ([`super::stored_file`]), uses this interface, and a test repeats the same work with a fault at the first, second,
//! third ... operation. [`Disk`] is the real one.
//!
//! On purpose not here, since they are no files of a dataset:
//! - what a command is told to write elsewhere (`--junit`, `--figures`, `--out` of `simulate`, `sample`, `precision`):
//!   [`super::atomic`], and `create_dir_all` of the folders of figures;
//! - what a campaign file names, and the file itself: [`crate::campaign::input_file`]. The copies of files of numbers
//!   in `data/` are read as the originals are: by the plan's checksum, so that what cannot be read is an error of the
//!   plan;
//! - questions that no row and no decision about a file depends on: whether two paths are the same file, free space and
//!   memory, `/proc`.

use std::fmt::Debug;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use crate::storage::stored_file::{StoredFile, Unfit, content, has};

/// Operations on files. Each may fail; none leaves a file under a final name that is not whole.
pub trait Storage: Debug + Send + Sync {
    /// Creates the file `path`, which must not exist (a link of that name is not followed), writes `bytes` and flushes
    /// them to the disk.
    ///
    /// # Errors
    /// The first operation that fails; a part of the file may be left.
    fn create(&self, path: &Path, bytes: &[u8]) -> io::Result<()>;

    /// Appends `bytes` to the file `path` at `length`, its length until now, and flushes them to the disk. What is
    /// there after `length` is cut off first: a line that an earlier failure left unfinished.
    ///
    /// # Errors
    /// The first operation that fails.
    fn append(&self, path: &Path, length: u64, bytes: &[u8]) -> io::Result<()>;

    /// Opens a regular file for reading: no link, no folder, no pipe.
    ///
    /// # Errors
    /// Where it cannot be opened, or is [`Unfit`].
    fn open(&self, path: &Path) -> io::Result<Box<dyn StoredFile>>;

    /// The whole content of a regular file of at most `most` bytes.
    ///
    /// # Errors
    /// Where it cannot be read, or is [`Unfit`].
    fn read(&self, path: &Path, most: u64) -> io::Result<Vec<u8>> {
        content(&*self.open(path)?, most)
    }

    /// Whether the content of the regular file `path` is `bytes`.
    ///
    /// # Errors
    /// Where it cannot be read, or is not a regular file.
    fn has(&self, path: &Path, bytes: &[u8]) -> io::Result<bool> {
        has(&*self.open(path)?, bytes)
    }

    /// Locks a file or folder against other processes, shared or not, until the result is dropped; `None` where the
    /// file system has no locks.
    ///
    /// # Errors
    /// Where another process has it locked, or it cannot be opened or locked.
    fn lock(&self, path: &Path, is_shared: bool) -> Result<Option<File>, TryLockError>;

    /// Renames a file or folder, replacing a file of the new name.
    ///
    /// # Errors
    /// Where it fails.
    fn rename(&self, from: &Path, to: &Path) -> io::Result<()>;

    /// Gives the file `from` the name `to` too, which must not exist: of several processes that do so at the same time
    /// one succeeds.
    ///
    /// # Errors
    /// Where it fails; `AlreadyExists` where there is something of that name.
    fn link(&self, from: &Path, to: &Path) -> io::Result<()>;

    /// Removes a file (a link, not what it points to); no error where there is none.
    ///
    /// # Errors
    /// Where it fails.
    fn remove(&self, path: &Path) -> io::Result<()>;

    /// Removes an empty folder; no error where there is none.
    ///
    /// # Errors
    /// Where it fails.
    fn remove_folder(&self, path: &Path) -> io::Result<()>;

    /// Creates a folder with all folders above it; no error where it exists.
    ///
    /// # Errors
    /// Where it fails, or something else of that name exists, a link to a folder too.
    fn create_folder(&self, path: &Path) -> io::Result<()>;

    /// Makes renames and new files in a folder durable.
    ///
    /// # Errors
    /// Where it fails.
    fn sync_folder(&self, path: &Path) -> io::Result<()>;

    /// The entries of a folder, ascending by name.
    ///
    /// # Errors
    /// Where it fails, or there is no such folder.
    fn entries(&self, path: &Path) -> io::Result<Vec<Entry>>;

    /// The same; none where there is no such folder.
    ///
    /// # Errors
    /// Where it fails.
    fn list(&self, path: &Path) -> io::Result<Vec<Entry>> {
        match self.entries(path) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(Vec::new()),
            entries => entries,
        }
    }
}

/// An entry of a folder.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Entry {
    pub name: String,
    /// Whether it is a folder; a link to a folder is none.
    pub is_folder: bool,
    /// Whether it is a regular file; a link to a file is none.
    pub is_file: bool,
    /// Its size, bytes.
    pub size: u64,
}

#[derive(Clone, Copy, Debug, Default)]
pub struct Disk;

impl Storage for Disk {
    fn create(&self, path: &Path, bytes: &[u8]) -> io::Result<()> {
        let mut file = OpenOptions::new().write(true).create_new(true).open(path)?;
        file.write_all(bytes)?;
        file.sync_all()
    }

    fn append(&self, path: &Path, length: u64, bytes: &[u8]) -> io::Result<()> {
        if !fs::symlink_metadata(path)?.is_file() {
            return Err(Unfit::Kind.into());
        }
        let mut file = OpenOptions::new().append(true).open(path)?;
        if file.metadata()?.len() != length {
            file.set_len(length)?;
        }
        file.write_all(bytes)?;
        file.sync_data()
    }

    fn open(&self, path: &Path) -> io::Result<Box<dyn StoredFile>> {
        if !fs::symlink_metadata(path)?.is_file() {
            return Err(Unfit::Kind.into());
        }
        Ok(Box::new(File::open(path)?))
    }

    fn lock(&self, path: &Path, is_shared: bool) -> Result<Option<File>, TryLockError> {
        // network file systems lock a file against all others only where it is open for writing
        let is_written = !is_shared && fs::symlink_metadata(path).is_ok_and(|found| found.is_file());
        let file = match OpenOptions::new().read(true).write(is_written).open(path) {
            // only Unix can open a folder
            Err(_) if !cfg!(unix) => return Ok(None),
            file => file.map_err(TryLockError::Error)?,
        };
        match if is_shared { file.try_lock_shared() } else { file.try_lock() } {
            // while its lock was waited for, another may have taken its name
            Ok(()) if is_at(&file, path) => Ok(Some(file)),
            Ok(()) | Err(TryLockError::WouldBlock) => Err(TryLockError::WouldBlock),
            Err(TryLockError::Error(error)) if has_no_locks(&error) => Ok(None),
            Err(error) => Err(error),
        }
    }

    fn rename(&self, from: &Path, to: &Path) -> io::Result<()> {
        fs::rename(from, to)
    }

    fn link(&self, from: &Path, to: &Path) -> io::Result<()> {
        fs::hard_link(from, to)
    }

    fn remove(&self, path: &Path) -> io::Result<()> {
        unless_absent(fs::remove_file(path))
    }

    fn remove_folder(&self, path: &Path) -> io::Result<()> {
        unless_absent(fs::remove_dir(path))
    }

    fn create_folder(&self, path: &Path) -> io::Result<()> {
        fs::create_dir_all(path)?;
        no_link(path)
    }

    fn sync_folder(&self, path: &Path) -> io::Result<()> {
        // only Unix can open and flush a folder
        if cfg!(unix) { File::open(path)?.sync_all() } else { Ok(()) }
    }

    fn entries(&self, path: &Path) -> io::Result<Vec<Entry>> {
        let mut list = Vec::new();
        for entry in fs::read_dir(path)? {
            let entry = entry?;
            // of a link: the link's own
            let metadata = match entry.metadata() {
                // removed or renamed since
                Err(error) if error.kind() == io::ErrorKind::NotFound => continue,
                metadata => metadata?,
            };
            let name = entry.file_name().to_string_lossy().into_owned();
            list.push(Entry { name, is_folder: metadata.is_dir(), is_file: metadata.is_file(), size: metadata.len() });
        }
        list.sort();
        Ok(list)
    }
}

/// Whether `error` says that a file system has no locks: any other one says nothing about them.
fn has_no_locks(error: &io::Error) -> bool {
    #[cfg(unix)]
    {
        use rustix::io::Errno;
        let numbers = [Errno::OPNOTSUPP, Errno::NOTSUP, Errno::NOLCK, Errno::NOSYS].map(Errno::raw_os_error);
        error.raw_os_error().is_some_and(|number| numbers.contains(&number))
    }
    #[cfg(not(unix))]
    {
        error.kind() == io::ErrorKind::Unsupported
    }
}

/// Whether `path` still leads to the open `file`.
fn is_at(file: &File, path: &Path) -> bool {
    #[cfg(unix)]
    {
        use std::os::unix::fs::MetadataExt;
        let (Ok(open), Ok(named)) = (file.metadata(), fs::metadata(path)) else { return false };
        (open.dev(), open.ino()) == (named.dev(), named.ino())
    }
    #[cfg(not(unix))]
    {
        let _ = (file, path);
        true
    }
}

/// Refuses a folder of a dataset that is none: through a link that somebody put in its place, files elsewhere would
/// change.
///
/// # Errors
/// Where it is a link or something else; none where it is not there.
pub fn no_link(folder: &Path) -> io::Result<()> {
    match fs::symlink_metadata(folder) {
        Ok(found) if !found.is_dir() => {
            let why = "a link, or no folder, where a folder of the result should be";
            Err(io::Error::new(io::ErrorKind::NotADirectory, why))
        }
        Err(error) if error.kind() != io::ErrorKind::NotFound => Err(error),
        _ => Ok(()),
    }
}

/// The folder above `path`.
pub fn above(path: &Path) -> &Path {
    path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Creates a folder with all folders above it, durably; no error where it exists.
///
/// # Errors
/// Where it fails, or something else of that name exists, a link to a folder too.
pub fn new_folder(storage: &dyn Storage, path: &Path) -> Result<(), StorageError> {
    let is_missing = |folder: &&Path| !folder.as_os_str().is_empty() && !folder.exists();
    let missing: Vec<&Path> = path.ancestors().take_while(is_missing).map(above).collect();
    storage.create_folder(path).map_err(at(path))?;
    missing.into_iter().try_for_each(|folder| storage.sync_folder(folder).map_err(at(folder)))
}

/// The folder that `path` means: what it leads to where it is a link, whether that is there or not, so that a link
/// which changes later changes nothing; and one with a name where it is `.` or `..`.
///
/// # Errors
/// Where a link cannot be read, or leads to itself.
pub fn meant(path: &Path) -> io::Result<PathBuf> {
    // without a slash at the end, and without `.` within
    let mut folder: PathBuf = path.components().collect();
    // as many links as Linux follows
    for _ in 0..40 {
        if folder.file_name().is_none() {
            return folder.canonicalize();
        }
        match fs::symlink_metadata(&folder) {
            Ok(found) if found.is_symlink() => folder = above(&folder).join(fs::read_link(&folder)?),
            _ => return Ok(folder),
        }
    }
    Err(io::Error::other("a link that leads to itself"))
}

fn unless_absent(result: io::Result<()>) -> io::Result<()> {
    match result {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(()),
        other => other,
    }
}

/// A file operation that failed, with the path.
#[derive(Debug, thiserror::Error)]
#[error("{}: {source}", path.display())]
pub struct StorageError {
    pub path: PathBuf,
    pub source: io::Error,
}

/// Adds the path to an error.
pub fn at(path: &Path) -> impl FnOnce(io::Error) -> StorageError + use<> {
    let path = path.to_owned();
    move |source| StorageError { path, source }
}

/// Whether `error` says that the file or folder `path` of the dataset `root` is not there, and its folder says so too.
///
/// # Errors
/// Where the folder cannot be read.
pub fn is_absent(storage: &dyn Storage, root: &Path, path: &Path, error: &io::Error) -> Result<bool, StorageError> {
    if error.kind() != io::ErrorKind::NotFound {
        return Ok(false);
    }
    let (Some(folder), Some(name)) = (path.parent(), path.file_name()) else { return Ok(false) };
    match storage.entries(folder) {
        Ok(entries) => Ok(entries.iter().all(|entry| *entry.name != *name)),
        // the folder is gone with its files, or the whole dataset
        Err(error) if folder != root && error.kind() == io::ErrorKind::NotFound => {
            is_absent(storage, root, folder, &error)
        }
        Err(error) => Err(at(folder)(error)),
    }
}

/// The entries of the folder `path` of the dataset `root`; none where there is no such folder.
///
/// # Errors
/// Where it cannot be read.
pub fn entries_in(storage: &dyn Storage, root: &Path, path: &Path) -> Result<Vec<Entry>, StorageError> {
    match storage.entries(path) {
        Ok(entries) => Ok(entries),
        Err(error) if is_absent(storage, root, path, &error)? => Ok(Vec::new()),
        Err(error) => Err(at(path)(error)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::storage::stored_file::is_unfit;

    /// Law: a folder is removed where nothing is in it, and only there; what is absent need not be removed.
    #[test]
    fn only_an_empty_folder_is_removed() {
        let folder = std::env::temp_dir().join(format!("spindrift-storage-{}-empty", std::process::id()));
        let file = folder.join("x");
        fs::create_dir_all(&folder).unwrap();
        fs::write(&file, b"x").unwrap();
        assert!(Disk.remove_folder(&folder).is_err() && file.exists());
        Disk.remove(&file).unwrap();
        Disk.remove_folder(&folder).unwrap();
        assert!(!folder.exists());
        assert!(Disk.remove(&file).is_ok() && Disk.remove_folder(&folder).is_ok());
    }

    /// Law: what was created is read; what is no regular file is unfit, and what is not there is neither read nor
    /// unfit.
    #[test]
    fn only_regular_files_are_read() {
        let folder = std::env::temp_dir().join(format!("spindrift-storage-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let path = folder.join("file");
        Disk.create(&path, b"12345").unwrap();
        assert_eq!(Disk.read(&path, 5).unwrap(), b"12345");
        assert!(Disk.has(&path, b"12345").unwrap() && !Disk.has(&path, b"12346").unwrap());
        assert!(is_unfit(&Disk.read(&path, 4).unwrap_err()) && is_unfit(&Disk.read(&folder, 9).unwrap_err()));
        let absent = Disk.read(&folder.join("none"), 9).unwrap_err();
        assert!(absent.kind() == io::ErrorKind::NotFound && !is_unfit(&absent), "{absent}");
        fs::remove_dir_all(&folder).unwrap();
    }
}
