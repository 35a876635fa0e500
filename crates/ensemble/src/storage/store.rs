//! [`Store`]: a place for the files of one dataset: a folder, an object store, or a failing one in tests.
//!
//! A file of the wrong kind is [`Unfit`]; any other error means that it cannot be read now, as a file that ends before
//! its length.

use std::fmt::Debug;
use std::fs::{File, TryLockError};
use std::io::{self, ErrorKind, Read};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use thiserror::Error;

const MOST: u64 = 1 << 36;

/// The files of one dataset, by names below [`Store::root`] with `/`.
pub trait Store: Debug + Send + Sync {
    /// The folder or address, for messages.
    fn root(&self) -> &Path;

    /// Puts a whole file, durably and atomically. An object store refuses to replace other bytes.
    ///
    /// # Errors
    /// A file that may not be there with these bytes.
    fn put(&self, name: &str, bytes: &[u8]) -> io::Result<()>;

    /// Puts a whole file unless the name exists; one of several processes succeeds.
    ///
    /// # Errors
    /// If no file of this name is known to be there.
    fn put_if_absent(&self, name: &str, bytes: &[u8]) -> io::Result<()>;

    /// The content of a regular file.
    ///
    /// # Errors
    /// A file that cannot be read to its end, or is [`Unfit`].
    fn get(&self, name: &str) -> io::Result<Vec<u8>>;

    /// The entries of a folder, ascending by name; of the whole dataset if `folder` is empty.
    ///
    /// # Errors
    /// An absent folder, or a failed listing.
    fn list(&self, folder: &str) -> io::Result<Vec<Entry>>;

    /// Removes a file or an empty folder durably, if present. An object store removes nothing.
    fn remove(&self, name: &str) -> io::Result<()>;

    /// Locks other processes out while held, including shared locks unless `is_shared`; `None` without locks.
    ///
    /// # Errors
    /// A lock of another process, or a failure.
    fn lock(&self, is_shared: bool) -> Result<Option<File>, TryLockError>;

    fn rename(&self, to: &Path) -> io::Result<()>;

    /// True if files can be replaced and removed.
    fn replaces(&self) -> bool {
        true
    }

    /// Keeps a file that may be superseded: a store that replaces nothing puts only the last version.
    ///
    /// # Errors
    /// As [`Store::put`].
    fn put_for_now(&self, name: &str, bytes: &[u8]) -> io::Result<()> {
        self.put(name, bytes)
    }
}

pub type OpenFolder<'a> = dyn Fn(&Path) -> Arc<dyn Store> + Sync + 'a;

impl dyn Store + '_ {
    /// The path of the file `name`, for messages.
    pub fn path(&self, name: &str) -> PathBuf {
        if name.is_empty() { self.root().to_owned() } else { self.root().join(name) }
    }

    /// Adds the path of `name` to an error.
    pub fn at(&self, name: &str) -> impl FnOnce(io::Error) -> StoreError + use<'_> {
        at(&self.path(name))
    }

    /// The content of the file `name`, or its damage if absent or unfit.
    ///
    /// # Errors
    /// A file that cannot be read now.
    pub fn read(&self, name: &str) -> Result<Result<Vec<u8>, io::Error>> {
        let got = match self.get(name) {
            Err(error) if error.kind() == ErrorKind::NotFound => {
                if self.is_absent(name, &error)? {
                    return Ok(Err(error));
                }
                // another process has put it since
                self.get(name)
            }
            got => got,
        };
        match got {
            Ok(bytes) => Ok(Ok(bytes)),
            Err(error) if is_unfit(&error) || self.is_absent(name, &error)? => Ok(Err(error)),
            Err(error) => Err(self.at(name)(error)),
        }
    }

    /// True if `error` means that `name` is absent, confirmed by the listing of its folder.
    ///
    /// # Errors
    /// A failed listing.
    fn is_absent(&self, name: &str, error: &io::Error) -> Result<bool> {
        if error.kind() != ErrorKind::NotFound || name.is_empty() {
            return Ok(false);
        }
        let (folder, file) = name.rsplit_once('/').unwrap_or(("", name));
        match self.list(folder) {
            Ok(entries) => Ok(entries.iter().all(|entry| entry.name != file)),
            Err(error) if error.kind() == ErrorKind::NotFound => self.is_absent(folder, &error),
            Err(error) => Err(self.at(folder)(error)),
        }
    }

    /// The entries of `folder`; none if absent.
    ///
    /// # Errors
    /// A failed listing.
    pub fn entries(&self, folder: &str) -> Result<Vec<Entry>> {
        match self.list(folder) {
            Ok(entries) => Ok(entries),
            Err(error) if self.is_absent(folder, &error)? => Ok(Vec::new()),
            Err(error) => Err(self.at(folder)(error)),
        }
    }
}

