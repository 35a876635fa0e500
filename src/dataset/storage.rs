//! [`Storage`]: the file operations that a dataset is made of, so that tests can let any of them fail.
//!
//! The idea of SQLite's test layer: everything that a dataset does to the disk uses this interface, and a test repeats the same
//! work with a fault at the first, second, third ... operation. [`Disk`] is the real one.

use std::fmt::Debug;
use std::fs::{self, File, OpenOptions};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};

/// Operations on files. Each may fail; none leaves a file under a final name that is not whole.
pub trait Storage: Debug + Send + Sync {
    /// Creates the file `path`, which must not exist (a link of that name is not followed), writes `bytes` and flushes them to the disk.
    ///
    /// # Errors
    /// The first operation that fails; a part of the file may be left.
    fn create(&self, path: &Path, bytes: &[u8]) -> io::Result<()>;

    /// Appends `bytes` to the file `path` at `length`, its length until now, and flushes them to the disk. What is there after `length` is cut
    /// off first: a line that an earlier failure left unfinished.
    ///
    /// # Errors
    /// The first operation that fails.
    fn append(&self, path: &Path, length: u64, bytes: &[u8]) -> io::Result<()>;

    /// The whole content of a regular file of at most `most` bytes.
    ///
    /// # Errors
    /// Where it cannot be read, is not a regular file, or is larger.
    fn read(&self, path: &Path, most: u64) -> io::Result<Vec<u8>>;

    /// Whether the content of the regular file `path` is `bytes`. Reads it piece by piece: a file of a part would otherwise be in memory
    /// twice.
    ///
    /// # Errors
    /// Where it cannot be read, or is not a regular file.
    fn has(&self, path: &Path, bytes: &[u8]) -> io::Result<bool>;

    /// Renames a file or folder, replacing a file of the new name.
    ///
    /// # Errors
    /// Where it fails.
    fn rename(&self, from: &Path, to: &Path) -> io::Result<()>;

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
    /// Where it fails, or something else of that name exists.
    fn create_folder(&self, path: &Path) -> io::Result<()>;

    /// Makes renames and new files in a folder durable.
    ///
    /// # Errors
    /// Where it fails.
    fn sync_folder(&self, path: &Path) -> io::Result<()>;

    /// The entries of a folder, ascending by name; none where there is no such folder.
    ///
    /// # Errors
    /// Where it fails.
    fn list(&self, path: &Path) -> io::Result<Vec<Entry>>;
}

/// An entry of a folder.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Entry {
    /// Its name.
    pub name: String,
    /// Whether it is a folder; a link to a folder is none.
    pub is_folder: bool,
    /// Whether it is a regular file; a link to a file is none.
    pub is_file: bool,
    /// Its size, bytes.
    pub size: u64,
}

/// The real file system.
#[derive(Clone, Copy, Debug, Default)]
pub struct Disk;

/// Bytes that are compared at a time: they stay in the second-level cache.
const PIECE: usize = 1 << 16;

/// Opens a regular file: no link, no folder, no pipe.
fn open_regular(path: &Path) -> io::Result<File> {
    if !fs::symlink_metadata(path)?.is_file() {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "not a regular file"));
    }
    File::open(path)
}

/// The content of a regular file of at most `most` bytes, from an open file: what is checked is what is read.
fn content(path: &Path, most: u64) -> io::Result<Vec<u8>> {
    let file = open_regular(path)?;
    let size = file.metadata()?.len();
    if size > most {
        return Err(io::Error::new(
            io::ErrorKind::FileTooLarge,
            format!("{size} bytes, where at most {most} are expected"),
        ));
    }
    let mut bytes = Vec::with_capacity(usize::try_from(size).unwrap_or(0));
    file.take(most).read_to_end(&mut bytes)?;
    Ok(bytes)
}

impl Storage for Disk {
    fn create(&self, path: &Path, bytes: &[u8]) -> io::Result<()> {
        let mut file = OpenOptions::new().write(true).create_new(true).open(path)?;
        file.write_all(bytes)?;
        file.sync_all()
    }

