//! [`StoredFile`]: a file of a dataset that is open for reading, at any position, so that tests can let any read fail.
//!
//! What a file is and whether it can be read are two things: [`Unfit`] says that a file is not what a dataset has
//! there; every other error says that it cannot be read now, and nothing about what is in it. A file that ends before
//! its length is of the second kind.

use std::fmt::Debug;
use std::fs::File;
use std::io;

use thiserror::Error;

/// An open file. Reads do not change its state on Unix; elsewhere one thread at a time reads it.
pub trait StoredFile: Debug + Send + Sync {
    /// Its length, bytes.
    ///
    /// # Errors
    /// Where it cannot be found out.
    fn length(&self) -> io::Result<u64>;

    /// Reads into `bytes` what is there from `offset` on; how many bytes that are: fewer than asked for at any time,
    /// none at the end only.
    ///
    /// # Errors
    /// Where they cannot be read.
    fn read_at(&self, offset: u64, bytes: &mut [u8]) -> io::Result<usize>;
}

impl StoredFile for File {
    fn length(&self) -> io::Result<u64> {
        Ok(self.metadata()?.len())
    }

    #[cfg(unix)]
    fn read_at(&self, offset: u64, bytes: &mut [u8]) -> io::Result<usize> {
        std::os::unix::fs::FileExt::read_at(self, bytes, offset)
    }

    #[cfg(not(unix))]
    fn read_at(&self, offset: u64, bytes: &mut [u8]) -> io::Result<usize> {
        use std::io::{Read, Seek, SeekFrom};
        let mut file = self;
        file.seek(SeekFrom::Start(offset))?;
        file.read(bytes)
    }
}

/// What is not a file of a dataset, whatever is in it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum Unfit {
    /// A folder, a link, a pipe or a device.
    #[error("not a regular file")]
    Kind,
    /// A file that is too large.
    #[error("{length} bytes, where at most {most} are expected")]
    Length {
        /// Its length, bytes.
        length: u64,
        /// The limit, bytes.
        most: u64,
    },
}

impl From<Unfit> for io::Error {
    fn from(unfit: Unfit) -> Self {
        let kind = match unfit {
            Unfit::Kind => io::ErrorKind::InvalidInput,
            Unfit::Length { .. } => io::ErrorKind::FileTooLarge,
        };
        io::Error::new(kind, unfit)
    }
}

/// Whether `error` says that a file is not what a dataset has, and not that it cannot be read.
pub fn is_unfit(error: &io::Error) -> bool {
    error.get_ref().is_some_and(|source| source.is::<Unfit>())
}

/// Reads what is in `file` from `offset` on; an interrupted read is repeated.
///
/// # Errors
/// Where it cannot be read, or ends before `bytes` is full.
pub fn fill(file: &dyn StoredFile, offset: u64, bytes: &mut [u8]) -> io::Result<()> {
    let mut done = 0;
    while done < bytes.len() {
        let found = read_some(file, offset + done as u64, &mut bytes[done..])?;
        if found == 0 {
            return Err(ended(offset + done as u64));
        }
        done += found;
    }
    Ok(())
}

/// [`StoredFile::read_at`]; an interrupted read is repeated.
///
/// # Errors
/// Where it cannot be read.
pub fn read_some(file: &dyn StoredFile, offset: u64, bytes: &mut [u8]) -> io::Result<usize> {
    loop {
        match file.read_at(offset, bytes) {
            Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
            read => return read,
        }
    }
}

/// The error of a file that ends at `offset`, where its length is more.
pub fn ended(offset: u64) -> io::Error {
    io::Error::new(
        io::ErrorKind::UnexpectedEof,
        format!("the file ends after {offset} bytes, before the length that it has"),
    )
}

/// The content of a file of at most `most` bytes.
///
/// # Errors
/// Where it is larger, or cannot be read as far as its length.
pub fn content(file: &dyn StoredFile, most: u64) -> io::Result<Vec<u8>> {
    let length = file.length()?;
    let unfit = Unfit::Length { length, most };
    let size = usize::try_from(length).ok().filter(|_| length <= most).ok_or(unfit)?;
    let mut bytes = vec![0; size];
    fill(file, 0, &mut bytes)?;
    Ok(bytes)
}

