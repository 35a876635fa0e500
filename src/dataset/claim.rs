//! [`claim`]: what is in the folder of a result, and whether a campaign may write there.

use std::collections::{BTreeMap, BTreeSet};
use std::fs::{File, TryLockError};
use std::path::{Path, PathBuf};

use thiserror::Error;

use crate::campaign::Plan;
use crate::campaign::difference::{KeyDifference, text_differences};
use crate::dataset::folder::{Folder, MOST_MANIFEST};
use crate::dataset::manifest::{Identity, Manifest, PartRecord};
use crate::dataset::names::{
    FOLDERS, MANIFEST, PART_BANDS, PLAN, REPORT, RUNS, SHARDS, SUCCESS, SUMMARY, UNFINISHED, is_ours, manifest_of,
};
use crate::dataset::stopping::targets;
use crate::dataset::storage::{Storage, StorageError, at};
use crate::dataset::table_log;

/// Most bytes of a plan that is read.
const MOST_PLAN: u64 = 1 << 28;
/// Most keys that a refusal lists.
const LISTED: usize = 12;

/// Why a folder cannot take a result.
#[derive(Debug, Error)]
pub enum FolderError {
    /// It has the rows of another plan.
    #[error(
        "`{folder}` contains {what} of another plan:\n  {differences}\nchoose another --out, or replace it with --overwrite"
    )]
    Occupied {
        /// The folder.
        folder: String,
        /// A result, or an unfinished one.
        what: &'static str,
        /// The keys that differ, a line each.
        differences: String,
    },
    /// It has more rows than the plan.
    #[error(
        "`{folder}` contains {found} rows of this plan, more than its {asked} samples; leave --samples out, choose another --out, or replace it with --overwrite"
    )]
    Larger {
        /// The folder.
        folder: String,
        /// Rows that are there.
        found: u64,
        /// Samples of the plan.
        asked: u64,
    },
    /// It has something else.
    #[error(
        "`{folder}` contains `{entry}`, which is not part of a result of spindrift; move it away, or choose another --out"
    )]
    Foreign {
        /// The folder.
        folder: String,
        /// What it has.
        entry: String,
    },
    /// Another process writes to it.
    #[error("another process is writing to `{folder}`{owner}; wait for it, or choose another --out")]
    Busy {
        /// The folder.
        folder: String,
        /// Who it is, where that is known.
        owner: String,
    },
    /// There is no result in it.
    #[error("`{folder}` has no result of spindrift: {why}")]
    Nothing {
        /// The folder.
        folder: String,
        /// What is missing.
        why: String,
    },
    /// A file operation failed.
    #[error(transparent)]
    Storage(#[from] StorageError),
}

/// One of several processes that make the parts of a campaign.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    /// Its number, from 1.
    pub number: u64,
    /// How many there are.
    pub of: u64,
}

/// What a folder of results has in it.
#[derive(Debug)]
pub enum Contents {
    /// Nothing, or only what a campaign left that was stopped before it wrote its manifest.
    Blank,
    /// A dataset.
    Dataset(Box<Found>),
    /// Something that is no dataset: the first entry.
    Foreign(String),
}

/// A dataset as it was found.
#[derive(Debug, Default)]
pub struct Found {
    /// The text of its plan; empty where it cannot be read.
    pub plan: String,
    /// What its rows are; `None` where no manifest says.
    pub identity: Option<Identity>,
    /// The records of its manifests by their names.
    pub manifests: BTreeMap<String, Manifest>,
    /// Whether everything is there.
    pub is_finished: bool,
    /// Whether it has a page.
    pub has_page: bool,
    /// The first file that is not one of a dataset, or that no manifest lists although everything is there.
    pub foreign: Option<String>,
}

impl Found {
    /// All parts that are listed, by number.
    pub fn parts(&self) -> BTreeMap<u64, PartRecord> {
        self.manifests.values().flat_map(|manifest| manifest.parts.clone()).collect()
    }

    /// The files of rows of the dataset in `root`, in the order of their samples.
    pub fn row_files(&self, root: &Path) -> Vec<PathBuf> {
        let files = self.parts().into_values().flat_map(|part| part.files.into_iter().take(1));
        files.map(|file| root.join(file.name)).collect()
    }

