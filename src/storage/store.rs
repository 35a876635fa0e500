//! [`Store`]: a place that holds the files of one dataset: a folder on a disk, an address in an object store, or a
//! failing one in tests.
//!
//! A file that is not what a dataset has under its name is [`Unfit`]; every other error means that the file cannot be
//! read now and says nothing about its content. A file that ends before its length is of the second kind.

use std::fmt::Debug;
use std::fs::{File, TryLockError};
use std::io::{self, ErrorKind, Read};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use thiserror::Error;

/// Most bytes of a file.
const MOST: u64 = 1 << 36;

/// The files of one dataset, each by its name below [`Store::root`], with `/` between folder and file.
pub trait Store: Debug + Send + Sync {
    /// The folder or address, for messages.
    fn root(&self) -> &Path;

    /// Puts a whole file, durably: nobody sees a part of it. An object store keeps what it has and refuses other
    /// bytes.
    ///
    /// # Errors
    /// Where the file is not known to be there with these bytes.
    fn put(&self, name: &str, bytes: &[u8]) -> io::Result<()>;

    /// Puts a whole file unless there is one of this name, which then stays: of several processes one succeeds.
    ///
    /// # Errors
    /// Where no file of this name is known to be there.
    fn put_if_absent(&self, name: &str, bytes: &[u8]) -> io::Result<()>;

    /// The content of a file: no link, no folder, no pipe.
    ///
    /// # Errors
    /// Where it cannot be read as far as its length, or is [`Unfit`].
    fn get(&self, name: &str) -> io::Result<Vec<u8>>;

    /// The entries of a folder, ascending by name; of the whole dataset where `folder` is empty.
    ///
    /// # Errors
    /// Where they cannot be listed, or there is no such folder.
    fn list(&self, folder: &str) -> io::Result<Vec<Entry>>;

    /// Removes a file or an empty folder, durably; no error where there is none. An object store removes nothing.
    fn remove(&self, name: &str) -> io::Result<()>;

    /// Keeps other processes away until the result is dropped, those with shared locks too unless `is_shared`; `None`
    /// where there are no locks.
    ///
    /// # Errors
    /// Where another process has the lock, or it cannot be taken.
    fn lock(&self, is_shared: bool) -> Result<Option<File>, TryLockError>;

    /// Gives the folder the name `to`.
    fn rename(&self, to: &Path) -> io::Result<()>;

    /// Whether files can be replaced and removed.
    fn replaces(&self) -> bool {
        true
    }

    /// Keeps a file of which a later version may come: a store that replaces nothing puts it when it is put again.
    ///
    /// # Errors
    /// As [`Store::put`].
    fn put_for_now(&self, name: &str, bytes: &[u8]) -> io::Result<()> {
        self.put(name, bytes)
    }
}

/// Opens the store in a folder of a disk.
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

    /// The content of the file `name`; what is wrong with it where it is absent or unfit.
    ///
    /// # Errors
    /// Where it cannot be read now.
    pub fn read(&self, name: &str) -> Result<Result<Vec<u8>, io::Error>, StoreError> {
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

    /// Whether `error` is that the file or folder `name` is absent, and its folder does not list it either.
    ///
    /// # Errors
    /// Where the folder cannot be listed.
    fn is_absent(&self, name: &str, error: &io::Error) -> Result<bool, StoreError> {
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

    /// The entries of the folder `folder` of the dataset; none where it is absent.
    ///
    /// # Errors
    /// Where they cannot be listed.
    pub fn entries(&self, folder: &str) -> Result<Vec<Entry>, StoreError> {
        match self.list(folder) {
            Ok(entries) => Ok(entries),
            Err(error) if self.is_absent(folder, &error)? => Ok(Vec::new()),
            Err(error) => Err(self.at(folder)(error)),
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

/// A file operation that failed, with the path.
#[derive(Debug, Error)]
#[error("{}: {source}", path.display())]
pub struct StoreError {
    pub path: PathBuf,
    pub source: io::Error,
}

/// Why something could not be made or written, where only its text is of use.
pub type Failure = Box<dyn std::error::Error + Send + Sync>;

/// Adds the path to an error.
pub fn at(path: &Path) -> impl FnOnce(io::Error) -> StoreError + use<> {
    let path = path.to_owned();
    move |source| StoreError { path, source }
}

/// What is not a file of a dataset, whatever is in it.
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
/// Where it is too large, or cannot be read as far as its length.
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

    /// Memory that is read in pieces of some bytes; every other read is interrupted.
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

    /// Law: a file is read in whichever pieces it comes; one that ends before its length cannot be read, and one that
    /// is too large is unfit: these are told apart.
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
