//! [`Remote`]: a result in an object store: the files of its folder under their names, and what says which of them are
//! whole.
//!
//! ```text
//! s3://bucket/x/_commits/plan.jsonl          rows and plan: who puts it first decides whose rows these are
//! s3://bucket/x/runs/part-000000.parquet     rows, as in the folder
//! s3://bucket/x/_commits/part-000000.jsonl   the line of the manifest that lists this part: its files are there
//! s3://bucket/x/summary.json, ...            what follows from the rows
//! s3://bucket/x/manifest.jsonl               everything, with its SHA-256
//! s3://bucket/x/_SUCCESS                     everything is there
//! ```
//! They are put in this order, each on the condition that there is none of its name (`If-None-Match: *`), so that
//! nothing is ever replaced. Whoever makes the same rows puts the same objects: one that is there already is compared,
//! and the same content is as good as one's own. Whatever stops a process, what its objects list is there.

use std::collections::{BTreeMap, BTreeSet};
use std::io;
use std::path::Path;
use std::sync::{Mutex, MutexGuard, OnceLock, PoisonError};

use super::address::{Address, Objects};
use super::connection::connect;
use crate::campaign::Plan;
use crate::storage::disk::{Storage, StorageError, above, at, entries_in, new_folder};
use crate::storage::folder::{Folder, MOST_MANIFEST, PartFile, begin, unmark};
use crate::storage::folder_error::all_differences;
use crate::storage::found::{FolderContents, contents};
use crate::storage::identity::sha256;
use crate::storage::manifest::{FileRecord, Identity, Manifest, PartRecord, Record};
use crate::storage::names::{DATA, MANIFEST, PART_BANDS, RUNS, SHARDS, SUCCESS, is_ours};
use crate::storage::whole_file::place;

/// Folder of the objects that say what is there.
const COMMITS: &str = "_commits";
/// The object that says whose rows these are.
const HEAD: &str = "_commits/plan.jsonl";

/// The name of the object that says that `part` is there.
fn commit_of(part: u64) -> String {
    format!("{COMMITS}/part-{part:06}.jsonl")
}

/// The part whose commit has this name.
fn committed_by(name: &str) -> Option<u64> {
    name.strip_prefix(COMMITS)?.strip_prefix("/part-")?.strip_suffix(".jsonl")?.parse().ok()
}

/// The first object of a result of `plan`, whose rows are `identity`.
pub fn head_of(plan: &str, identity: &Identity) -> String {
    Manifest::text(identity, plan, std::iter::empty(), None)
}

/// A result in an object store.
pub struct Remote {
    address: Address,
    client: Box<dyn Objects>,
    /// The first object, where there is one.
    head: OnceLock<Vec<u8>>,
    /// Commits that are there with the files of their parts, and whether their content is known to be that of this
    /// process.
    commits: Mutex<BTreeMap<String, bool>>,
}

/// An object that is not what was put.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// Its name below the address.
    pub object: String,
    /// Whether it is missing.
    pub is_absent: bool,
}

impl Remote {
    /// What is at `address`, of which nothing has to be there.
    ///
    /// # Errors
    /// Where the store does not answer, or refuses.
    pub fn open(address: Address) -> Result<Remote, StorageError> {
        let none = || io::Error::other("this build of spindrift has no object stores");
        let connected = connect().ok_or_else(none).and_then(|connect| connect(&address, HEAD));
        let (client, head) = connected.map_err(at(Path::new(&address.to_string())))?;
        Ok(Remote { address, client, head: head.map_or_else(OnceLock::new, OnceLock::from), commits: Mutex::default() })
    }

    pub fn address(&self) -> &Address {
        &self.address
    }

    /// What its rows are, and the text of its plan.
    ///
    /// # Errors
    /// Where there is no result, or the first object is damaged.
    pub fn origin(&self) -> Result<(Identity, String), StorageError> {
        let Some(head) = self.head.get() else {
            let nothing = "there is no result of spindrift";
            return Err(at(Path::new(&self.address.to_string()))(io::Error::new(io::ErrorKind::NotFound, nothing)));
        };
        let Manifest { identity, plan, .. } = Manifest::of(head);
        identity.zip(plan).ok_or_else(|| self.damaged(HEAD))
    }