    /// The names of all files that are listed.
    fn listed(&self) -> BTreeSet<String> {
        let parts = self.manifests.values().flat_map(|manifest| manifest.parts.values());
        parts.flat_map(|part| &part.files).map(|file| file.name.clone()).collect()
    }

    /// Number of rows.
    pub fn rows(&self) -> u64 {
        self.parts().values().map(|part| part.rows).sum()
    }

    /// Number of samples up to the last one of a part that is listed. Parts are not made in order: it may be more than the rows.
    fn extent(&self) -> u64 {
        self.parts().values().map(|part| part.first_sample.saturating_add(part.rows)).max().unwrap_or(0)
    }

    /// The damaged lines of the manifests, each with its file.
    pub fn damaged_lines(&self) -> Vec<String> {
        let lines = |(name, manifest): (&String, &Manifest)| -> Vec<String> {
            manifest.damaged.iter().map(|line| format!("{name}:{line}")).collect()
        };
        self.manifests.iter().flat_map(lines).collect()
    }
}

/// What is in `root`.
///
/// # Errors
/// Where a file operation fails.
pub fn contents(storage: &dyn Storage, root: &Path) -> Result<Contents, StorageError> {
    let top = storage.list(root).map_err(at(root))?;
    let mut found = Found::default();
    let mut names: Vec<String> =
        top.iter().filter(|entry| entry.is_file && entry.name == MANIFEST).map(|_| MANIFEST.to_owned()).collect();
    let mut first_foreign = None;
    let mut files = Vec::new();
    for entry in &top {
        if entry.is_folder && FOLDERS.contains(&entry.name.as_str()) {
            let folder = root.join(&entry.name);
            for inner in storage.list(&folder).map_err(at(&folder))? {
                let name = format!("{}/{}", entry.name, inner.name);
                if !(inner.is_file && is_ours(&entry.name, &inner.name)) {
                    first_foreign.get_or_insert(name);
                } else if entry.name == SHARDS && !inner.name.ends_with(UNFINISHED) {
                    names.push(name);
                } else {
                    files.push(name);
                }
            }
        } else if !(entry.is_file && is_ours("", &entry.name)) {
            first_foreign.get_or_insert(entry.name.clone());
        }
    }
    for name in names {
        let path = root.join(&name);
        let manifest = Manifest::of(&storage.read(&path, MOST_MANIFEST).map_err(at(&path))?);
        if let Some(identity) = &manifest.identity {
            found.identity.get_or_insert(identity.clone());
        }
        found.manifests.insert(name, manifest);
    }
    let is_marked = found.manifests.values().any(|manifest| manifest.identity.is_some() || !manifest.parts.is_empty());
    if !is_marked {
        // a folder without a manifest of ours is nobody's: only temporary files of this program may be in it
        let whole =
            top.iter().find(|entry| entry.is_file && !entry.name.ends_with(UNFINISHED)).map(|entry| entry.name.clone());
        return Ok(
            match first_foreign.or(whole).or_else(|| files.into_iter().find(|file| !file.ends_with(UNFINISHED))) {
                Some(entry) => Contents::Foreign(entry),
                None => Contents::Blank,
            },
        );
    }
    let has = |name: &str| top.iter().any(|entry| entry.is_file && entry.name == name);
    found.is_finished =
        has(SUCCESS) && found.manifests.get(MANIFEST).is_some_and(|manifest| manifest.is_finished) && has(SUMMARY);
    found.has_page = has(REPORT);
    let listed = found.listed();
    let is_listed = |name: &String| {
        let of_parts = name.starts_with("runs/") || name.starts_with("bands/");
        !of_parts || listed.contains(name)
    };
    let unlisted = files.iter().find(|name| found.is_finished && !is_listed(name)).cloned();
    found.foreign = first_foreign.or(unlisted);
    let path = root.join(PLAN);
    found.plan =
        storage.read(&path, MOST_PLAN).ok().and_then(|bytes| String::from_utf8(bytes).ok()).unwrap_or_default();
    Ok(Contents::Dataset(Box::new(found)))
}

/// Locks that keep other processes away until they are dropped.
#[derive(Debug, Default)]
pub struct Locks(Vec<File>);

