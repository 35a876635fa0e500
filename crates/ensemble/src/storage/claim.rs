//! [`claim`]: whether a campaign may write to the place of a result.

use super::store::{Result, Store};
use crate::campaign::Plan;
use crate::campaign::difference::{KeyDifference, text_differences};
use crate::ensemble::{Ensemble, PartId};
use crate::storage::atomic::explained;
use crate::storage::dataset::{Dataset, Head, PartRecord, unfinish};
use crate::storage::folder_error::{self, FolderError, all_differences, other_questions, reasons};
use crate::storage::found::{Found, MISSING, contents};
use crate::storage::identity::{Identity, sealed};
use crate::storage::lock::{Lock, lock};
use crate::storage::names::{HEAD, PLAN, SUMMARY};
use crate::storage::replacement::{self, remove_replaced, replace};
use crate::storage::rows_file::identity;
use crate::storage::store::{OpenFolder, at};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// One of several processes of a campaign.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    /// Its number, from 1.
    pub number: u64,
    pub of: u64,
}

impl Shard {
    pub fn has(self, part: PartId) -> bool {
        part.0 % self.of == self.number - 1
    }
}

fn shown(store: &dyn Store) -> String {
    store.root().display().to_string()
}

#[derive(Debug)]
pub enum Claim {
    Ready(Box<Ready>),
    /// The result of the same plan is complete.
    Finished(Finished),
}

/// A complete dataset, locked while held.
#[derive(Debug)]
pub struct Finished {
    pub store: Arc<dyn Store>,
    pub summary: String,
    /// Its parts, with verified checksums.
    pub parts: Vec<PartRecord>,
    /// Foreign entries, left alone.
    pub notes: Vec<String>,
    _lock: Lock,
}

/// A dataset ready for parts, locked while held.
#[derive(Debug)]
pub struct Ready {
    pub dataset: Dataset,
    /// Its final folder, if it replaces another result.
    pub replaces: Option<PathBuf>,
    pub rows: u64,
    /// Damaged files, computed again, with their damage.
    pub damaged: Vec<String>,
    pub notes: Vec<String>,
    _locks: Vec<Lock>,
}

#[derive(Clone, Copy)]
pub struct ClaimOptions<'a> {
    /// Opens folders beside the result.
    pub folders: &'a OpenFolder<'a>,
    pub overwrite: bool,
    pub shard: Option<Shard>,
    pub threads: usize,
}

/// Largest number of samples of `plan`.
fn most(plan: &Plan) -> u64 {
    plan.looks().last().copied().unwrap_or(plan.samples)
}

/// Prepares `store` for the rows of `ensemble`.
///
/// # Errors
/// A result that must not be replaced, or a failed file operation.
pub fn claim(store: &Arc<dyn Store>, ensemble: &Ensemble<'_>, options: ClaimOptions<'_>) -> Result<Claim, FolderError> {
    let root = store.root();
    if root.ancestors().any(Path::is_file) {
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
        return fill(store, ensemble, options, (found, vec![own]));
    }
    if let Some(entry) = found.not_its_own() {
        return Err(FolderError::Foreign { folder: shown(&**store), entry: entry.to_owned() });
    }
    let is_same = found.identity == Some(identity(ensemble));
    let head = Head::of(ensemble, found.largest_part.filter(|_| is_same));
    let new = replacement::begin(options.folders, root, &head)?;
    let (mut lock, mut found) = locked(&*new, options)?;
    // an interrupted extension by more samples left no result
    let (plan, head) = (ensemble.plan(), Head::of(ensemble, found.largest_part));
    if found.examine(&*new, (plan, &head), &|_| true, options.threads)?.extent() > most(plan) {
        drop(lock);
        replacement::remove(&*new)?;
        (lock, found) = locked(&*new, options)?;
    }
    match fill(&new, ensemble, options, (found, vec![own, lock]))? {
        Claim::Ready(ready) => Ok(Claim::Ready(Box::new(Ready { replaces: Some(root.to_owned()), ..*ready }))),
        // complete, but not yet in its place
        Claim::Finished(finished) => {
            replace(options.folders, &new, root)?;
            Ok(Claim::Finished(Finished { store: (options.folders)(root), ..finished }))
        }
    }
}

/// Creates the folder if absent, and locks it; returns its contents.
fn locked(store: &dyn Store, options: ClaimOptions<'_>) -> Result<(Lock, Found), FolderError> {
    if store.replaces() {
        crate::storage::disk::new_folder(store.root()).map_err(store.at(""))?;
    }
    let lock = lock(store, options.shard.is_some())?;
    let found = match contents(store) {
        // a shard that started at the same time has added files since
        Err(FolderError::Foreign { .. }) => contents(store)?,
        found => found?,
    };
    match &found.foreign {
        Some(entry) => Err(FolderError::Foreign { folder: shown(store), entry: entry.clone() }),
        None => Ok((lock, found)),
    }
}

