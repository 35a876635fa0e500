//! [`open`]: regular input files of bounded size. Links are followed; kind and size are those of the open file.

use std::fs::{File, FileType, OpenOptions};
use std::io::{self, Read};
use std::path::Path;
use thiserror::Error;

#[derive(Debug, Error)]
pub enum InputError {
    /// Not a regular file: "a folder".
    #[error("{0}, not a regular file")]
    Kind(&'static str),
    /// Too many bytes.
    #[error("{0} bytes are too many")]
    Size(u64),
    #[error(transparent)]
    Io(#[from] io::Error),
}

/// True if the file may exist but cannot be read now.
pub fn is_unreadable(error: &io::Error) -> bool {
    use io::ErrorKind::{InvalidFilename, InvalidInput, NotADirectory, NotFound};
    ![NotFound, NotADirectory, InvalidInput, InvalidFilename].contains(&error.kind())
}

fn kind(file: FileType) -> &'static str {
    #[cfg(unix)]
    {
        use std::os::unix::fs::FileTypeExt;
        if file.is_fifo() {
            return "a named pipe (FIFO)";
        }
        if file.is_char_device() || file.is_block_device() {
            return "a device";
        }
        if file.is_socket() {
            return "a socket";
        }
    }
    if file.is_dir() { "a folder" } else { "something that is not a file" }
}

/// Opens a regular file of at most `most` bytes; the file and its size. Does not wait.
///
/// # Errors
/// Another kind of file, a larger one, or an error of the system.
pub fn open(path: &Path, most: u64) -> Result<(File, u64), InputError> {
    let found = std::fs::metadata(path)?;
    if !found.is_file() {
        return Err(InputError::Kind(kind(found.file_type())));
    }
    let mut options = OpenOptions::new();
    options.read(true);
    #[cfg(unix)]
    {
        use std::os::unix::fs::OpenOptionsExt;
        // the path may be a pipe by now, and opening must not wait
        options.custom_flags(rustix::fs::OFlags::NONBLOCK.bits().cast_signed());
    }
    let file = options.open(path)?;
    let found = file.metadata()?;
    if !found.is_file() {
        return Err(InputError::Kind(kind(found.file_type())));
    }
    if found.len() > most { Err(InputError::Size(found.len())) } else { Ok((file, found.len())) }
}

/// The content of a regular file of at most `most` bytes.
///
/// # Errors
/// As [`open`]; also a file that grows beyond `most` bytes.
pub fn read(path: &Path, most: u64) -> Result<Vec<u8>, InputError> {
    let (file, size) = open(path, most)?;
    let mut bytes = Vec::with_capacity(usize::try_from(size).unwrap_or(0));
    file.take(most.saturating_add(1)).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > most { Err(InputError::Size(bytes.len() as u64)) } else { Ok(bytes) }
}
