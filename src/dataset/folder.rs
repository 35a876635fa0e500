//! [`Folder`]: a dataset on the disk, and the protocol by which parts are added to it.
//!
//! ```text
//! results/<name>/plan.toml                 the resolved plan
//! results/<name>/manifest.jsonl            what is there: only what it lists exists
//! results/<name>/runs/part-000000.parquet  rows, part by part
//! results/<name>/_SUCCESS                  everything is there
//! ```
//! A part is written under a temporary name, flushed to the disk, read back and compared, and renamed; its folder is flushed; then one line
//! of the manifest lists it. Whatever stops the program, the parts that are listed are whole, and the others are made again.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use crate::dataset::identity::sha256;
use crate::dataset::manifest::{FileRecord, Identity, Manifest, PartRecord, Record};
use crate::dataset::names::{DATA, MANIFEST, PLAN, SHARDS, SUCCESS, UNFINISHED, is_ours};
use crate::dataset::storage::{Storage, StorageError, at, entries_in};
use crate::dataset::stored_file::is_unfit;
use crate::ensemble::Part;

/// Most bytes of a manifest: a line is some 400 bytes, and a campaign of 10^12 samples has 61 million parts.
pub const MOST_MANIFEST: u64 = 1 << 36;

/// A file of a part: its name below the folder of the dataset, and its content.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PartFile {
    /// The name.
    pub name: String,
    /// The content.
    pub bytes: Vec<u8>,
    /// SHA-256 of the content, in hexadecimal.
    pub sha256: String,
}

impl PartFile {
    /// A file with its checksum.
    pub fn new(name: String, bytes: Vec<u8>) -> Self {
        PartFile { sha256: sha256(&bytes), name, bytes }
    }
}

/// A dataset that parts are added to. One process writes to a manifest ([`super::claim`]).
#[derive(Debug)]
pub struct Folder {
    storage: &'static dyn Storage,
    root: PathBuf,
    identity: Identity,
    /// Name of the manifest that this process appends to.
    manifest: String,
    state: Mutex<State>,
}

#[derive(Debug, Default)]
struct State {
    /// Length of the manifest up to its last whole line, bytes; `None` where it does not exist yet.
    length: Option<u64>,
    /// All parts that are whole, those of other manifests too.
    parts: BTreeMap<u64, PartRecord>,
}

impl Folder {
    /// The dataset in `root`, whose manifest `manifest` (its name below `root`) has so far the records `own`; `others` are the parts of other
    /// manifests. What was damaged in the manifest is left out of its new text.
    ///
    /// # Errors
    /// Where a file operation fails.
    pub fn open(
        storage: &'static dyn Storage,
        root: &Path,
        identity: Identity,
        (manifest, own): (String, Option<Manifest>),
        others: BTreeMap<u64, PartRecord>,
    ) -> Result<Folder, StorageError> {
        let mut folder =
            Folder { storage, root: root.to_owned(), identity, manifest, state: Mutex::new(State::default()) };
        if folder.manifest.starts_with(SHARDS) {
            let path = root.join(SHARDS);
            storage.create_folder(&path).map_err(at(&path))?;
        }
        let path = folder.path(&folder.manifest);
        if own.is_none() {
            refuse_parts(storage, &path)?;
        }
        let (is_new, own) = (own.is_none(), own.unwrap_or_default());
        let text = Manifest::text(&folder.identity, own.parts.values(), false);
        // a manifest with damage, or one that says that it is finished, is written again: what is appended must follow its last part
        if is_new || !own.damaged.is_empty() || own.is_finished || own.identity.as_ref() != Some(&folder.identity) {
            folder.write(&folder.manifest, text.as_bytes())?;
        }
        let length = storage.read(&path, MOST_MANIFEST).map_err(at(&path))?.len() as u64;
        let mut parts = others;
        parts.extend(own.parts);
        folder.state = Mutex::new(State { length: Some(length), parts });
        Ok(folder)
    }