impl Locks {
    /// Locks `path`, shared with other shards or not; no lock where the file system has none.
    fn add(&mut self, path: &Path, is_shared: bool) -> Result<(), FolderError> {
        let Ok(file) = File::open(path) else { return Ok(()) };
        match if is_shared { file.try_lock_shared() } else { file.try_lock() } {
            Ok(()) => {
                self.0.push(file);
                Ok(())
            }
            Err(TryLockError::WouldBlock) => {
                Err(FolderError::Busy { folder: path.display().to_string(), owner: String::new() })
            }
            Err(TryLockError::Error(_)) => Ok(()),
        }
    }
}

/// The state of the folder of a result.
#[derive(Debug)]
pub enum Claim {
    /// Parts can be added to it.
    Ready(Box<Ready>),
    /// Everything of the same plan is there, with this text of its summary.
    Finished(String),
}

/// A dataset that is ready for parts, locked against other processes until it is dropped.
#[derive(Debug)]
pub struct Ready {
    /// The dataset.
    pub folder: Folder,
    /// Its final folder, if it replaces another result.
    pub replaces: Option<PathBuf>,
    /// Rows that were there already.
    pub rows: u64,
    /// What was damaged and is made again: lines of manifests, and files with what is wrong with them.
    pub damaged: Vec<String>,
    _locks: Locks,
}

/// How a campaign wants its folder.
#[derive(Clone, Copy, Debug, Default)]
pub struct ClaimOptions {
    /// Replace what is there.
    pub overwrite: bool,
    /// The part of the work that this process does.
    pub shard: Option<Shard>,
    /// How many threads read files.
    pub threads: usize,
}

/// Prepares `root` for the rows of `plan`, whose identity is `identity`.
///
/// # Errors
/// Where the folder has something that must not be replaced, or a file operation fails.
pub fn claim(
    storage: &'static dyn Storage,
    root: &Path,
    (plan, identity): (&Plan, &Identity),
    options: ClaimOptions,
) -> Result<Claim, FolderError> {
    complete_replacement(storage, root)?;
    storage.create_folder(root).map_err(at(root))?;
    let mut locks = Locks::default();
    locks.add(root, options.shard.is_some())?;
    let folder = root.display().to_string();
    let found = match contents(storage, root)? {
        Contents::Foreign(entry) => return Err(FolderError::Foreign { folder, entry }),
        Contents::Blank => Found::default(),
        Contents::Dataset(found) => *found,
    };
    if let Some(entry) = found.foreign {
        return Err(FolderError::Foreign { folder, entry });
    }
    let is_blank = found.manifests.is_empty();
    if options.overwrite && !is_blank {
        let sibling = replacement(root);
        let most = targets(plan).last().copied().unwrap_or(plan.samples);
        remove_dataset(storage, &sibling, identity, most)?;
        let rest = ClaimOptions { overwrite: false, ..options };
        return match claim(storage, &sibling, (plan, identity), rest)? {
            Claim::Ready(ready) => {
                locks.0.extend(ready._locks.0);
                Ok(Claim::Ready(Box::new(Ready { replaces: Some(root.to_owned()), _locks: locks, ..*ready })))
            }
            // it was complete and only not yet in its place
            Claim::Finished(summary) => {
                replace(storage, &sibling, root)?;
                Ok(Claim::Finished(summary))
            }
        };
    }
    if let Some(there) = found.identity.as_ref().filter(|there| *there != identity) {
        return Err(occupied(folder, &found, there, (plan, identity)));
    }
    let most = targets(plan).last().copied().unwrap_or(plan.samples);
    if found.extent() > most {
        return Err(FolderError::Larger { folder, found: found.extent(), asked: most });
    }
    ready(storage, root, (plan, identity), options, found, locks)
}

fn occupied(folder: String, found: &Found, there: &Identity, (plan, identity): (&Plan, &Identity)) -> FolderError {
    // keys that do not change rows are no reason
    let is_reason = |one: &KeyDifference| !Plan::OUTSIDE_ROWS.iter().any(|key| one.key.starts_with(key));
    let value = |value: Option<String>| value.unwrap_or_else(|| "absent".to_owned());
    let mut list: Vec<String> = text_differences(&found.plan, &plan.text())
        .into_iter()
        .filter(is_reason)
        .map(|one| format!("{}: {} there, {} here", one.key, value(one.first), value(one.second)))
        .collect();
    if there.arithmetic != identity.arithmetic || there.format != identity.format {
        list.push(format!(
            "version of the row arithmetic: {}.{} there, {}.{} here",
            there.format, there.arithmetic, identity.format, identity.arithmetic
        ));
    }
    if list.is_empty() {
        list.push(if there.columns == identity.columns {
            format!("hash of the rows: {} there, {} here", there.row_hash, identity.row_hash)
        } else {
            "the columns, which are those of another version of the program".to_owned()
        });
    }
    if list.len() > LISTED {
        let more = list.len() - LISTED;
        list.truncate(LISTED);
        list.push(format!("and {more} more"));
    }
    let what = if found.is_finished { "the result" } else { "an unfinished result" };
    FolderError::Occupied { folder, what, differences: list.join("\n  ") }
}

