//! [`Folder`]: a dataset on the disk, and the protocol by which parts are added to it.
//!
//! ```text
//! results/<name>/plan.toml                 the resolved plan
//! results/<name>/manifest.jsonl            what is there: only what it lists exists
//! results/<name>/runs/part-000000.parquet  rows, part by part
//! results/<name>/summary.json, ...          what follows from the rows
//! results/<name>/_SUCCESS                  everything is there
//! ```
//! A part is written under a temporary name, flushed to the disk, read back and compared, and renamed; its folder is
//! flushed; then one line of the manifest lists it. Whatever stops the program, the parts that are listed are whole,
//! and the others are made again.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use crate::ensemble::Part;
use crate::storage::disk::{Storage, StorageError, above, at, entries_in, new_folder, no_link};
use crate::storage::identity::sha256;
use crate::storage::manifest::{FileRecord, Identity, Manifest, PartRecord, Record};
use crate::storage::names::{DATA, MANIFEST, PLAN, SHARDS, SUCCESS, SUMMARY, is_derived, is_ours};
use crate::storage::stored_file::is_unfit;
use crate::storage::whole_file::{place, place_new};

/// Most bytes of a manifest: a line is some 400 bytes, and a campaign of 10^12 samples has 61 million parts.
pub const MOST_MANIFEST: u64 = 1 << 36;

/// Most bytes of a summary that is read.
pub const MOST_SUMMARY: u64 = 1 << 26;
/// The key of a summary that says whether it is of the rows that are there.
pub const IS_FINISHED: &str = "finished";

/// A file of a part: its name below the folder of the dataset, and its content.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PartFile {
    pub name: String,
    pub bytes: Vec<u8>,
    /// SHA-256 of the content, in hexadecimal.
    pub sha256: String,
}

impl PartFile {
    /// A file with its checksum.
    pub fn new(name: String, bytes: Vec<u8>) -> Self {
        PartFile { sha256: sha256(&bytes), name, bytes }
    }

    /// What a manifest says of it.
    pub fn record(&self) -> FileRecord {
        FileRecord { name: self.name.clone(), bytes: self.bytes.len() as u64, sha256: self.sha256.clone() }
    }
}

impl FileRecord {
    /// That of the file `name` with the content `bytes`.
    pub fn of(name: &str, bytes: &[u8]) -> Self {
        FileRecord { name: name.to_owned(), bytes: bytes.len() as u64, sha256: sha256(bytes) }
    }
}

/// A dataset that parts are added to. One process writes to a manifest ([`super::claim`]).
#[derive(Debug)]
pub struct Folder {
    storage: &'static dyn Storage,
    root: PathBuf,
    identity: Identity,
    /// The text of the plan.
    plan: String,
    /// Name of the manifest that this process appends to.
    manifest: String,
    state: Mutex<FolderState>,
}

#[derive(Debug, Default)]
struct FolderState {
    /// Length of the manifest up to its last whole line, bytes; `None` where it does not exist yet.
    length: Option<u64>,
    /// All parts that are whole, those of other manifests too.
    parts: BTreeMap<u64, PartRecord>,
    /// The files that follow from plan and rows and are there, by name.
    derived: BTreeMap<String, FileRecord>,
}

impl Folder {
    /// The dataset in `root` of the plan with this text, whose manifest `manifest` (its name below `root`) has so far
    /// the records `own`; `others` are the parts of other manifests. What was damaged in the manifest is left out of
    /// its new text.
    ///
    /// # Errors
    /// Where a file operation fails.
    pub fn open(
        storage: &'static dyn Storage,
        root: &Path,
        (plan, identity): (String, Identity),
        (manifest, own): (String, Option<Manifest>),
        others: BTreeMap<u64, PartRecord>,
    ) -> Result<Folder, StorageError> {
        let state = Mutex::new(FolderState::default());
        let mut folder = Folder { storage, root: root.to_owned(), identity, plan, manifest, state };
        let what = (folder.plan.as_str(), &folder.identity);
        let own = own.map_or_else(|| begin(storage, root, what, &folder.manifest), Ok)?;
        let text = Manifest::text(&folder.identity, &folder.plan, own.parts.values(), None);
        // a manifest with damage, or one that says that it is finished, is written again: what is appended must follow
        // its last part
        let is_same = own.identity.as_ref() == Some(&folder.identity) && own.plan.as_ref() == Some(&folder.plan);
        if !own.damaged.is_empty() || own.is_finished || !is_same {
            folder.write(&folder.manifest, text.as_bytes())?;
        }
        let path = folder.path(&folder.manifest);
        let length = storage.read(&path, MOST_MANIFEST).map_err(at(&path))?.len() as u64;
        let mut parts = others;
        parts.extend(own.parts);
        folder.state = Mutex::new(FolderState { length: Some(length), parts, derived: BTreeMap::new() });
        Ok(folder)
    }

