//! [`claim`]: whether a campaign may write to the folder of a result, and the locks that keep others away.

use std::fs::{File, TryLockError};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::thread::sleep;
use std::time::{Duration, Instant};

use crate::campaign::Plan;
use crate::storage::atomic::explained;
use crate::storage::disk::{Storage, at, meant, new_folder};
use crate::storage::folder::{Folder, MOST_MANIFEST, MOST_SUMMARY, begin};
pub use crate::storage::folder_error::FolderError;
use crate::storage::folder_error::{occupied, row_differences};
use crate::storage::found::{FolderContents, Found, contents};
use crate::storage::manifest::{Identity, Manifest, PartRecord};
use crate::storage::names::{MANIFEST, SUMMARY, manifest_of};
use crate::storage::recovery::is_lost;
use crate::storage::replacement::{self, remove_replaced, remove_unfinished, replace};
use crate::storage::verify::{damaged as damaged_parts, derived_damage};

/// How long a lock of another process is waited for: that of a process which was killed ends once the system has closed
/// its files, and a program that the owner starts has copies of the owner's files for a moment.
const PATIENCE: Duration = Duration::from_millis(300);
/// Between two tries of a lock.
const PAUSE: Duration = Duration::from_millis(10);

/// One of several processes that make the parts of a campaign.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    /// Its number, from 1.
    pub number: u64,
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
    /// Everything of the same plan is there.
    Finished(Finished),
}

/// A dataset in which everything is there, locked against other processes until this is dropped.
#[derive(Debug)]
pub struct Finished {
    /// The text of its summary.
    pub summary: String,
    /// Its parts, whose checksums were compared.
    pub parts: Vec<PartRecord>,
    /// What is not part of it, and was left alone.
    pub notes: Vec<String>,
    _locks: Locks,
}

/// A dataset that is ready for parts, locked against other processes until it is dropped.
#[derive(Debug)]
pub struct Ready {
    pub folder: Folder,
    /// Its final folder, if it replaces another result.
    pub replaces: Option<PathBuf>,
    /// Rows that were there already.
    pub rows: u64,
    /// What was damaged and is made again: lines of manifests, and files with what is wrong with them.
    pub damaged: Vec<String>,
    /// What is not part of it, and is left alone.
    pub notes: Vec<String>,
    _locks: Locks,
}

/// How a campaign wants its folder.
#[derive(Clone, Copy, Debug, Default)]
pub struct ClaimOptions {
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
    if root.ancestors().any(Path::is_file) {
        // what the system says of it has no remedy
        return Err(at(root)(explained(root, ErrorKind::NotADirectory.into())).into());
    }
    let root = &*meant(root).map_err(at(root))?;
    if let Some(new) = replacement::interrupted(storage, root)? {
        let mut locks = Locks::default();
        locks.add(storage, &new, false)?;
        replacement::complete(storage, &new, root)?;
    }
    let (mut locks, found) = locked(storage, root, options)?;
    if options.shard.is_none() {
        remove_replaced(storage, root)?;
    }
    if !options.overwrite || found.manifests.is_empty() {
        return fill(storage, root, (plan, identity), options, (found, locks));
    }
    let folder = root.display().to_string();
    if let Some(entry) = found.not_its_own() {
        return Err(FolderError::Foreign { folder, entry: entry.clone() });
    }
    let new = replacement::begin(storage, root, identity, most(plan))?;
    replacement::check_replaceable(storage, &new, root).map_err(|why| FolderError::Immovable { folder, why })?;
    let (others, found) = locked(storage, &new, options)?;
    locks.0.extend(others.0);
    match fill(storage, &new, (plan, identity), options, (found, locks))? {
        Claim::Ready(ready) => Ok(Claim::Ready(Box::new(Ready { replaces: Some(root.to_owned()), ..*ready }))),
        // it was complete and only not yet in its place
        Claim::Finished(finished) => {
            replace(storage, &new, root)?;
            Ok(Claim::Finished(finished))
        }
    }
}

/// Most samples that the plan comes to have.
fn most(plan: &Plan) -> u64 {
    plan.looks().last().copied().unwrap_or(plan.samples)
}

/// Creates the folder `root`, if there is none, and locks it; what is in it.
fn locked(storage: &dyn Storage, root: &Path, options: ClaimOptions) -> Result<(Locks, Found), FolderError> {
    new_folder(storage, root)?;
    let mut locks = Locks::default();
    locks.add(storage, root, options.shard.is_some())?;
    let mut found = contents(storage, root)?;
    if matches!(found, FolderContents::Foreign(_)) {
        // a shard that begins at the same time has written files since its manifest was looked for
        found = contents(storage, root)?;
    }
    if matches!(found, FolderContents::Foreign(_)) && is_lost(storage, root)? {
        return Err(FolderError::Lost { folder: root.display().to_string() });
    }
    let foreign = |entry| FolderError::Foreign { folder: root.display().to_string(), entry };
    let mut found = match found {
        FolderContents::Foreign(entry) => return Err(foreign(entry)),
        FolderContents::Blank => Found::default(),
        FolderContents::Dataset(found) => *found,
    };
    found.foreign.take().map_or(Ok((locks, found)), |entry| Err(foreign(entry)))
}