fn fill(
    store: &Arc<dyn Store>,
    ensemble: &Ensemble<'_>,
    options: ClaimOptions<'_>,
    (found, mut locks): (Found, Vec<Lock>),
) -> Result<Claim, FolderError> {
    let (plan, folder, identity) = (ensemble.plan(), shown(&**store), identity(ensemble));
    if let Some(there) = found.identity.as_ref().filter(|there| **there != identity) {
        return Err(occupied(&**store, &found, there, (plan, &identity)));
    }
    // a shard reads only its own parts, since many start at once; `finish` reads all
    let is_mine = |part: PartId| options.shard.is_none_or(|shard| shard.has(part));
    let head = Head::of(ensemble, found.largest_part);
    let examined = found.examine(&**store, (plan, &head), &is_mine, options.threads)?;
    let (most, extent) = (most(plan), examined.extent().max(found.manifest.as_ref().map_or(0, |whole| whole.rows)));
    if extent > most {
        return Err(FolderError::Larger { folder, found: extent, asked: most });
    }
    let mut damaged = found.problems(&**store, &examined)?;
    // with [stop] a finished campaign ends at one of its looks
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
        if is_whole {
            return Err(FolderError::Answered { folder });
        }
        if let Some(differences) = other_questions(&found.plan, plan) {
            return Err(FolderError::Asked { folder, differences });
        }
    }
    if !store.replaces() {
        if !is_same {
            let differences = all_differences((&found.plan, &identity), (plan, &identity));
            return Err(FolderError::Kept { folder, differences });
        }
        if damaged.iter().any(|what| !what.ends_with(MISSING)) {
            return Err(FolderError::Changed { folder, damaged: damaged.join("\n  ") });
        }
    }
    // unlisted files could not be told from leftovers
    if let Some(entry) = found.unlisted().next() {
        return Err(FolderError::Foreign { folder, entry: entry.to_owned() });
    }
    let is_begun = found.identity.is_some();
    if is_begun {
        unfinish(&**store)?;
    }
    let head = begin(&**store, &found, plan, head)?;
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

/// Puts the head of a dataset unless present; returns the present one. One of several simultaneous processes creates
/// it, with or without locks.
fn begin(store: &dyn Store, found: &Found, plan: &Plan, head: Head) -> Result<Head, FolderError> {
    let bytes = head.bytes();
    if found.damage.iter().any(|what| what.starts_with(HEAD)) {
        store.put(HEAD, &bytes).map_err(store.at(HEAD))?;
        return Ok(head);
    }
    store.put_if_absent(HEAD, &bytes).map_err(store.at(HEAD))?;
    let there = store.read(HEAD)?.map_err(store.at(HEAD))?;
    let other: Option<Head> = sealed(&there).and_then(|_| serde_json::from_slice(&there).ok());
    match other {
        Some(other) if other.identity == head.identity => Ok(other),
        Some(other) => Err(occupied(store, &Found::default(), &other.identity, (plan, &head.identity))),
        None => Err(store.at(HEAD)(std::io::Error::other("its content has changed; run the command again")).into()),
    }
}

/// The refusal of `store`, which has the rows `there` instead of those of `plan`, `identity`.
fn occupied(store: &dyn Store, found: &Found, there: &Identity, (plan, identity): (&Plan, &Identity)) -> FolderError {
    let text = store.read(PLAN).ok().and_then(|read| String::from_utf8(read.ok()?).ok());
    let text = if found.plan.is_empty() { text.unwrap_or_default() } else { found.plan.clone() };
    let folder = shown(store);
    if !store.replaces() {
        return FolderError::Kept { folder, differences: all_differences((&text, there), (plan, identity)) };
    }
    // keys that change no row are no reason
    let is_reason = |one: &KeyDifference| !Plan::OUTSIDE_ROWS.iter().any(|key| one.key.starts_with(key));
    let keys = text_differences(&text, &plan.text()).into_iter().filter(|one| !text.is_empty() && is_reason(one));
    let differences = reasons(keys.map(folder_error::shown).collect(), there, identity);
    let what = if found.is_finished { "the result" } else { "an unfinished result" };
    FolderError::Occupied { folder, what, differences }
}

fn summary(store: &dyn Store) -> Result<Option<String>> {
    let text = store.read(SUMMARY)?.ok().and_then(|bytes| String::from_utf8(bytes).ok());
    let is_summary = |text: &String| {
        serde_json::from_str::<serde_json::Value>(text).is_ok_and(|value| value.get("statuses").is_some())
    };
    Ok(text.filter(is_summary))
}

/// Opens an existing dataset, locked against writers, and against readers unless `is_shared`.
///
/// # Errors
/// A missing dataset, or a failed file operation.
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
    match contents(store) {
        Ok(found) if found.identity.is_some() => Ok((found, lock)),
        Ok(_) | Err(FolderError::Foreign { .. }) => Err(nothing("it has no dataset.json")),
        Err(error) => Err(error),
    }
}