    /// The path of the file `name`.
    pub fn path(&self, name: &str) -> PathBuf {
        self.root.join(name)
    }

    pub fn root(&self) -> &Path {
        &self.root
    }

    pub fn storage(&self) -> &'static dyn Storage {
        self.storage
    }

    /// The text of the plan.
    pub fn plan(&self) -> &str {
        &self.plan
    }

    pub fn identity(&self) -> &Identity {
        &self.identity
    }

    /// The path of the file `name`, which is about to change: it is in this folder, and not through a link in another
    /// one.
    fn own(&self, name: &str) -> Result<PathBuf, StorageError> {
        let path = self.path(name);
        for folder in [&*self.root, above(&path)] {
            no_link(folder).map_err(at(folder))?;
        }
        Ok(path)
    }

    /// The folder `name` in this one, new or not.
    fn inner(&self, name: &str) -> Result<PathBuf, StorageError> {
        let path = self.own(name)?;
        new_folder(self.storage, &path)?;
        Ok(path)
    }

    fn state(&self) -> MutexGuard<'_, FolderState> {
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
        let path = self.own(name)?;
        place(self.storage, &path, bytes)?;
        let folder = above(&path);
        self.storage.sync_folder(folder).map_err(at(folder))?;
        if is_derived(name) {
            self.list(FileRecord::of(name, bytes));
        }
        Ok(())
    }

    /// Lists a file that follows from plan and rows and is there with this content, for the last line of the manifest.
    pub fn list(&self, file: FileRecord) {
        self.state().derived.insert(file.name.clone(), file);
    }

    /// Removes a file that follows from the rows, if there is one.
    ///
    /// # Errors
    /// Where a file operation fails.
    pub fn remove(&self, name: &str) -> Result<(), StorageError> {
        let path = self.own(name)?;
        self.state().derived.remove(name);
        self.storage.remove(&path).map_err(at(&path))
    }

    /// Adds a part: its files, then its line in the manifest, which is returned.
    ///
    /// # Errors
    /// Where a file operation fails; the part is then not listed.
    pub fn commit(&self, part: Part, files: &[PartFile]) -> Result<PartRecord, StorageError> {
        let mut folders: Vec<PathBuf> = Vec::new();
        for file in files {
            let (folder, _) = file.name.split_once('/').unwrap_or_default();
            let folder = self.inner(folder)?;
            place(self.storage, &self.own(&file.name)?, &file.bytes)?;
            if !folders.contains(&folder) {
                folders.push(folder);
            }
        }
        for folder in &folders {
            self.storage.sync_folder(folder).map_err(at(folder))?;
        }
        let record = PartRecord {
            part: part.id.0,
            first_sample: part.first.0,
            rows: part.count as u64,
            files: files.iter().map(PartFile::record).collect(),
        };
        self.append(&Record::Part(record.clone()))?;
        self.state().parts.insert(record.part, record.clone());
        Ok(record)
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
        let (path, line) = (self.own(&self.manifest)?, record.line());
        let mut state = self.state();
        let length = state.length.unwrap_or(0);
        self.storage.append(&path, length, line.as_bytes()).map_err(at(&path))?;
        state.length = Some(length + line.len() as u64);
        Ok(())
    }

    /// Writes the plan, unless `is_there` with this text.
    ///
    /// # Errors
    /// Where a file operation fails.
    pub fn write_plan(&self, is_there: bool) -> Result<(), StorageError> {
        if is_there {
            self.list(FileRecord::of(PLAN, self.plan.as_bytes()));
            return Ok(());
        }
        self.write(PLAN, self.plan.as_bytes())
    }

    /// Keeps `bytes` as the file of numbers `name` that the plan names, unless it is there.
    ///
    /// # Errors
    /// Where a file operation fails.
    pub fn keep_data(&self, name: &str, bytes: &[u8]) -> Result<(), StorageError> {
        let folder = self.inner(DATA)?;
        let entries = entries_in(self.storage, &self.root, &folder)?;
        let (file, path) = (format!("{DATA}/{name}"), folder.join(name));
        let is_there = entries.iter().any(|entry| entry.is_file && entry.name == name);
        if is_there && self.storage.has(&path, bytes).map_err(at(&path))? {
            self.list(FileRecord::of(&file, bytes));
            return Ok(());
        }
        self.write(&file, bytes)
    }

    /// Takes back that everything is there, before anything of it is replaced: the summary, if there is one, then says
    /// that it is of rows before.
    ///
    /// # Errors
    /// Where a file operation fails.
    pub fn unfinish(&self) -> Result<(), StorageError> {
        unmark(self.storage, &self.root)?;
        let top = entries_in(self.storage, &self.root, &self.root)?;
        if !top.iter().any(|entry| entry.is_file && entry.name == SUMMARY) {
            return Ok(());
        }
        let path = self.path(SUMMARY);
        let summary = match self.storage.read(&path, MOST_SUMMARY) {
            Ok(bytes) => unfinished_summary(&bytes),
            Err(error) if is_unfit(&error) => None,
            Err(error) => return Err(at(&path)(error)),
        };
        let Some(text) = summary else { return Ok(()) };
        place(self.storage, &path, text.as_bytes())?;
        self.storage.sync_folder(&self.root).map_err(at(&self.root))
    }

    /// Prepares the folder `name` for files that are made again: without those that an earlier end of the campaign left
    /// there.
    ///
    /// # Errors
    /// Where a file operation fails.
    pub fn clear(&self, name: &str) -> Result<PathBuf, StorageError> {
        let path = self.own(name)?;
        for entry in entries_in(self.storage, &self.root, &path)? {
            if entry.is_file && is_ours(name, &entry.name) {
                let file = self.own(&format!("{name}/{}", entry.name))?;
                self.storage.remove(&file).map_err(at(&file))?;
            }
        }
        // what is not ours stays
        if entries_in(self.storage, &self.root, &path)?.is_empty() {
            self.storage.remove_folder(&path).map_err(at(&path))?;
        }
        self.state().derived.retain(|file, _| !file.starts_with(&format!("{name}/")));
        Ok(path)
    }

    /// Says that everything is there: the manifest lists all parts in order, whichever manifests listed them before,
    /// and what follows from them; and the mark is set.
    ///
    /// # Errors
    /// Where a file operation fails.
    pub fn finish(&self) -> Result<(), StorageError> {
        let text = {
            let state = self.state();
            let derived = state.derived.values().cloned().collect();
            Manifest::text(&self.identity, &self.plan, state.parts.values(), Some(derived))
        };
        self.write(MANIFEST, text.as_bytes())?;
        self.state().length = None;
        self.clear(SHARDS)?;
        self.write(SUCCESS, b"")
    }

    /// Total size of the files of parts, bytes.
    pub fn size(&self) -> u64 {
        self.state().parts.values().flat_map(|part| &part.files).map(|file| file.bytes).sum()
    }
}