    /// Whether nothing is there, so that these can be the rows of `plan`, whose identity is `identity`; no where they
    /// are.
    ///
    /// # Errors
    /// Where there are those of another plan, with the keys that differ.
    pub fn is_new(&self, plan: &Plan, identity: &Identity) -> Result<bool, StorageError> {
        self.head.get().map_or(Ok(true), |there| self.compare(there, plan, identity).map(|()| false))
    }

    /// Makes these the rows of `plan`, whose identity is `identity`.
    ///
    /// # Errors
    /// Where another process has made them those of another plan, or a request fails.
    pub fn begin(&self, plan: &Plan, identity: &Identity) -> Result<(), StorageError> {
        let text = head_of(&plan.text(), identity);
        let there = self.client.create(HEAD, text.as_bytes()).map_err(self.at(HEAD))?;
        there.map_or(Ok(()), |there| self.compare(&there, plan, identity))?;
        self.head.get_or_init(|| text.into_bytes());
        Ok(())
    }

    /// Refuses the first object `there` where its rows are not those of `plan`.
    fn compare(&self, there: &[u8], plan: &Plan, identity: &Identity) -> Result<(), StorageError> {
        if there == head_of(&plan.text(), identity).as_bytes() {
            return Ok(());
        }
        let Manifest { identity: Some(rows), plan: Some(text), .. } = Manifest::of(there) else {
            return Err(self.damaged(HEAD));
        };
        let why = format!(
            "is the result of another plan:\n  {}\nchoose another --out; what is in a store is not replaced",
            all_differences((&text, &rows), (plan, identity))
        );
        Err(at(Path::new(&self.address.to_string()))(io::Error::other(why)))
    }

    /// Whether everything is there.
    ///
    /// # Errors
    /// Where a request fails.
    pub fn is_whole(&self) -> Result<bool, StorageError> {
        Ok(self.client.get(SUCCESS).map_err(self.at(SUCCESS))?.is_some())
    }

    /// Puts the part that `part` lists, whose files are in `root`: they first, then its commit.
    ///
    /// # Errors
    /// Where another content is there, a file in `root` is not what was written, or a request fails.
    pub fn put_part(&self, storage: &dyn Storage, root: &Path, part: &PartRecord) -> Result<(), StorageError> {
        let (name, line) = (commit_of(part.part), Record::Part(part.clone()).line());
        let known = self.commits().get(&name).copied();
        let is_there = known == Some(true)
            || known.is_some() && self.client.get(&name).map_err(self.at(&name))?.as_deref() == Some(line.as_bytes());
        if !is_there {
            part.files.iter().try_for_each(|file| self.put_file(storage, root, file))?;
            self.put(&name, line.as_bytes())?;
        }
        self.commits().insert(name, true);
        Ok(())
    }

    /// Puts the file of the folder `root` that `file` lists.
    ///
    /// # Errors
    /// As [`Remote::put_part`].
    pub fn put_file(&self, storage: &dyn Storage, root: &Path, file: &FileRecord) -> Result<(), StorageError> {
        let path = root.join(&file.name);
        let bytes = storage.read(&path, file.bytes).map_err(at(&path))?;
        if sha256(&bytes) != file.sha256 {
            return Err(at(&path)(io::Error::other("its content has changed; the same command makes it again")));
        }
        self.put(&file.name, &bytes)
    }

    /// Puts everything of the finished result in `root` that is not there yet, last what says so.
    ///
    /// # Errors
    /// As [`Remote::put_part`].
    pub fn publish(&self, storage: &dyn Storage, root: &Path) -> Result<(), StorageError> {
        let path = root.join(MANIFEST);
        let bytes = storage.read(&path, MOST_MANIFEST).map_err(at(&path))?;
        let manifest = Manifest::of(&bytes);
        manifest.parts.values().try_for_each(|part| self.put_part(storage, root, part))?;
        manifest.derived.iter().try_for_each(|file| self.put_file(storage, root, file))?;
        self.put(MANIFEST, &bytes)?;
        self.put(SUCCESS, b"")
    }

