//! [`claim`]: whether a campaign may write to the place of a result.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::campaign::Plan;
use crate::ensemble::{PartId, Parts};
use crate::storage::atomic::explained;
use crate::storage::dataset::{Dataset, Head, PartRecord, unfinish};
use crate::storage::folder_error::{FolderError, all_differences, occupied, other_questions};
use crate::storage::found::{Contents, Found, MISSING, contents};
use crate::storage::identity::{Identity, sealed};
use crate::storage::lock::{Lock, lock};
use crate::storage::names::{HEAD, SUMMARY};
use crate::storage::replacement::{self, remove_replaced, replace};
use crate::storage::store::{OpenFolder, Store, StoreError, at};

/// One of several processes that make the parts of a campaign.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    /// Its number, from 1.
    pub number: u64,
    pub of: u64,
}

impl Shard {
    /// Whether it makes the part.
    pub fn has(self, part: PartId) -> bool {
        part.0 % self.of == self.number - 1
    }
}

fn shown(store: &dyn Store) -> String {
    store.root().display().to_string()
}

/// The state of the place of a result.
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
    pub store: Arc<dyn Store>,
    /// The text of its summary.
    pub summary: String,
    /// Its parts, whose checksums were compared.
    pub parts: Vec<PartRecord>,
    /// What is not part of it, and was left alone.
    pub notes: Vec<String>,
    _lock: Lock,
}

/// A dataset that is ready for parts, locked against other processes until it is dropped.
#[derive(Debug)]
pub struct Ready {
    pub dataset: Dataset,
    /// Its final folder, if it replaces another result.
    pub replaces: Option<PathBuf>,
    /// Rows that were there already.
    pub rows: u64,
    /// Files that are damaged and are made again, with what is wrong with them.
    pub damaged: Vec<String>,
    /// What is not part of it, and is left alone.
    pub notes: Vec<String>,
    _locks: Vec<Lock>,
}

/// How a campaign wants its place.
#[derive(Clone, Copy)]
pub struct ClaimOptions<'a> {
    /// Opens folders beside the result.
    pub folders: &'a OpenFolder<'a>,
    pub overwrite: bool,
    /// The part of the work that this process does.
    pub shard: Option<Shard>,
    /// How many threads read files.
    pub threads: usize,
}

/// The rows that a campaign wants.
#[derive(Clone, Copy)]
pub struct Wanted<'a> {
    pub plan: &'a Plan,
    pub identity: &'a Identity,
    /// The parts, by counted work, where no dataset has sizes yet.
    pub parts: &'a dyn Fn() -> Parts,
}

impl Wanted<'_> {
    /// Most samples that the plan comes to have.
    fn most(&self) -> u64 {
        self.plan.looks().last().copied().unwrap_or(self.plan.samples)
    }

    /// The head of the dataset, whose size of parts may be known.
    pub(super) fn head(&self, largest_part: Option<u64>) -> Head {
        let largest_part = largest_part.unwrap_or_else(|| (self.parts)().largest());
        Head { identity: self.identity.clone(), largest_part }
    }
}

/// Prepares `store` for the rows of a campaign.
///
/// # Errors
/// Where something is there that must not be replaced, or a file operation fails.
pub fn claim(store: &Arc<dyn Store>, wanted: Wanted<'_>, options: ClaimOptions<'_>) -> Result<Claim, FolderError> {
    let root = store.root();
    if root.ancestors().any(Path::is_file) {
        // what the system says of it has no remedy
        return Err(at(root)(explained(root, ErrorKind::NotADirectory.into())).into());
    }
    if store.replaces() {
        replacement::complete(options.folders, root)?;
    }
    let (own, found) = locked(&**store, options)?;
    if options.shard.is_none() && store.replaces() {
        remove_replaced(options.folders, root, &found)?;
    }
    if !options.overwrite || found.identity.is_none() {
        return fill(store, wanted, options, (found, vec![own]));
    }
    if let Some(entry) = found.not_its_own() {
        return Err(FolderError::Foreign { folder: shown(&**store), entry: entry.to_owned() });
    }
    let new = replacement::begin(options.folders, root, &wanted.head(found_size(&found, wanted)))?;
    let (mut lock, mut found) = locked(&*new, options)?;
    // what an interrupted replacement by more samples has left is no result of anybody
    let head = wanted.head(found.largest_part);
    if found.examine(&*new, (wanted.plan, &head), &|_| true, options.threads)?.extent() > wanted.most() {
        drop(lock);
        replacement::remove(&*new)?;
        (lock, found) = locked(&*new, options)?;
    }
    match fill(&new, wanted, options, (found, vec![own, lock]))? {
        Claim::Ready(ready) => Ok(Claim::Ready(Box::new(Ready { replaces: Some(root.to_owned()), ..*ready }))),
        // it was complete and only not yet in its place
        Claim::Finished(finished) => {
            replace(options.folders, &new, root)?;
            Ok(Claim::Finished(Finished { store: (options.folders)(root), ..finished }))
        }
    }
}

