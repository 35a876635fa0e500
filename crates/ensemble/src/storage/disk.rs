//! [`Disk`]: a dataset in a folder of a disk.
//!
//! A file is written under its own temporary name (created new, links are not followed), flushed, read back and
//! compared, and renamed; then its folder is flushed. So a file under a final name is whole, whatever stops a process.
//!
//! Files that a command writes elsewhere are in [`super::atomic`], data files of a campaign in
//! [`crate::campaign::input_file`].

use super::store::{Result, Store};
use crate::storage::names::unfinished;
use crate::storage::store::{Entry, Unfit, content};
use std::fs::{self, File, TryLockError};
use std::io;
use std::io::{ErrorKind, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;

#[derive(Clone, Debug)]
pub struct Disk(PathBuf);

/// The store in the folder `root`, which may be absent.
pub fn folder(root: &Path) -> Arc<dyn Store> {
    Arc::new(Disk(root.to_owned()))
}

/// Rewrites of a temporary file that other processes clear away.
const MOST_CLEARED: usize = 8;

impl Disk {
    /// The path of the file `name`, not through a link.
    fn own(&self, name: &str) -> io::Result<PathBuf> {
        let path = self.0.join(name);
        no_link(&self.0)?;
        no_link(above(&path))?;
        Ok(path)
    }

    /// Writes and checks a file under a temporary name, then lets `place` name it.
    fn place(&self, name: &str, bytes: &[u8], place: impl Fn(&Path, &Path) -> io::Result<()>) -> io::Result<()> {
        let path = self.own(name)?;
        new_folder(above(&path))?;
        // nothing is written through a new link
        no_link(above(&path))?;
        let put = || {
            let temporary = written(&path, bytes, &create)?;
            place(&temporary, &path).inspect_err(|_| {
                // the name of a file that cannot be removed identifies it
                let _ = fs::remove_file(&temporary);
            })
        };
        let mut placed = put();
        // without locks, starting processes clear each other's temporary files away
        for _ in 0..MOST_CLEARED {
            match &placed {
                Err(error) if error.kind() == ErrorKind::NotFound => placed = put(),
                _ => break,
            }
        }
        placed?;
        sync_folder(above(&path))
    }
}

impl Store for Disk {
    fn root(&self) -> &Path {
        &self.0
    }

    fn put(&self, name: &str, bytes: &[u8]) -> io::Result<()> {
        self.place(name, bytes, |temporary, path| fs::rename(temporary, path))
    }

    fn put_if_absent(&self, name: &str, bytes: &[u8]) -> io::Result<()> {
        self.place(name, bytes, |temporary, path| match fs::hard_link(temporary, path) {
            // a file system without hard links
            Err(_) if !path.exists() => fs::rename(temporary, path),
            _ => fs::remove_file(temporary).or_else(unless_absent),
        })
    }

    fn get(&self, name: &str) -> io::Result<Vec<u8>> {
        let path = self.0.join(name);
        if !fs::symlink_metadata(&path)?.is_file() {
            return Err(Unfit::Kind.into());
        }
        let file = File::open(path)?;
        let length = file.metadata()?.len();
        content(file, length)
    }

    fn list(&self, folder: &str) -> io::Result<Vec<Entry>> {
        let mut list = Vec::new();
        for entry in fs::read_dir(self.0.join(folder))? {
            let entry = entry?;
            let metadata = match entry.metadata() {
                Err(error) if error.kind() == ErrorKind::NotFound => continue,
                metadata => metadata?,
            };
            let name = entry.file_name().to_string_lossy().into_owned();
            list.push(Entry { name, is_folder: metadata.is_dir(), is_file: metadata.is_file(), size: metadata.len() });
        }
        list.sort();
        Ok(list)
    }

    fn remove(&self, name: &str) -> io::Result<()> {
        let path = if name.is_empty() { self.0.clone() } else { self.own(name)? };
        let removed = match fs::symlink_metadata(&path) {
            Ok(found) if found.is_dir() => fs::remove_dir(&path),
            Ok(_) => fs::remove_file(&path),
            Err(error) => Err(error),
        };
        removed.and_then(|()| sync_folder(above(&path))).or_else(unless_absent)
    }

    fn lock(&self, is_shared: bool) -> Result<Option<File>, TryLockError> {
        let file = match File::open(&self.0) {
            // only Unix can open a folder
            Err(_) if !cfg!(unix) => return Ok(None),
            file => file.map_err(TryLockError::Error)?,
        };
        match if is_shared { file.try_lock_shared() } else { file.try_lock() } {
            // another folder may have taken the name
            Ok(()) if is_at(&file, &self.0) => Ok(Some(file)),
            Ok(()) | Err(TryLockError::WouldBlock) => Err(TryLockError::WouldBlock),
            Err(TryLockError::Error(error)) if has_no_locks(&error) => Ok(None),
            Err(error) => Err(error),
        }
    }

    fn rename(&self, to: &Path) -> io::Result<()> {
        fs::rename(&self.0, to)
    }
}

fn create(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut file = File::create_new(path)?;
    file.write_all(bytes)?;
    file.sync_all()
}

/// Writes a temporary file for `path`, returned, and compares what is read back.
fn written(path: &Path, bytes: &[u8], create: &dyn Fn(&Path, &[u8]) -> io::Result<()>) -> io::Result<PathBuf> {
    let temporary = unfinished(path);
    let write = || {
        create(&temporary, bytes)?;
        if has(&File::open(&temporary)?, bytes)? {
            return Ok(());
        }
        Err(io::Error::other("what was read back is not what was written"))
    };
    let Err(first) = write() else { return Ok(temporary) };
    // after a failed flush the state of the file is unknown: one rewrite
    fs::remove_file(&temporary).and_then(|()| write()).map_err(|_| {
        let _ = fs::remove_file(&temporary);
        first
    })?;
    Ok(temporary)
}

/// Bytes compared at a time, in the second-level cache.
const PIECE: usize = 1 << 16;

/// True if a file has the content `bytes`, read in pieces: a part is not in memory twice.
fn has(mut file: &File, bytes: &[u8]) -> io::Result<bool> {
    if file.metadata()?.len() != bytes.len() as u64 {
        return Ok(false);
    }
    let mut found = [0; PIECE];
    for piece in bytes.chunks(PIECE) {
        file.read_exact(&mut found[..piece.len()])?;
        if found[..piece.len()] != *piece {
            return Ok(false);
        }
    }
    Ok(true)
}

fn unless_absent(error: io::Error) -> io::Result<()> {
    if error.kind() == ErrorKind::NotFound { Ok(()) } else { Err(error) }
}

/// True if `error` means that a file system has no locks.
fn has_no_locks(error: &io::Error) -> bool {
    #[cfg(unix)]
    {
        use rustix::io::Errno;
        let numbers = [Errno::OPNOTSUPP, Errno::NOTSUP, Errno::NOLCK, Errno::NOSYS].map(Errno::raw_os_error);
        error.raw_os_error().is_some_and(|number| numbers.contains(&number))
    }
    #[cfg(not(unix))]
    {
        error.kind() == ErrorKind::Unsupported
    }
}

/// True if `path` still leads to the open `file`.
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

/// Refuses a link or file in place of a folder of a dataset, which would lead elsewhere.
fn no_link(folder: &Path) -> io::Result<()> {
    match fs::symlink_metadata(folder) {
        Ok(found) if !found.is_dir() => {
            let why = "a link, or no folder, where a folder of the result should be";
            Err(io::Error::new(ErrorKind::NotADirectory, why))
        }
        Err(error) if error.kind() != ErrorKind::NotFound => Err(error),
        _ => Ok(()),
    }
}

pub fn above(path: &Path) -> &Path {
    path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Makes renames and new files in a folder durable.
pub fn sync_folder(path: &Path) -> io::Result<()> {
    // only Unix can open and flush a folder
    if cfg!(unix) { File::open(path)?.sync_all() } else { Ok(()) }
}

/// Creates a folder and all above it durably, unless they exist.
///
/// # Errors
/// A failure, or something else of that name.
pub fn new_folder(path: &Path) -> io::Result<()> {
    let is_missing = |folder: &&Path| !folder.as_os_str().is_empty() && !folder.exists();
    let missing: Vec<&Path> = path.ancestors().take_while(is_missing).map(above).collect();
    fs::create_dir_all(path)?;
    missing.into_iter().try_for_each(sync_folder)
}

/// The folder meant by `path`: the target of a link, so that later changes of the link have no effect, with a name
/// instead of `.` or `..`.
///
/// # Errors
/// An unreadable link, or a loop of links.
pub fn meant(path: &Path) -> io::Result<PathBuf> {
    // without a final slash and inner `.`
    let mut folder: PathBuf = path.components().collect();
    // the limit of Linux
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: a file is read as put; altered, occupied and irregular ones are refused; only empty folders are removed.
    #[test]
    fn a_file_is_whole_or_absent() {
        let root = crate::storage::scratch::Scratch::new("disk");
        let disk = Disk(root.to_owned());
        disk.put("runs/a", b"12345").unwrap();
        disk.put_if_absent("runs/a", b"other").unwrap();
        assert_eq!(disk.get("runs/a").unwrap(), b"12345");
        assert!(disk.get("runs").is_err() && disk.get("none").is_err() && disk.remove("runs").is_err());
        let altering = |path: &Path, bytes: &[u8]| create(path, &[bytes, b"x"].concat());
        assert!(written(&root.join("b"), b"12", &altering).is_err());
        assert_eq!(disk.list("").unwrap().len(), 1, "nothing is left of it");
        // two cleared temporary files are written again
        let cleared = std::cell::Cell::new(0);
        let place = |temporary: &Path, path: &Path| {
            if cleared.replace(cleared.get() + 1) < 2 {
                fs::remove_file(temporary)?;
            }
            fs::rename(temporary, path)
        };
        disk.place("c", b"34", place).unwrap();
        assert_eq!((disk.get("c").unwrap(), cleared.get(), disk.list("").unwrap().len()), (b"34".to_vec(), 3, 2));
        for name in ["c", "runs/a", "runs", "runs", ""] {
            disk.remove(name).unwrap();
        }
        assert!(!root.exists());
    }
}