    /// Adds those of the parts that are there to `folder` which it has not and which `is_mine` says; the number of
    /// their rows. A part of which an object is missing is left out.
    ///
    /// # Errors
    /// Where an object is not what was put, or a request or a file operation fails.
    pub fn pull(&self, folder: &Folder, is_mine: &dyn Fn(u64) -> bool) -> Result<u64, StorageError> {
        let here: BTreeMap<u64, PartRecord> = folder.parts().into_iter().map(|part| (part.part, part)).collect();
        let list = |name: &str| self.client.list(name).map_err(self.at(name));
        let there: BTreeSet<String> = [list(RUNS)?, list(PART_BANDS)?].into_iter().flatten().collect();
        let mut rows = 0;
        for name in list(COMMITS)? {
            let Some(number) = committed_by(&name).filter(|number| is_mine(*number)) else { continue };
            let part = match here.get(&number) {
                Some(part) => part.clone(),
                None => self.listed(&name, number)?,
            };
            if !part.files.iter().all(|file| there.contains(&file.name)) {
                continue;
            }
            if !here.contains_key(&number) {
                let content =
                    |file: &FileRecord| self.content(file).map(|bytes| PartFile::new(file.name.clone(), bytes));
                let files: Vec<PartFile> = part.files.iter().map(content).collect::<Result<_, _>>()?;
                folder.commit(part.samples(), &files)?;
                rows += part.rows;
            }
            self.commits().insert(name, !here.contains_key(&number));
        }
        Ok(rows)
    }

    /// The part that the commit `name` lists.
    fn listed(&self, name: &str, number: u64) -> Result<PartRecord, StorageError> {
        let line = self.client.get(name).map_err(self.at(name))?;
        let Manifest { mut parts, damaged, .. } = Manifest::of(&line.unwrap_or_default());
        parts.remove(&number).filter(|_| parts.is_empty() && damaged.is_empty()).ok_or_else(|| self.damaged(name))
    }

    /// The content of `file`.
    fn content(&self, file: &FileRecord) -> Result<Vec<u8>, StorageError> {
        let bytes = self.client.get(&file.name).map_err(self.at(&file.name))?;
        bytes.filter(|bytes| sha256(bytes) == file.sha256).ok_or_else(|| self.damaged(&file.name))
    }

    /// Begins a folder for the rows that are there in `root`, unless it has begun, with the files of numbers that their
    /// plan names: it is then an unfinished result.
    ///
    /// # Errors
    /// Where there is no result, an object is damaged, or a request or a file operation fails.
    pub fn unpack(&self, storage: &dyn Storage, root: &Path) -> Result<(), StorageError> {
        self.begin_folder(storage, root)?;
        for name in self.client.list(DATA).map_err(self.at(DATA))? {
            let file = name.rsplit('/').next().unwrap_or(&name);
            if is_ours(DATA, file) && !root.join(&name).exists() {
                let sha256 = file.split('.').next().unwrap_or_default().to_owned();
                let bytes = self.content(&FileRecord { name: name.clone(), bytes: 0, sha256 })?;
                keep(storage, root, &name, &bytes)?;
            }
        }
        Ok(())
    }

    /// Makes `root` the folder of these rows, unless it is.
    fn begin_folder(&self, storage: &dyn Storage, root: &Path) -> Result<(), StorageError> {
        let (identity, plan) = self.origin()?;
        if !root.join(MANIFEST).exists() {
            begin(storage, root, (&plan, &identity), MANIFEST)?;
        }
        Ok(())
    }

