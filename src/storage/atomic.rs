//! [`write()`]: files that are either whole or absent, outside of datasets: tables, plots and reports that a command is told to write.
//! The files of a dataset are written by [`super::folder`].
//!
//! A file is written under a temporary name in its own folder (a rename cannot cross file systems), flushed to the disk, and
//! then renamed. Its temporary name is one that nothing else has; what a crash leaves is recognised by it.

use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::path::Path;

use crate::storage::names::unfinished;

/// That `path` is free, or a file or a link that a rename replaces: not a device, and not a pipe.
fn check_replaceable(path: &Path) -> io::Result<()> {
    match fs::symlink_metadata(path) {
        Ok(found) if !(found.is_file() || found.is_symlink()) => Err(io::Error::new(
            io::ErrorKind::AlreadyExists,
            "there is something of that name that is not a regular file",
        )),
        _ => Ok(()),
    }
}

/// Writes the file `path` with `content` and renames it; an older file of that name is replaced only then, and so is a link, not what it
/// leads to.
///
/// # Errors
/// What `content` returns, or the first failing operation on the file; the unfinished file is removed.
pub fn write<E: From<io::Error>>(
    path: &Path,
    content: impl FnOnce(&mut BufWriter<File>) -> Result<(), E>,
) -> Result<(), E> {
    check_replaceable(path)?;
    let temporary = unfinished(path);
    let file = OpenOptions::new().write(true).create_new(true).open(&temporary)?;
    let written = (|| {
        let mut file = BufWriter::with_capacity(1 << 16, file);
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
    use std::path::PathBuf;

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
            assert_eq!(fs::read_dir(&folder).unwrap().count(), 1);
            Ok(())
        })
        .unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"content");
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 1);
        fs::remove_dir_all(&folder).unwrap();
    }

    /// Law: a link that somebody put under the temporary or the final name is not followed, a file of the temporary name is kept, and a pipe of
    /// the final name is refused without waiting.
    #[cfg(unix)]
    #[test]
    fn links_are_not_followed() {
        use std::os::unix::fs::symlink;
        let folder = folder("links");
        let (path, precious) = (folder.join("s.csv"), folder.join("precious"));
        fs::write(&precious, b"precious").unwrap();
        symlink(&precious, folder.join("s.csv.tmp")).unwrap();
        fs::write(folder.join("s.csv.1.tmp"), b"of another process").unwrap();
        symlink(&precious, &path).unwrap();
        write_bytes(&path, b"new").unwrap();
        assert_eq!(fs::read(&precious).unwrap(), b"precious");
        assert_eq!(fs::read(folder.join("s.csv.1.tmp")).unwrap(), b"of another process");
        assert!(fs::symlink_metadata(&path).unwrap().is_file());
        assert_eq!(fs::read(&path).unwrap(), b"new");
        let pipe = folder.join("pipe.csv");
        assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
        assert!(write_bytes(&pipe, b"new").is_err());
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 5);
        fs::remove_dir_all(&folder).unwrap();
    }
}