/// Takes the mark away that says that everything of the dataset in `root` is there.
///
/// # Errors
/// Where a file operation fails.
pub fn unmark(storage: &dyn Storage, root: &Path) -> Result<(), StorageError> {
    no_link(root).map_err(at(root))?;
    let path = root.join(SUCCESS);
    storage.remove(&path).map_err(at(&path))?;
    storage.sync_folder(root).map_err(at(root))
}

/// Writes the manifest of the finished dataset in `root`, whose plan has the text `plan`, after one file that follows
/// from the rows was made again.
///
/// # Errors
/// Where a file operation fails.
pub fn relist(
    storage: &dyn Storage,
    root: &Path,
    (manifest, plan): (&Manifest, &str),
    file: FileRecord,
) -> Result<(), StorageError> {
    let Some(identity) = &manifest.identity else { return Ok(()) };
    let mut derived: BTreeMap<&str, &FileRecord> =
        manifest.derived.iter().map(|one| (one.name.as_str(), one)).collect();
    derived.insert(&file.name, &file);
    let derived = derived.into_values().cloned().collect();
    let path = root.join(MANIFEST);
    place(storage, &path, Manifest::text(identity, plan, manifest.parts.values(), Some(derived)).as_bytes())?;
    storage.sync_folder(root).map_err(at(root))
}

/// A summary that says that it is finished, as one that does not; `None` where it says nothing.
fn unfinished_summary(bytes: &[u8]) -> Option<String> {
    let mut summary: serde_json::Value = serde_json::from_slice(bytes).ok()?;
    let finished = summary.get_mut(IS_FINISHED).filter(|finished| **finished == true)?;
    *finished = false.into();
    Some(format!("{summary:#}\n"))
}

/// The manifest `name` of the dataset in `root`, where no manifest of this name was found: a new one with the identity
/// of the rows. Of several processes that begin at the same time, one makes it, with locks and without; what it says is
/// read by all.
///
/// # Errors
/// Where a file operation fails; where there is one that lists parts of these rows: its folder did not show it.
pub fn begin(
    storage: &dyn Storage,
    root: &Path,
    (plan, identity): (&str, &Identity),
    name: &str,
) -> Result<Manifest, StorageError> {
    let path = root.join(name);
    let folder = above(&path);
    new_folder(storage, folder)?;
    place_new(storage, &path, Manifest::text(identity, plan, std::iter::empty(), None).as_bytes())?;
    storage.sync_folder(folder).map_err(at(folder))?;
    let manifest = Manifest::of(&storage.read(&path, MOST_MANIFEST).map_err(at(&path))?);
    let is_another = manifest.identity.as_ref().is_some_and(|there| there != identity);
    if manifest.parts.is_empty() || is_another {
        return Ok(manifest);
    }
    let why = "it lists parts, and its folder did not show it; run the command again";
    Err(at(&path)(std::io::Error::other(why)))
}