/// Prepares `root`, where `found` is, for the rows of `plan`.
fn fill(
    storage: &'static dyn Storage,
    root: &Path,
    (plan, identity): (&Plan, &Identity),
    options: ClaimOptions,
    (found, locks): (Found, Locks),
) -> Result<Claim, FolderError> {
    let folder = root.display().to_string();
    if let Some(conflict) = found.conflict {
        return Err(FolderError::Mixed { folder, conflict });
    }
    if let Some(there) = found.identity.as_ref().filter(|there| *there != identity) {
        return Err(occupied(folder, &found, there, (plan, identity)));
    }
    if let Some(differences) = row_differences(&found.plan, plan).filter(|_| found.identity.is_some()) {
        let conflict = format!(
            "its first line says that its rows are those of this plan, and its second one has a plan with other \
            rows:\n  {differences}"
        );
        return Err(FolderError::Mixed { folder, conflict: format!("{MANIFEST}: {conflict}") });
    }
    let most = most(plan);
    if found.extent() > most {
        return Err(FolderError::Larger { folder, found: found.extent(), asked: most });
    }
    ready(storage, root, (plan, identity), options, found, locks)
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
    let name = options.shard.map_or(MANIFEST.to_owned(), |shard| manifest_of(shard.number, shard.of));
    let mut damaged = found.damage();
    // other shards may be about to write the last line of theirs, and the plan
    damaged.retain(|what| options.shard.is_none() || what.starts_with(&name));
    damaged.extend(broken.iter().map(|(_, what)| what.clone()));
    damaged.extend(derived_damage(storage, root, found.derived())?);
    // of a plan with [stop] the finished number of rows is that of one of its looks
    let is_whole = found.is_finished && plan.looks().contains(&found.rows());
    let is_complete = is_whole && damaged.is_empty() && found.plan == plan.text();
    if is_whole && options.shard.is_some() && damaged.is_empty() && !is_complete {
        return Err(FolderError::Answered { folder: root.display().to_string() });
    }
    if is_complete {
        let path = root.join(SUMMARY);
        match summary(storage.read(&path, MOST_SUMMARY).map_err(at(&path))?) {
            Some(summary) => {
                let finished = Finished { summary, parts: all, notes: found.notes(), _locks: locks };
                return Ok(Claim::Finished(finished));
            }
            None => damaged.push(format!("{SUMMARY}: its content has changed")),
        }
    }
    let is_plan_there = found.plan == plan.text() && found.plan_damage.is_none();
    let what = (plan.text(), identity.clone());
    let root_name = root.display().to_string();
    // what no line lists could not be told from what an interruption leaves
    if let Some(entry) = found.unlisted.first() {
        return Err(FolderError::Foreign { folder: root_name, entry: entry.clone() });
    }
    // the first process makes the manifest, and so decides whose rows these are; shards have their own ones beside it
    for name in [MANIFEST, &name] {
        if !found.manifests.contains_key(name) {
            let manifest = begin(storage, root, (&what.0, identity), name)?;
            if let Some(there) = manifest.identity.as_ref().filter(|there| *there != identity) {
                found.plan = manifest.plan.clone().unwrap_or_default();
                return Err(occupied(root_name, &found, there, (plan, identity)));
            }
            found.manifests.insert(name.to_owned(), manifest);
        }
    }
    let mut own = found.manifests.remove(&name);
    let mut opening = Locks::default();
    if options.shard.is_some() {
        let path = root.join(&name);
        opening.add(storage, &path, false)?;
        // another process of this shard may have ended since it was read
        own = Some(Manifest::of(&storage.read(&path, MOST_MANIFEST).map_err(at(&path))?));
    }
    let folder = Folder::open(storage, root, what, (name.clone(), own), found.parts())?;
    drop(opening);
    if options.shard.is_some() {
        // where it was written again it is another file
        locks.add(storage, &folder.path(&name), false)?;
    }
    folder.unfinish()?;
    if options.shard.is_none() {
        remove_unfinished(storage, root, &folder.parts())?;
    }
    folder.drop_parts(broken.into_iter().map(|(part, _)| part))?;
    folder.write_plan(is_plan_there)?;
    let rows = folder.parts().iter().map(|part| part.rows).sum();
    Ok(Claim::Ready(Box::new(Ready { folder, replaces: None, rows, damaged, notes: found.notes(), _locks: locks })))
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

/// Opens the dataset in `root` as it is, for commands that add no samples; locked against writers, and against readers
/// unless `is_shared`.
///
/// # Errors
/// Where there is none, or a file operation fails.
pub fn open(storage: &'static dyn Storage, root: &Path, is_shared: bool) -> Result<(Found, Locks), FolderError> {
    let folder = root.display().to_string();
    let nothing = |why: &str| FolderError::Nothing { folder: folder.clone(), why: why.to_owned() };
    let entries = match storage.list(root) {
        Err(error) if error.kind() == ErrorKind::NotADirectory => return Err(nothing("it is a file")),
        entries => entries.map_err(at(root))?,
    };
    if entries.is_empty() {
        return Err(nothing("there is no such folder, or it is empty"));
    }
    let mut locks = Locks::default();
    locks.add(storage, root, is_shared)?;
    match contents(storage, root)? {
        FolderContents::Dataset(found) => match &found.conflict {
            Some(conflict) => Err(FolderError::Mixed { folder, conflict: conflict.clone() }),
            None => Ok((*found, locks)),
        },
        _ if is_lost(storage, root)? => Err(FolderError::Lost { folder }),
        _ => Err(nothing("it has no manifest.jsonl")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::storage::disk::Disk;

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
