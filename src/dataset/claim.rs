//! [`claim`]: whether a campaign may write to the folder of a result, and the locks that keep others away.

use std::fs::{File, TryLockError};
use std::path::{Path, PathBuf};
use std::thread::sleep;
use std::time::{Duration, Instant};

use thiserror::Error;

use crate::campaign::Plan;
use crate::campaign::difference::{KeyDifference, text_differences};
use crate::dataset::folder::{Folder, MOST_SUMMARY};
use crate::dataset::found::{Contents, Found, contents};
use crate::dataset::manifest::{Identity, PartRecord};
use crate::dataset::names::{MANIFEST, SUMMARY, manifest_of};
use crate::dataset::replacement::{complete_replacement, remove_dataset, remove_unfinished, replace, replacement};
use crate::dataset::storage::{Storage, StorageError, at};
use crate::dataset::verify::{damaged as damaged_parts, derived_damage};

/// Most keys that a refusal lists.
const LISTED: usize = 12;
/// How long a lock of another process is waited for: that of a process which was killed ends once the system has closed its files, and a
/// program that the owner starts has copies of the owner's files for a moment.
const PATIENCE: Duration = Duration::from_millis(300);
/// Between two tries of a lock.
const PAUSE: Duration = Duration::from_millis(10);

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
    /// Its shards are of different plans.
    #[error(
        "`{folder}` has rows of different plans: {conflict}\nremove the manifest of the wrong one, so that its parts are made again, or run the campaign with --overwrite"
    )]
    Mixed {
        /// The folder.
        folder: String,
        /// Which shard differs, in which keys.
        conflict: String,
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

/// Locks that keep other processes away until they are dropped.
#[derive(Debug, Default)]
pub struct Locks(Vec<File>);

impl Locks {
    /// Locks `path`, shared with other shards or not; no lock where the file system has none.
    fn add(&mut self, storage: &dyn Storage, path: &Path, is_shared: bool) -> Result<(), FolderError> {
        let start = Instant::now();
        loop {
            match storage.lock(path, is_shared) {
                Ok(lock) => {
                    self.0.extend(lock);
                    return Ok(());
                }
                Err(TryLockError::WouldBlock) if start.elapsed() < PATIENCE => sleep(PAUSE),
                Err(TryLockError::WouldBlock) => {
                    return Err(FolderError::Busy { folder: path.display().to_string(), owner: String::new() });
                }
                // without knowing whether another process writes, nothing is written
                Err(TryLockError::Error(error)) => return Err(at(path)(error).into()),
            }
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
    locks.add(storage, root, options.shard.is_some())?;
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
        let most = plan.looks().last().copied().unwrap_or(plan.samples);
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
    if let Some(conflict) = found.conflict {
        return Err(FolderError::Mixed { folder, conflict });
    }
    if let Some(there) = found.identity.as_ref().filter(|there| *there != identity) {
        return Err(occupied(folder, &found, there, (plan, identity)));
    }
    let most = plan.looks().last().copied().unwrap_or(plan.samples);
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
            "the columns: those of [[require]] at_all_times differ, or they are of another version of the program"
                .to_owned()
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
    let broken = damaged_parts(storage, root, identity, &mine, options.threads)?;
    let mut damaged = found.damaged_lines();
    damaged.extend(broken.iter().map(|(_, what)| what.clone()));
    damaged.extend(found.plan_damage.clone());
    damaged.extend(derived_damage(storage, root, found.derived())?);
    // of a plan with [stop] the finished number of rows is that of one of its looks
    let is_whole = found.is_finished && plan.looks().contains(&found.rows());
    let is_complete = is_whole && damaged.is_empty() && found.plan == plan.text();
    if is_complete && options.shard.is_none() {
        let path = root.join(SUMMARY);
        match summary(storage.read(&path, MOST_SUMMARY).map_err(at(&path))?) {
            Some(text) => return Ok(Claim::Finished(text)),
            None => damaged.push(format!("{SUMMARY}: its content has changed")),
        }
    }
    let name = options.shard.map_or(MANIFEST.to_owned(), |shard| manifest_of(shard.number, shard.of));
    let own = found.manifests.remove(&name);
    let is_plan_there = found.plan == plan.text() && found.plan_damage.is_none();
    let what = (plan.text(), identity.clone());
    let folder = Folder::open(storage, root, what, (name.clone(), own), found.parts())?;
    if options.shard.is_some() {
        locks.add(storage, &folder.path(&name), false)?;
    }
    folder.unfinish()?;
    if options.shard.is_none() {
        remove_unfinished(storage, root, &folder.parts())?;
    }
    folder.drop_parts(broken.into_iter().map(|(part, _)| part))?;
    folder.write_plan(is_plan_there)?;
    let rows = folder.parts().iter().map(|part| part.rows).sum();
    Ok(Claim::Ready(Box::new(Ready { folder, replaces: None, rows, damaged, _locks: locks })))
}

/// The text of a summary; `None` where it cannot be one.
fn summary(bytes: Vec<u8>) -> Option<String> {
    let text = String::from_utf8(bytes).ok()?;
    let value: serde_json::Value = serde_json::from_str(&text).ok()?;
    value.get("statuses").is_some().then_some(text)
}

/// Locks the folder `root` against other processes.
///
/// # Errors
/// Where another process has it, or it cannot be opened.
pub fn lock(storage: &dyn Storage, root: &Path) -> Result<Locks, FolderError> {
    let mut locks = Locks::default();
    locks.add(storage, root, false)?;
    Ok(locks)
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
    let locks = lock(storage, root)?;
    match contents(storage, root)? {
        Contents::Dataset(found) => match &found.conflict {
            Some(conflict) => Err(FolderError::Mixed { folder, conflict: conflict.clone() }),
            None => Ok((*found, locks)),
        },
        _ => Err(nothing("it has no manifest.jsonl")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dataset::storage::Disk;

    /// Law: a lock that ends within a moment is waited for; one that is held is refused, within a second.
    #[test]
    fn a_lock_that_ends_is_waited_for() {
        let folder = std::env::temp_dir().join(format!("spindrift-lock-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder");
        let held = Disk.lock(&folder, false).expect("the first lock");
        let start = Instant::now();
        let refused = Locks::default().add(&Disk, &folder, false);
        assert!(matches!(refused, Err(FolderError::Busy { .. })), "{refused:?}");
        assert!(start.elapsed() >= PATIENCE);
        std::thread::scope(|scope| {
            scope.spawn(|| {
                sleep(PAUSE * 2);
                drop(held);
            });
            Locks::default().add(&Disk, &folder, false).expect("a lock after the other has ended");
        });
        std::fs::remove_dir(&folder).expect("no file of the test");
    }
}