/// Bytes that are compared at a time: they stay in the second-level cache.
const PIECE: usize = 1 << 16;

/// Whether the content of a file is `bytes`. Reads it piece by piece: a file of a part would otherwise be in memory
/// twice.
///
/// # Errors
/// Where it cannot be read.
pub fn has(file: &dyn StoredFile, bytes: &[u8]) -> io::Result<bool> {
    if file.length()? != bytes.len() as u64 {
        return Ok(false);
    }
    let mut piece = [0; PIECE];
    let mut offset = 0;
    for expected in bytes.chunks(PIECE) {
        let found = &mut piece[..expected.len()];
        fill(file, offset, found)?;
        if found != expected {
            return Ok(false);
        }
        offset += expected.len() as u64;
    }
    Ok(true)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicUsize, Ordering};

    /// Memory that is read in pieces of some bytes; every other read is interrupted.
    #[derive(Debug)]
    struct Memory {
        bytes: Vec<u8>,
        length: u64,
        piece: usize,
        reads: AtomicUsize,
    }

    impl Memory {
        fn new(length: usize, piece: usize) -> Self {
            let bytes = (0..length).map(|at| (at % 251) as u8).collect();
            Memory { bytes, length: length as u64, piece, reads: AtomicUsize::new(0) }
        }
    }

    impl StoredFile for Memory {
        fn length(&self) -> io::Result<u64> {
            Ok(self.length)
        }

        fn read_at(&self, offset: u64, bytes: &mut [u8]) -> io::Result<usize> {
            if self.reads.fetch_add(1, Ordering::Relaxed).is_multiple_of(2) {
                return Err(io::ErrorKind::Interrupted.into());
            }
            let rest = self.bytes.get(offset as usize..).unwrap_or_default();
            let count = rest.len().min(bytes.len()).min(self.piece);
            bytes[..count].copy_from_slice(&rest[..count]);
            Ok(count)
        }
    }

    /// Law: a file has the bytes that are in it, and no others: none less, none more, none different, in whichever
    /// piece.
    #[test]
    fn a_file_has_what_is_in_it() {
        for (length, piece) in [(0, 1), (1, 1), (300, 7), (PIECE - 1, PIECE), (PIECE + 1, 1000), (3 * PIECE, PIECE)] {
            let file = Memory::new(length, piece);
            let bytes = file.bytes.clone();
            assert_eq!(content(&file, length as u64).unwrap(), bytes);
            assert!(has(&file, &bytes).unwrap(), "{length}");
            assert!(!has(&file, &[&bytes[..], &[7]].concat()).unwrap(), "{length}");
            for at in [0, length / 2, length.saturating_sub(1)].into_iter().filter(|at| *at < length) {
                let mut other = bytes.clone();
                other[at] ^= 8;
                assert!(!has(&file, &other).unwrap(), "{length}, byte {at}");
                assert!(!has(&file, &bytes[..at]).unwrap(), "{length}, the first {at}");
            }
        }
    }

    /// Law: a file that ends before its length cannot be read; one that is too large is unfit. These are told apart.
    #[test]
    fn a_short_file_is_an_error_of_reading() {
        let mut file = Memory::new(300, 100);
        assert!(is_unfit(&content(&file, 299).unwrap_err()));
        file.length = 301;
        let short = content(&file, 400).unwrap_err();
        assert!(short.kind() == io::ErrorKind::UnexpectedEof && !is_unfit(&short), "{short}");
        assert!(short.to_string().contains("ends after 300 bytes"), "{short}");
        assert_eq!(has(&file, &[0; 301]).unwrap_err().kind(), io::ErrorKind::UnexpectedEof);
        // the same kinds from elsewhere say nothing about a file
        assert!(!is_unfit(&io::ErrorKind::InvalidInput.into()) && !is_unfit(&io::ErrorKind::FileTooLarge.into()));
    }
}