    /// The path of the file `name`.
    pub fn path(&self, name: &str) -> PathBuf {
        self.root.join(name)
    }

    /// The folder.
    pub fn root(&self) -> &Path {
        &self.root
    }

    /// The file operations.
    pub fn storage(&self) -> &'static dyn Storage {
        self.storage
    }

    /// What the rows are.
    pub fn identity(&self) -> &Identity {
        &self.identity
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The parts that are whole, in order.
    pub fn parts(&self) -> Vec<PartRecord> {
        self.state().parts.values().cloned().collect()
    }

    /// Those of `parts` that are not there yet.
    pub fn missing(&self, parts: impl Iterator<Item = Part>) -> Vec<Part> {
        let state = self.state();
        parts.filter(|part| state.parts.get(&part.id.0).is_none_or(|record| record.samples() != *part)).collect()
    }

    /// Writes a whole file, durably; an older file of that name is replaced only when the new one is whole.
    ///
    /// # Errors
    /// Where a file operation fails; the temporary file is removed.
    pub fn write(&self, name: &str, bytes: &[u8]) -> Result<(), StorageError> {
        let path = self.path(name);
        place(self.storage, &path, bytes)?;
        let folder = path.parent().unwrap_or(&self.root);
        self.storage.sync_folder(folder).map_err(at(folder))
    }

    /// Adds a part: its files, then its line in the manifest.
    ///
    /// # Errors
    /// Where a file operation fails; the part is then not listed.
    pub fn commit(&self, part: Part, files: &[PartFile]) -> Result<(), StorageError> {
        let mut folders: Vec<PathBuf> = Vec::new();
        for file in files {
            let path = self.path(&file.name);
            let folder = path.parent().unwrap_or(&self.root).to_owned();
            if !folders.contains(&folder) {
                self.storage.create_folder(&folder).map_err(at(&folder))?;
                folders.push(folder);
            }
            place(self.storage, &path, &file.bytes)?;
        }
        for folder in &folders {
            self.storage.sync_folder(folder).map_err(at(folder))?;
        }
        let records = files.iter().map(|file| FileRecord {
            name: file.name.clone(),
            bytes: file.bytes.len() as u64,
            sha256: file.sha256.clone(),
        });
        let record = PartRecord {
            part: part.id.0,
            first_sample: part.first.0,
            rows: part.count as u64,
            files: records.collect(),
        };
        self.append(&Record::Part(record.clone()))?;
        self.state().parts.insert(record.part, record);
        Ok(())
    }

    /// Takes parts out of the dataset, so that they are made again.
    ///
    /// # Errors
    /// Where a file operation fails.
    pub fn drop_parts(&self, parts: impl IntoIterator<Item = u64>) -> Result<(), StorageError> {
        for dropped in parts {
            self.append(&Record::Dropped { dropped })?;
            self.state().parts.remove(&dropped);
        }
        Ok(())
    }

    fn append(&self, record: &Record) -> Result<(), StorageError> {
        let (path, line) = (self.path(&self.manifest), record.line());
        let mut state = self.state();
        let length = state.length.unwrap_or(0);
        self.storage.append(&path, length, line.as_bytes()).map_err(at(&path))?;
        state.length = Some(length + line.len() as u64);
        Ok(())
    }

    /// Writes the plan.
    ///
    /// # Errors
    /// Where a file operation fails.
    pub fn write_plan(&self, text: &str) -> Result<(), StorageError> {
        self.write(PLAN, text.as_bytes())
    }

    /// Keeps `bytes` as the file of numbers `name` that the plan names, unless it is there.
    ///
    /// # Errors
    /// Where a file operation fails.
    pub fn keep_data(&self, name: &str, bytes: &[u8]) -> Result<(), StorageError> {
        let folder = self.path(DATA);
        let entries = entries_in(self.storage, &self.root, &folder)?;
        if entries.iter().any(|entry| entry.is_file && entry.name == name && entry.size == bytes.len() as u64) {
            return Ok(());
        }
        self.storage.create_folder(&folder).map_err(at(&folder))?;
        self.write(&format!("{DATA}/{name}"), bytes)
    }

    /// Takes back that everything is there, before anything of it is replaced.
    ///
    /// # Errors
    /// Where a file operation fails.
    pub fn unfinish(&self) -> Result<(), StorageError> {
        let path = self.path(SUCCESS);
        self.storage.remove(&path).map_err(at(&path))?;
        self.storage.sync_folder(&self.root).map_err(at(&self.root))
    }

    /// Prepares the folder `name` for files that are made again: without those that an earlier end of the campaign left there.
    ///
    /// # Errors
    /// Where a file operation fails.
    pub fn clear(&self, name: &str) -> Result<PathBuf, StorageError> {
        let path = self.path(name);
        for entry in entries_in(self.storage, &self.root, &path)? {
            if entry.is_file && is_ours(name, &entry.name) {
                let file = path.join(&entry.name);
                self.storage.remove(&file).map_err(at(&file))?;
            }
        }
        self.storage.remove_folder(&path).map_err(at(&path))?;
        Ok(path)
    }

    /// Says that everything is there: the manifest lists all parts in order, whichever manifests listed them before, and the mark is set.
    ///
    /// # Errors
    /// Where a file operation fails.
    pub fn finish(&self) -> Result<(), StorageError> {
        let text = Manifest::text(&self.identity, self.state().parts.values(), true);
        self.write(MANIFEST, text.as_bytes())?;
        self.state().length = None;
        let shards = self.path(SHARDS);
        for entry in entries_in(self.storage, &self.root, &shards)? {
            let path = shards.join(entry.name);
            self.storage.remove(&path).map_err(at(&path))?;
        }
        self.storage.remove_folder(&shards).map_err(at(&shards))?;
        self.write(SUCCESS, b"")
    }

    /// Total size of the files of parts, bytes.
    pub fn size(&self) -> u64 {
        self.state().parts.values().flat_map(|part| &part.files).map(|file| file.bytes).sum()
    }
}