#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Entry {
    pub name: String,
    /// True if it is a folder, and not a link.
    pub is_folder: bool,
    /// True if it is a regular file, and not a link.
    pub is_file: bool,
    /// Bytes.
    pub size: u64,
}

#[derive(Debug, Error)]
#[error("{}: {source}", path.display())]
pub struct StoreError {
    pub path: PathBuf,
    pub source: io::Error,
}

pub type Result<T, E = StoreError> = std::result::Result<T, E>;

/// A failure of which only the text matters.
pub type Failure = Box<dyn std::error::Error + Send + Sync>;

/// Adds the path to an error.
pub fn at(path: &Path) -> impl FnOnce(io::Error) -> StoreError + use<> {
    let path = path.to_owned();
    move |source| StoreError { path, source }
}

/// Not a file of a dataset, whatever its content.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum Unfit {
    /// A folder, a link, a pipe or a device.
    #[error("not a regular file")]
    Kind,
    #[error("{0} bytes, more than any file of a result has")]
    Length(u64),
}

impl From<Unfit> for io::Error {
    fn from(unfit: Unfit) -> Self {
        let kind = match unfit {
            Unfit::Kind => ErrorKind::InvalidInput,
            Unfit::Length(_) => ErrorKind::FileTooLarge,
        };
        io::Error::new(kind, unfit)
    }
}

fn is_unfit(error: &io::Error) -> bool {
    error.get_ref().is_some_and(|source| source.is::<Unfit>())
}

/// The content of `file`, which has `length` bytes.
///
/// # Errors
/// A file that is too large, or cannot be read to its end.
pub fn content(file: impl Read, length: u64) -> io::Result<Vec<u8>> {
    let size = usize::try_from(length).ok().filter(|_| length <= MOST);
    let mut bytes = Vec::new();
    bytes.try_reserve_exact(size.ok_or(Unfit::Length(length))?)?;
    file.take(length).read_to_end(&mut bytes)?;
    if bytes.len() as u64 == length {
        return Ok(bytes);
    }
    let why = format!("the file ends after {} bytes, before the length that it has", bytes.len());
    Err(io::Error::new(ErrorKind::UnexpectedEof, why))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Memory read in small pieces; every other read is interrupted.
    struct Pieces<'a>(&'a [u8], usize);

    impl Read for Pieces<'_> {
        fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
            self.1 += 1;
            if self.1.is_multiple_of(2) {
                return Err(ErrorKind::Interrupted.into());
            }
            let count = bytes.len().min(7);
            self.0.read(&mut bytes[..count])
        }
    }

    /// Law: a file is read in any pieces; a short one is an error of reading, a too large one is unfit.
    #[test]
    fn a_short_file_is_an_error_of_reading() {
        let bytes: Vec<u8> = (0..255).collect();
        let read = |length| content(Pieces(&bytes, 0), length);
        assert_eq!(read(255).unwrap(), bytes);
        assert!(is_unfit(&read(MOST + 1).unwrap_err()));
        let short = read(256).unwrap_err();
        assert!(short.kind() == ErrorKind::UnexpectedEof && !is_unfit(&short), "{short}");
        assert!(short.to_string().contains("ends after 255 bytes"), "{short}");
    }
}