/// The size of parts that was found, where they are of the same rows.
fn found_size(found: &Found, wanted: Wanted<'_>) -> Option<u64> {
    found.largest_part.filter(|_| found.identity.as_ref() == Some(wanted.identity))
}

/// Creates the folder, if there is none, and locks it; what is in it.
fn locked(store: &dyn Store, options: ClaimOptions<'_>) -> Result<(Lock, Found), FolderError> {
    if store.replaces() {
        crate::storage::disk::new_folder(store.root()).map_err(store.at(""))?;
    }
    let lock = lock(store, options.shard.is_some())?;
    let mut there = contents(store)?;
    if matches!(there, Contents::Foreign(_)) {
        // a shard that begins at the same time has put files since the folder was listed
        there = contents(store)?;
    }
    let folder = shown(store);
    match there {
        Contents::Old => Err(FolderError::Old { folder }),
        Contents::Foreign(entry) => Err(FolderError::Foreign { folder, entry }),
        Contents::Dataset(found) => match &found.foreign {
            Some(entry) => Err(FolderError::Foreign { folder, entry: entry.clone() }),
            None => Ok((lock, *found)),
        },
    }
}

/// Prepares `store`, where `found` is.
fn fill(
    store: &Arc<dyn Store>,
    wanted: Wanted<'_>,
    options: ClaimOptions<'_>,
    (found, mut locks): (Found, Vec<Lock>),
) -> Result<Claim, FolderError> {
    let (plan, folder) = (wanted.plan, shown(&**store));
    if let Some(there) = found.identity.as_ref().filter(|there| *there != wanted.identity) {
        return Err(occupied(&**store, &found, there, (plan, wanted.identity)));
    }
    // a shard reads its own parts only: each of many that start would read everything; `finish` reads all
    let is_mine = |part: PartId| options.shard.is_none_or(|shard| shard.has(part));
    let head = wanted.head(found.largest_part);
    let examined = found.examine(&**store, (plan, &head), &is_mine, options.threads)?;
    let (most, extent) = (wanted.most(), examined.extent().max(found.manifest.as_ref().map_or(0, |whole| whole.rows)));
    if extent > most {
        return Err(FolderError::Larger { folder, found: extent, asked: most });
    }
    let mut damaged = found.damage.clone();
    damaged.extend(examined.damaged.iter().map(|(_, what)| what.clone()));
    damaged.extend(found.derived_damage(&**store)?);
    // of a plan with [stop] the finished number of rows is that of one of its looks
    let is_whole = found.is_finished && damaged.is_empty() && plan.looks().contains(&found.rows(head.parts(most)));
    let is_same = found.plan.is_empty() || found.plan == plan.text();
    if is_whole && is_same {
        match summary(&**store)? {
            Some(summary) => {
                let (notes, parts) = (found.notes(), found.manifest.iter().flat_map(|whole| whole.parts()).collect());
                let (store, lock) = (store.clone(), locks.pop().unwrap_or_default());
                return Ok(Claim::Finished(Finished { store, summary, parts, notes, _lock: lock }));
            }
            None => damaged.push(format!("{SUMMARY}: its content has changed")),
        }
    }
    if options.shard.is_some() && !is_same {
        // with more samples than before, the plan is that of all shards
        if is_whole {
            return Err(FolderError::Answered { folder });
        }
        if let Some(differences) = other_questions(&found.plan, plan) {
            return Err(FolderError::Asked { folder, differences });
        }
    }
    if !store.replaces() {
        if !is_same {
            let differences = all_differences((&found.plan, wanted.identity), (plan, wanted.identity));
            return Err(FolderError::Kept { folder, differences });
        }
        if damaged.iter().any(|what| !what.ends_with(MISSING)) {
            return Err(FolderError::Changed { folder, damaged: damaged.join("\n  ") });
        }
    }
    // what no manifest lists could not be told from what an interruption leaves
    if let Some(entry) = found.unlisted().next() {
        return Err(FolderError::Foreign { folder, entry: entry.to_owned() });
    }
    let is_begun = found.identity.is_some();
    if is_begun {
        unfinish(&**store)?;
    }
    let head = begin(&**store, &found, (plan, wanted.identity), head)?;
    if options.shard.is_none() {
        found.leftovers().try_for_each(|name| store.remove(name).map_err(store.at(name)))?;
    }
    let rows = examined.rows();
    let grows = plan.analysis.stop.is_some();
    let dataset = Dataset::new(store.clone(), head, (plan.text(), grows), examined.parts);
    dataset.drop_parts(examined.damaged.into_iter().map(|(part, _)| part))?;
    let notes = found.notes();
    Ok(Claim::Ready(Box::new(Ready { dataset, replaces: None, rows, damaged, notes, _locks: locks })))
}

