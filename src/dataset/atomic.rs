//! [`write()`]: files that are either whole or absent.
//!
//! A file is written under a temporary name in its own folder (a rename cannot cross file systems), flushed to the disk, and
//! then renamed. What a crash leaves is recognised by its name.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// Suffix of the name of an unfinished file.
pub const UNFINISHED: &str = ".tmp";

/// The name under which `path` is written until it is whole.
pub fn unfinished(path: &Path) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(UNFINISHED);
    PathBuf::from(name)
}

/// Writes the file `path` with `content` and renames it; an older file of that name is replaced only then.
///
/// # Errors
/// What `content` returns, or the first failing operation on the file; the unfinished file is removed.
pub fn write<E: From<io::Error>>(
    path: &Path,
    content: impl FnOnce(&mut BufWriter<File>) -> Result<(), E>,
) -> Result<(), E> {
    let temporary = unfinished(path);
    let written = (|| {
        let mut file = BufWriter::with_capacity(1 << 16, File::create(&temporary)?);
        content(&mut file)?;
        let file = file.into_inner().map_err(io::IntoInnerError::into_error)?;
        file.sync_all()?;
        fs::rename(&temporary, path)?;
        Ok(())
    })();
    if written.is_err() {
        // The first error is reported; a file that cannot be removed is recognised by its name.
        let _ = fs::remove_file(&temporary);
    }
    written
}

/// Makes the renames inside `folder` durable.
///
/// # Errors
/// Where the folder cannot be opened or flushed.
pub fn sync_folder(folder: &Path) -> io::Result<()> {
    // Only Unix can open and flush a folder.
    if cfg!(unix) { File::open(folder)?.sync_all() } else { Ok(()) }
}

/// Writes bytes as a whole file.
///
/// # Errors
/// The first failing operation on the file.
pub fn write_bytes(path: &Path, bytes: &[u8]) -> io::Result<()> {
    write(path, |file| file.write_all(bytes))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn folder(name: &str) -> PathBuf {
        let folder = std::env::temp_dir().join(format!("spindrift-atomic-{}-{name}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        folder
    }

    /// Law: after an error in the middle the old content is kept and no unfinished file is left.
    #[test]
    fn an_error_leaves_the_old_file() {
        let folder = folder("error");
        let path = folder.join("x.txt");
        write_bytes(&path, b"old").unwrap();
        let failed = write(&path, |file| {
            file.write_all(b"half")?;
            Err(io::Error::other("the disk is full"))
        });
        assert_eq!(failed.unwrap_err().to_string(), "the disk is full");
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 1);
        fs::remove_dir_all(&folder).unwrap();
    }

    /// Law: while it is written, a file does not exist under its final name.
    #[test]
    fn the_name_appears_when_the_file_is_whole() {
        let folder = folder("whole");
        let path = folder.join("x.txt");
        write::<io::Error>(&path, |file| {
            file.write_all(b"content")?;
            file.flush()?;
            assert!(!path.exists());
            assert!(unfinished(&path).exists());
            Ok(())
        })
        .unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"content");
        assert!(!unfinished(&path).exists());
        sync_folder(&folder).unwrap();
        fs::remove_dir_all(&folder).unwrap();
    }
}