/// Refuses to write a new manifest where there is one that lists parts: its folder did not show it, and they would be lost.
fn refuse_parts(storage: &dyn Storage, path: &Path) -> Result<(), StorageError> {
    let parts = match storage.read(path, MOST_MANIFEST) {
        Ok(bytes) => Manifest::of(&bytes).parts.len(),
        Err(error) if error.kind() == std::io::ErrorKind::NotFound || is_unfit(&error) => 0,
        Err(error) => return Err(at(path)(error)),
    };
    if parts == 0 {
        return Ok(());
    }
    let why = format!("it lists {parts} parts, and its folder did not show it; run the command again");
    Err(at(path)(std::io::Error::other(why)))
}

/// Writes a file of a dataset under a temporary name, checks it, and renames it.
///
/// # Errors
/// Where a file operation fails; the temporary file is removed.
pub fn place(storage: &dyn Storage, path: &Path, bytes: &[u8]) -> Result<(), StorageError> {
    let mut temporary = path.as_os_str().to_owned();
    temporary.push(UNFINISHED);
    let temporary = PathBuf::from(temporary);
    let write = || {
        // what an earlier process left, or a link that somebody put there, is removed and not written to
        storage.remove(&temporary).map_err(at(&temporary))?;
        storage.create(&temporary, bytes).map_err(at(&temporary))?;
        if !storage.has(&temporary, bytes).map_err(at(&temporary))? {
            let differs = std::io::Error::other("what was read back is not what was written");
            return Err(at(&temporary)(differs));
        }
        Ok(())
    };
    // after a failed flush the state of the file is unknown: it is written again, once
    let placed = write().or_else(|_| write()).and_then(|()| storage.rename(&temporary, path).map_err(at(path)));
    if placed.is_err() {
        // the first error is reported; a file that cannot be removed is recognised by its name
        let _ = storage.remove(&temporary);
    }
    placed
}