/// Puts the head of a dataset, unless it is there; which one is there. Of several processes that begin at the same time
/// one makes it, with locks and without.
fn begin(
    store: &dyn Store,
    found: &Found,
    (plan, identity): (&Plan, &Identity),
    head: Head,
) -> Result<Head, FolderError> {
    let bytes = head.bytes();
    if found.damage.iter().any(|what| what.starts_with(HEAD)) {
        store.put(HEAD, &bytes).map_err(store.at(HEAD))?;
        return Ok(head);
    }
    store.put_if_absent(HEAD, &bytes).map_err(store.at(HEAD))?;
    let there = store.read(HEAD)?.map_err(store.at(HEAD))?;
    let other: Option<Head> = sealed(&there).and_then(|_| serde_json::from_slice(&there).ok());
    match other {
        Some(other) if other.identity == *identity => Ok(other),
        Some(other) => Err(occupied(store, &Found::default(), &other.identity, (plan, identity))),
        None => Err(store.at(HEAD)(std::io::Error::other("its content has changed; run the command again")).into()),
    }
}

/// The text of the summary; `None` where it cannot be one.
fn summary(store: &dyn Store) -> Result<Option<String>, StoreError> {
    let text = store.read(SUMMARY)?.ok().and_then(|bytes| String::from_utf8(bytes).ok());
    let is_summary = |text: &String| {
        serde_json::from_str::<serde_json::Value>(text).is_ok_and(|value| value.get("statuses").is_some())
    };
    Ok(text.filter(is_summary))
}

/// Opens the dataset in `store` as it is, for commands that add no samples; locked against writers, and against readers
/// unless `is_shared`.
///
/// # Errors
/// Where there is none, or a file operation fails.
pub fn open(store: &dyn Store, is_shared: bool) -> Result<(Found, Lock), FolderError> {
    let folder = shown(store);
    let nothing = |why: &str| FolderError::Nothing { folder: folder.clone(), why: why.to_owned() };
    let entries = match store.list("") {
        Err(error) if error.kind() == ErrorKind::NotADirectory => return Err(nothing("it is a file")),
        Err(error) if error.kind() == ErrorKind::NotFound => Vec::new(),
        entries => entries.map_err(store.at(""))?,
    };
    if entries.is_empty() {
        return Err(nothing("there is no such folder, or it is empty"));
    }
    let lock = lock(store, is_shared)?;
    match contents(store)? {
        Contents::Dataset(found) if found.identity.is_some() => Ok((*found, lock)),
        Contents::Old => Err(FolderError::Old { folder }),
        Contents::Dataset(_) | Contents::Foreign(_) => Err(nothing("it has no dataset.json")),
    }
}