/// Opens a dataset of the same rows, or a new one.
fn ready(
    storage: &'static dyn Storage,
    root: &Path,
    (plan, identity): (&Plan, &Identity),
    options: ClaimOptions,
    mut found: Found,
    mut locks: Locks,
) -> Result<Claim, FolderError> {
    let all: Vec<PartRecord> = found.parts().into_values().collect();
    // a shard reads its own parts only: each of many that start would read everything; `finish` reads all
    let is_mine = |part: &&PartRecord| options.shard.is_none_or(|shard| part.part % shard.of == shard.number - 1);
    let mine: Vec<PartRecord> = all.iter().filter(is_mine).cloned().collect();
    let broken = crate::dataset::verify::damaged(storage, root, &mine, options.threads);
    let mut damaged = found.damaged_lines();
    damaged.extend(broken.iter().map(|(_, what)| what.clone()));
    if found.is_finished {
        damaged.extend(table_log::damage(storage, root, identity, &all));
    }
    // of a plan with [stop] the finished number of rows is that of one of its looks
    let is_whole = found.is_finished && targets(plan).contains(&found.rows());
    let is_complete = is_whole && damaged.is_empty() && found.plan == plan.text();
    if is_complete && options.shard.is_none() {
        let path = root.join(SUMMARY);
        let summary = storage.read(&path, MOST_PLAN).map_err(at(&path))?;
        return Ok(Claim::Finished(String::from_utf8_lossy(&summary).into_owned()));
    }
    let name = options.shard.map_or(MANIFEST.to_owned(), |shard| manifest_of(shard.number, shard.of));
    let own = found.manifests.remove(&name);
    let folder = Folder::open(storage, root, identity.clone(), (name.clone(), own), found.parts())?;
    if options.shard.is_some() {
        locks.add(&folder.path(&name), false)?;
    }
    folder.unfinish()?;
    if options.shard.is_none() {
        remove_unfinished(storage, root, &folder.parts())?;
    }
    folder.drop_parts(broken.into_iter().map(|(part, _)| part))?;
    if found.plan != plan.text() {
        folder.write_plan(&plan.text())?;
    }
    let rows = folder.parts().iter().map(|part| part.rows).sum();
    Ok(Claim::Ready(Box::new(Ready { folder, replaces: None, rows, damaged, _locks: locks })))
}

/// Removes what an interrupted process left in an unfinished dataset: temporary files, and files of parts that it did not come to list. The
/// campaign may have fewer samples now, and then no part would replace these.
fn remove_unfinished(storage: &dyn Storage, root: &Path, parts: &[PartRecord]) -> Result<(), StorageError> {
    let listed: BTreeSet<&str> = parts.iter().flat_map(|part| &part.files).map(|file| file.name.as_str()).collect();
    for folder in FOLDERS.into_iter().chain([""]) {
        let path = root.join(folder);
        for entry in storage.list(&path).map_err(at(&path))? {
            let is_of_parts = folder == RUNS || folder == PART_BANDS;
            let is_unlisted = is_of_parts && !listed.contains(format!("{folder}/{}", entry.name).as_str());
            let is_left = entry.name.ends_with(UNFINISHED) || is_unlisted;
            if entry.is_file && is_left && is_ours(folder, &entry.name) {
                let file = path.join(&entry.name);
                storage.remove(&file).map_err(at(&file))?;
            }
        }
    }
    Ok(())
}