    fn append(&self, path: &Path, length: u64, bytes: &[u8]) -> io::Result<()> {
        let mut file = OpenOptions::new().append(true).open(path)?;
        if file.metadata()?.len() != length {
            file.set_len(length)?;
        }
        file.write_all(bytes)?;
        file.sync_data()
    }

    fn read(&self, path: &Path, most: u64) -> io::Result<Vec<u8>> {
        content(path, most)
    }

    fn has(&self, path: &Path, bytes: &[u8]) -> io::Result<bool> {
        let mut file = open_regular(path)?;
        if file.metadata()?.len() != bytes.len() as u64 {
            return Ok(false);
        }
        let mut piece = [0; PIECE];
        for expected in bytes.chunks(PIECE) {
            let found = &mut piece[..expected.len()];
            match file.read_exact(found) {
                Err(error) if error.kind() == io::ErrorKind::UnexpectedEof => return Ok(false),
                read => read?,
            }
            if found != expected {
                return Ok(false);
            }
        }
        // nothing may follow
        Ok(file.read(&mut piece[..1])? == 0)
    }

    fn rename(&self, from: &Path, to: &Path) -> io::Result<()> {
        fs::rename(from, to)
    }

    fn remove(&self, path: &Path) -> io::Result<()> {
        unless_absent(fs::remove_file(path))
    }

    fn remove_folder(&self, path: &Path) -> io::Result<()> {
        unless_absent(fs::remove_dir(path))
    }

    fn create_folder(&self, path: &Path) -> io::Result<()> {
        fs::create_dir_all(path)
    }

    fn sync_folder(&self, path: &Path) -> io::Result<()> {
        // only Unix can open and flush a folder
        if cfg!(unix) { File::open(path)?.sync_all() } else { Ok(()) }
    }

    fn list(&self, path: &Path) -> io::Result<Vec<Entry>> {
        let entries = match fs::read_dir(path) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Vec::new()),
            entries => entries?,
        };
        let mut list = Vec::new();
        for entry in entries {
            let entry = entry?;
            let metadata = entry.metadata()?; // of a link: the link's own
            let name = entry.file_name().to_string_lossy().into_owned();
            list.push(Entry { name, is_folder: metadata.is_dir(), is_file: metadata.is_file(), size: metadata.len() });
        }
        list.sort();
        Ok(list)
    }
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
    /// The file or folder.
    pub path: PathBuf,
    /// Why.
    pub source: io::Error,
}

/// Adds the path to an error.
pub fn at(path: &Path) -> impl FnOnce(io::Error) -> StorageError + use<> {
    let path = path.to_owned();
    move |source| StorageError { path, source }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: a file has the bytes that are in it, and no others: none less, none more, none different, in whichever piece.
    #[test]
    fn a_file_has_what_is_in_it() {
        let folder = std::env::temp_dir().join(format!("spindrift-storage-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        for length in [0, 1, PIECE - 1, PIECE, PIECE + 1, 3 * PIECE] {
            let (path, bytes) = (folder.join(length.to_string()), vec![7; length]);
            Disk.create(&path, &bytes).unwrap();
            assert!(Disk.has(&path, &bytes).unwrap(), "{length}");
            assert!(!Disk.has(&path, &[&bytes[..], &[7]].concat()).unwrap(), "{length}");
            for at in [0, length / 2, length.saturating_sub(1)].into_iter().filter(|at| *at < length) {
                let mut other = bytes.clone();
                other[at] = 8;
                assert!(!Disk.has(&path, &other).unwrap(), "{length}, byte {at}");
                assert!(!Disk.has(&path, &bytes[..at]).unwrap(), "{length}, the first {at}");
            }
        }
        assert!(Disk.has(&folder, &[]).is_err() && Disk.has(&folder.join("none"), &[]).is_err());
        fs::remove_dir_all(&folder).unwrap();
    }
}
