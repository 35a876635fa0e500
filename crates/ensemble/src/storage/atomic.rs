//! [`write()`]: files outside of datasets that are either whole or absent. Datasets: `storage::disk`.
//!
//! A file is written under a unique temporary name in its own folder (a rename cannot cross file systems), flushed, and
//! renamed. The name identifies leftovers of a crash.

use super::store::Result;
use crate::storage::disk::above;
use crate::storage::names::unfinished;
use std::fs::File;
use std::io::{BufWriter, ErrorKind, Write};
use std::path::Path;
use std::{fs, io};

/// Refuses a `path` that a rename must not replace: a device or a pipe.
fn check_replaceable(path: &Path) -> io::Result<()> {
    match fs::symlink_metadata(path) {
        Ok(found) if !(found.is_file() || found.is_symlink()) => Err(io::Error::new(
            ErrorKind::AlreadyExists,
            "there is something of that name that is not a regular file; move it away, or choose another name",
        )),
        _ => Ok(()),
    }
}

/// An error of creating `path` in words: the obstacle and the remedy.
pub fn explained(path: &Path, error: io::Error) -> io::Error {
    let folder = above(path);
    let text = match error.kind() {
        ErrorKind::AlreadyExists if path.is_dir() => "is a folder; choose another name".to_owned(),
        ErrorKind::AlreadyExists => {
            "is there already, and is not replaced; move it away, or choose another name".to_owned()
        }
        ErrorKind::NotFound => {
            format!("there is no folder `{}`; make it, or choose another path", folder.display())
        }
        ErrorKind::NotADirectory => {
            let file = path.ancestors().find(|part| part.is_file()).unwrap_or(folder);
            format!("`{}` is a file and not a folder; choose another path", file.display())
        }
        _ => return error,
    };
    io::Error::new(error.kind(), text)
}

/// Creates the folder `path` and all above it, unless they exist.
///
/// # Errors
/// A failure, in words with the path.
pub fn make_folder(path: &Path) -> io::Result<()> {
    fs::create_dir_all(path).map_err(|error| {
        let why = explained(path, error);
        io::Error::new(why.kind(), format!("{}: {why}", path.display()))
    })
}

/// Writes the file `path` with `content` under a temporary name and renames it, replacing an older file, or a link but
/// not its target.
///
/// # Errors
/// The error of `content`, or of the first failed operation; the unfinished file is removed.
pub fn write<E: From<io::Error>>(
    path: &Path,
    content: impl FnOnce(&mut BufWriter<File>) -> Result<(), E>,
) -> Result<(), E> {
    check_replaceable(path)?;
    let temporary = unfinished(path);
    let file = File::create_new(&temporary).map_err(|error| explained(path, error))?;
    let written = (|| {
        let mut file = BufWriter::with_capacity(1 << 16, file);
        content(&mut file)?;
        let file = file.into_inner().map_err(io::IntoInnerError::into_error)?;
        file.sync_all()?;
        fs::rename(&temporary, path)?;
        Ok(())
    })();
    if written.is_err() {
        let _ = fs::remove_file(&temporary);
    }
    written
}

/// # Errors
/// The first failed operation on the file.
pub fn write_bytes(path: &Path, bytes: &[u8]) -> io::Result<()> {
    write(path, |file| file.write_all(bytes))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::storage::scratch::Scratch;

    /// Law: obstacles are named in words, with the remedy and without numbers of the system.
    #[test]
    fn what_is_in_the_way_is_said() {
        let folder = Scratch::new("atomic-words");
        let file = folder.join("a");
        fs::write(&file, b"a").unwrap();
        let create = |path: &Path| File::create_new(path).map(drop).map_err(|error| explained(path, error));
        let cases = [
            (create(&file), "is there already, and is not replaced; move it away"),
            (create(&folder), "is a folder; choose another name"),
            (create(&folder.join("no/b")), "there is no folder `"),
            (create(&file.join("b")), "a` is a file and not a folder; choose"),
            (write_bytes(&folder.join("no/b"), b"b"), "there is no folder `"),
            (make_folder(&file), "is there already, and is not replaced; move it away"),
            (make_folder(&file.join("b")), "a` is a file and not a folder; choose"),
        ];
        for (found, words) in cases {
            let said = found.expect_err(words).to_string();
            assert!(said.contains(words) && !said.contains("os error"), "{words}: {said}");
        }
    }

    /// Law: an unfinished file has no final name; after an error the old content stays and no temporary file is left.
    #[test]
    fn the_name_appears_when_the_file_is_whole() {
        let folder = Scratch::new("atomic-whole");
        let path = folder.join("x.txt");
        for (content, fails) in [("old", false), ("half", true)] {
            let written = write(&path, |file| {
                file.write_all(content.as_bytes())?;
                file.flush()?;
                assert_eq!(path.exists(), fails);
                if fails { Err(io::Error::other("the disk is full")) } else { Ok(()) }
            });
            assert_eq!(written.is_err(), fails);
            assert_eq!((fs::read(&path).unwrap(), fs::read_dir(&*folder).unwrap().count()), (b"old".to_vec(), 1));
        }
    }

    /// Law: links under the temporary or final name are not followed, an existing temporary file is kept, and a pipe is
    /// refused without waiting.
    #[cfg(unix)]
    #[test]
    fn links_are_not_followed() {
        use std::os::unix::fs::symlink;
        let folder = Scratch::new("atomic-links");
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
        assert_eq!(fs::read_dir(&*folder).unwrap().count(), 5);
    }
}