    /// Makes the folder `root` a copy of the whole result that is there; what is wrong with its objects, where they are
    /// not what the manifest lists. All are got and compared where the folder is to be made `afresh`, else those that
    /// it has not.
    ///
    /// # Errors
    /// Where a request or a file operation fails.
    pub fn copy_to(&self, storage: &dyn Storage, root: &Path, afresh: bool) -> Result<Vec<Fault>, StorageError> {
        self.begin_folder(storage, root)?;
        let get = |name: &str| self.client.get(name).map_err(self.at(name));
        let fault =
            |object: &str, there: Option<Vec<u8>>| Fault { object: object.to_owned(), is_absent: there.is_none() };
        let text = get(MANIFEST)?;
        let manifest = Manifest::of(text.as_deref().unwrap_or_default());
        let is_its_own = manifest.identity.clone().zip(manifest.plan.clone()) == Some(self.origin()?);
        let Some(text) = text.clone().filter(|_| manifest.is_finished && is_its_own) else {
            return Ok(vec![fault(MANIFEST, text)]);
        };
        let path = root.join(MANIFEST);
        if !storage.has(&path, &text).map_err(at(&path))? {
            unmark(storage, root)?;
        }
        let mut faults = Vec::new();
        for part in manifest.parts.values().filter(|_| afresh) {
            let (name, line) = (commit_of(part.part), Record::Part(part.clone()).line());
            let there = get(&name)?;
            if there.as_deref() != Some(line.as_bytes()) {
                faults.push(fault(&name, there));
            }
        }
        for file in manifest.parts.values().flat_map(|part| &part.files).chain(&manifest.derived) {
            let is_here =
                storage.read(&root.join(&file.name), file.bytes).is_ok_and(|bytes| sha256(&bytes) == file.sha256);
            if is_here && !afresh {
                continue;
            }
            match get(&file.name)? {
                Some(bytes) if sha256(&bytes) == file.sha256 && is_here => {}
                Some(bytes) if sha256(&bytes) == file.sha256 => keep(storage, root, &file.name, &bytes)?,
                there => faults.push(fault(&file.name, there)),
            }
        }
        if faults.is_empty() {
            // manifests of shards, and what an earlier end has left in the folder
            let shards = entries_in(storage, root, &root.join(SHARDS))?.into_iter().filter(|entry| entry.is_file);
            let mut rest: Vec<String> = shards.map(|entry| format!("{SHARDS}/{}", entry.name)).collect();
            keep(storage, root, MANIFEST, &text)?;
            keep(storage, root, SUCCESS, b"")?;
            if let FolderContents::Dataset(found) = contents(storage, root)? {
                rest.extend(found.unlisted);
            }
            for path in rest.iter().map(|name| root.join(name)) {
                storage.remove(&path).map_err(at(&path))?;
            }
        }
        Ok(faults)
    }

    /// Puts the object `name`, unless it is there with this content.
    ///
    /// # Errors
    /// Where another content is there, or a request fails.
    pub fn put(&self, name: &str, bytes: &[u8]) -> Result<(), StorageError> {
        let Some(there) = self.client.create(name, bytes).map_err(self.at(name))? else { return Ok(()) };
        Err(self.at(name)(io::Error::other(format!(
            "has another content (SHA-256 {}) than this process has for it (SHA-256 {}), and what is in a store is not \
            replaced: choose another --out; or, if that object is damaged, remove it, and the same command puts it \
            again",
            sha256(&there),
            sha256(bytes)
        ))))
    }

    /// Adds the object to an error.
    fn at(&self, object: &str) -> impl FnOnce(io::Error) -> StorageError + use<> {
        at(Path::new(&format!("{}/{object}", self.address)))
    }

    fn damaged(&self, object: &str) -> StorageError {
        self.at(object)(io::Error::other("is not what was put; remove it, and the campaign's command puts it again"))
    }

    fn commits(&self) -> MutexGuard<'_, BTreeMap<String, bool>> {
        self.commits.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Writes the file `name` of the folder `root`, durably.
fn keep(storage: &dyn Storage, root: &Path, name: &str, bytes: &[u8]) -> Result<(), StorageError> {
    let path = root.join(name);
    new_folder(storage, above(&path))?;
    place(storage, &path, bytes)?;
    storage.sync_folder(above(&path)).map_err(at(above(&path)))
}