/// Opens the dataset in `root` as it is, for commands that add no samples; locked against writers.
///
/// # Errors
/// Where there is none, or a file operation fails.
pub fn open(storage: &'static dyn Storage, root: &Path) -> Result<(Found, Locks), FolderError> {
    let folder = root.display().to_string();
    let nothing = |why: &str| FolderError::Nothing { folder: folder.clone(), why: why.to_owned() };
    if storage.list(root).map_err(at(root))?.is_empty() {
        return Err(nothing("there is no such folder, or it is empty"));
    }
    let mut locks = Locks::default();
    locks.add(root, false)?;
    match contents(storage, root)? {
        Contents::Dataset(found) => Ok((*found, locks)),
        _ => Err(nothing("it has no manifest.jsonl")),
    }
}

/// Where a dataset is made that is to replace `root`.
fn replacement(root: &Path) -> PathBuf {
    beside(root, "new")
}

fn beside(root: &Path, what: &str) -> PathBuf {
    let name = root.file_name().map_or_else(|| "result".to_owned(), |name| name.to_string_lossy().into_owned());
    root.with_file_name(format!(".{name}.{what}"))
}

/// Removes the dataset in `root`, if there is one of other rows than `identity`, or of more than `most` samples.
fn remove_dataset(storage: &dyn Storage, root: &Path, identity: &Identity, most: u64) -> Result<(), FolderError> {
    if let Contents::Dataset(found) = contents(storage, root)?
        && (found.identity.as_ref() != Some(identity) || found.extent() > most)
    {
        remove(storage, root, &found)?;
    }
    Ok(())
}

/// Removes the files of a dataset, and its folders where nothing else is in them: first the marks, so that a partly removed dataset is never
/// taken for a whole one.
fn remove(storage: &dyn Storage, root: &Path, found: &Found) -> Result<(), StorageError> {
    let success = root.join(SUCCESS);
    storage.remove(&success).map_err(at(&success))?;
    let listed = found.listed();
    for folder in FOLDERS {
        let path = root.join(folder);
        for entry in storage.list(&path).map_err(at(&path))? {
            let name = format!("{folder}/{}", entry.name);
            let is_of_parts = folder == RUNS || folder == PART_BANDS;
            let is_listed = listed.contains(&name);
            let is_leftover = !found.is_finished || name.ends_with(UNFINISHED);
            if entry.is_file && is_ours(folder, &entry.name) && (!is_of_parts || is_listed || is_leftover) {
                let file = path.join(&entry.name);
                storage.remove(&file).map_err(at(&file))?;
            }
        }
        if storage.list(&path).map_err(at(&path))?.is_empty() {
            storage.remove_folder(&path).map_err(at(&path))?;
        }
    }
    for entry in storage.list(root).map_err(at(root))? {
        if entry.is_file && is_ours("", &entry.name) && !entry.name.starts_with(MANIFEST) {
            let file = root.join(&entry.name);
            storage.remove(&file).map_err(at(&file))?;
        }
    }
    let manifest = root.join(MANIFEST);
    storage.remove(&manifest).map_err(at(&manifest))?;
    if storage.list(root).map_err(at(root))?.is_empty() {
        storage.remove_folder(root).map_err(at(root))?;
    }
    Ok(())
}

/// Puts the finished dataset `new` in the place of `root`, and removes what was there.
///
/// # Errors
/// Where a file operation fails; the old result is then still whole, in its place or beside it.
pub fn replace(storage: &dyn Storage, new: &Path, root: &Path) -> Result<(), FolderError> {
    let old = beside(root, "old");
    storage.rename(root, &old).map_err(at(root))?;
    storage.rename(new, root).map_err(at(new))?;
    let parent = root.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
    storage.sync_folder(parent).map_err(at(parent))?;
    remove_old(storage, &old)
}

fn remove_old(storage: &dyn Storage, old: &Path) -> Result<(), FolderError> {
    if let Contents::Dataset(found) = contents(storage, old)? {
        remove(storage, old, &found)?;
    }
    Ok(())
}

/// Ends a replacement that was interrupted between its two renames, or before the old result was removed.
fn complete_replacement(storage: &dyn Storage, root: &Path) -> Result<(), FolderError> {
    let (old, new) = (beside(root, "old"), replacement(root));
    if storage.list(&old).map_err(at(&old))?.is_empty() {
        return Ok(());
    }
    if storage.list(root).map_err(at(root))?.is_empty() {
        let is_new_whole = matches!(contents(storage, &new)?, Contents::Dataset(found) if found.is_finished);
        let from = if is_new_whole { &new } else { &old };
        storage.rename(from, root).map_err(at(from))?;
    }
    remove_old(storage, &old)
}
