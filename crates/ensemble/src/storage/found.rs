//! [`contents`]: the contents of the place of a dataset; [`Found::examine`]: its whole parts.

use super::store::{Result, Store};
use crate::campaign::Plan;
use crate::ensemble::{Part, PartId, Parts};
use crate::storage::dataset::{FileRecord, Head, Manifest, PartRecord};
use crate::storage::folder_error::FolderError;
use crate::storage::identity::{Identity, RowsMetadata, sealed, sha256};
use crate::storage::names::{
    DATA, FOLDERS, HEAD, MANIFEST, PART_BANDS, PLAN, REPORT, RUNS, SUCCESS, UNFINISHED, bands_of, is_of_part, is_ours,
    part_of, rows_of,
};
use crate::storage::parallel::in_parallel;
use std::collections::{BTreeMap, BTreeSet};
use std::io;
use std::io::ErrorKind;
use std::num::NonZeroUsize;

/// Manifest of earlier formats.
const OLD_MANIFEST: &str = "manifest.jsonl";

#[derive(Debug, Default)]
pub struct Found {
    /// The text of its plan, empty for none.
    pub plan: String,
    /// Identity of its rows; `None` before a process began.
    pub identity: Option<Identity>,
    /// Most samples of a part, from a whole file.
    pub largest_part: Option<u64>,
    /// The manifest, if whole.
    pub manifest: Option<Manifest>,
    pub is_finished: bool,
    /// Damage of head, manifest and plan, with the file.
    pub damage: Vec<String>,
    /// Files with names of the dataset.
    pub files: BTreeSet<String>,
    /// The first entry with a name of the dataset but another kind: a link, or a folder for a file.
    pub foreign: Option<String>,
    /// Entries with foreign names.
    pub strays: Vec<String>,
}

impl Found {
    /// A note on each foreign entry, left alone.
    pub fn notes(&self) -> Vec<String> {
        let notes = self.strays.iter().map(String::as_str).chain(self.unlisted());
        notes.map(|entry| format!("{entry}: not part of the result; left alone")).collect()
    }

    pub(super) fn not_its_own(&self) -> Option<&str> {
        self.foreign.iter().chain(&self.strays).map(String::as_str).chain(self.unlisted()).next()
    }

    /// Files with names of the dataset that a finished one does not list.
    pub fn unlisted(&self) -> impl Iterator<Item = &str> {
        let listed: BTreeSet<&str> = self.listed().map(|file| &*file.name).chain([MANIFEST, SUCCESS]).collect();
        let all = self.files.iter().filter(|_| self.is_finished).map(String::as_str);
        all.filter(move |name| !listed.contains(name) && !name.ends_with(UNFINISHED))
    }

    fn listed(&self) -> impl Iterator<Item = &FileRecord> {
        self.manifest.iter().flat_map(|manifest| &manifest.files)
    }

    /// True if there is, or was, a page.
    pub fn has_page(&self) -> bool {
        self.files.contains(REPORT) || self.listed().any(|file| file.name == REPORT)
    }

    /// Files derived from the rows of a result without a manifest, which nothing lists.
    pub fn unchecked(&self) -> Vec<String> {
        let is_unchecked = |name: &&String| {
            let is_known = [HEAD, PLAN, MANIFEST, SUCCESS].contains(&name.as_str()) || name.starts_with(DATA);
            !is_known && !is_of_part(name) && !name.ends_with(UNFINISHED)
        };
        let all = self.files.iter().filter(|_| self.manifest.is_none());
        all.filter(is_unchecked).cloned().collect()
    }

    /// Number of rows, of a finished result or from the file names of the `parts`.
    pub fn rows(&self, parts: Parts) -> u64 {
        let named = || self.files.iter().filter_map(|name| parts.part(part_of(name)?)).map(|part| part.count as u64);
        self.manifest.as_ref().map_or_else(|| named().sum(), |manifest| manifest.rows)
    }

    /// Damage of the files derived from the rows, with names.
    ///
    /// # Errors
    /// A file that cannot be read now.
    pub fn derived_damage(&self, store: &dyn Store) -> Result<Vec<String>> {
        let mut found = Vec::new();
        for file in self.manifest.iter().flat_map(Manifest::derived) {
            if ![HEAD, PLAN].contains(&file.name.as_str()) {
                found.extend(checked(store, file)?.err().map(|what| format!("{}: {what}", file.name)));
            }
        }
        Ok(found)
    }

    /// Damage of head, manifest, plan, the `examined` parts, and derived files.
    ///
    /// # Errors
    /// A file that cannot be read now.
    pub fn problems(&self, store: &dyn Store, examined: &Examined) -> Result<Vec<String>> {
        let damaged = examined.damaged.iter().map(|(_, what)| what);
        let known = self.damage.iter().chain(damaged).cloned();
        Ok(known.chain(self.derived_damage(store)?).collect())
    }

    /// Reads the parts chosen by `is_mine` on `threads` threads: the rows of `plan` with `identity`, divided as in
    /// `head`.
    ///
    /// # Errors
    /// The first part with a file that cannot be read now.
    pub fn examine(
        &self,
        store: &dyn Store,
        (plan, head): (&Plan, &Head),
        is_mine: &(dyn Fn(PartId) -> bool + Sync),
        threads: usize,
    ) -> Result<Examined> {
        let listed: BTreeMap<PartId, PartRecord> =
            self.manifest.iter().flat_map(Manifest::parts).map(|part| (part.part.id, part)).collect();
        // the parts listed by a finished result
        let named = self.files.iter().filter(|_| listed.is_empty()).filter_map(|name| part_of(name));
        let parts: Vec<PartId> = named.chain(listed.keys().copied()).filter(|part| is_mine(*part)).collect();
        let all = in_parallel(parts, NonZeroUsize::new(threads), |id| {
            Ok((id, part_there(store, (plan, head), id, listed.get(&id))?))
        });
        let mut examined = Examined::default();
        for one in all {
            let (id, state) = one?;
            match state {
                Ok(part) => examined.parts.push(part),
                Err(what) => examined.damaged.push((id, what)),
            }
        }
        Ok(examined)
    }
}

#[derive(Clone, Debug, Default)]
pub struct Examined {
    /// Whole ones, in order; the last may have fewer rows than in the plan.
    pub parts: Vec<PartRecord>,
    /// The others, with their damage.
    pub damaged: Vec<(PartId, String)>,
}

impl Examined {
    pub fn rows(&self) -> u64 {
        self.parts.iter().map(|part| part.part.count as u64).sum()
    }

    /// Number of samples up to the last one, which may exceed the rows, since parts are made in any order.
    pub fn extent(&self) -> u64 {
        self.parts.last().map_or(0, |part| part.part.first.0 + part.part.count as u64)
    }
}

/// The content of a file, or its damage.
fn checked(store: &dyn Store, file: &FileRecord) -> Result<Result<Vec<u8>, String>> {
    Ok(match store.read(&file.name)? {
        Err(error) => Err(reason(&error)),
        Ok(bytes) if bytes.len() as u64 != file.bytes => {
            Err(format!("{} bytes instead of {}", bytes.len(), file.bytes))
        }
        Ok(bytes) if sha256(&bytes) != file.sha256 => Err("its content has changed".to_owned()),
        Ok(bytes) => Ok(bytes),
    })
}

/// Damage of an absent file.
pub const MISSING: &str = "missing";

fn reason(error: &io::Error) -> String {
    if error.kind() == ErrorKind::NotFound { MISSING.to_owned() } else { error.to_string() }
}

/// The part `id`, possibly `listed` in the manifest, or its damage.
fn part_there(
    store: &dyn Store,
    (plan, head): (&Plan, &Head),
    id: PartId,
    listed: Option<&PartRecord>,
) -> Result<Result<PartRecord, String>> {
    let name = rows_of(id);
    let wrong = |what: String| Ok(Err(format!("{name}: {what}")));
    let changed = "its content has changed";
    let bytes = match store.read(&name)? {
        Ok(bytes) => bytes,
        Err(error) => return wrong(reason(&error)),
    };
    let Some(sha256_of_rows) = sealed(&bytes) else { return wrong(changed.to_owned()) };
    let rows = FileRecord { name: name.clone(), bytes: bytes.len() as u64, sha256: sha256_of_rows };
    let Some(there) = RowsMetadata::of(bytes.into()) else { return wrong("is not a file of rows".to_owned()) };
    if there.identity != head.identity {
        return wrong(format!(
            "has the rows of another plan (seed {} and row hash {}, not {} and {})",
            there.identity.seed, there.identity.row_hash, head.identity.seed, head.identity.row_hash
        ));
    }
    let whole = head.parts(u64::MAX).part(id);
    let part = whole.map(|whole| Part { count: there.rows as usize, ..whole }).filter(|part| {
        let is_first = part.first.0 >= plan.rows() || plan.sample(part.first.0).0 == there.first;
        let fits = 0 < part.count && whole.is_some_and(|whole| part.count <= whole.count);
        there.part == id.0 && is_first && fits
    });
    let Some(part) = part else { return wrong(format!("has the {} rows of part {}", there.rows, there.part)) };
    let mut files = vec![rows];
    if let Some(sha256_of_bands) = there.bands {
        let name = bands_of(id);
        let wrong = |what: String| Ok(Err(format!("{name}: {what}")));
        match store.read(&name)? {
            Ok(bytes) if sha256(&bytes) == sha256_of_bands => {
                files.push(FileRecord { name, bytes: bytes.len() as u64, sha256: sha256_of_bands });
            }
            Ok(_) => return wrong(changed.to_owned()),
            Err(error) => return wrong(reason(&error)),
        }
    }
    let record = PartRecord { part, files };
    if listed.is_some_and(|listed| *listed != record) {
        return wrong(format!("{changed}, with its seal: {MANIFEST} lists another one"));
    }
    Ok(Ok(record))
}

/// The contents of `store`.
///
/// # Errors
/// A dataset of format 5 or earlier, foreign contents, or a failed file operation.
pub fn contents(store: &dyn Store) -> Result<Found, FolderError> {
    let top = store.entries("")?;
    let mut found = Found::default();
    for entry in &top {
        let name = &entry.name;
        if entry.is_folder && FOLDERS.contains(&name.as_str()) {
            for inner in store.entries(name)? {
                found.add(format!("{name}/{}", inner.name), inner.is_file);
            }
        } else if FOLDERS.contains(&name.as_str()) {
            found.foreign.get_or_insert(name.clone());
        } else {
            found.add(name.clone(), entry.is_file);
        }
    }
    let read = |name: &str| found.files.contains(name).then(|| store.read(name)).transpose();
    let bytes = |read: &Option<Result<Vec<u8>, io::Error>>| read.as_ref().and_then(|read| read.as_ref().ok().cloned());
    let (head, manifest) = (read(HEAD)?, read(MANIFEST)?);
    let there = bytes(&head).filter(|bytes| sealed(bytes).is_some());
    let there: Option<Head> = there.and_then(|bytes| serde_json::from_slice(&bytes).ok());
    found.manifest = bytes(&manifest).and_then(|bytes| Manifest::of(&bytes));
    let known = there.clone().or_else(|| found.manifest.as_ref().map(|manifest| manifest.head.clone()));
    found.largest_part = known.as_ref().map(|head| head.largest_part);
    found.identity = match known {
        Some(head) => Some(head.identity),
        None => found.identity_of_rows(store)?,
    };
    if found.identity.is_none() {
        let folder = store.root().display().to_string();
        if top.iter().any(|entry| entry.name == OLD_MANIFEST && entry.is_file) {
            return Err(FolderError::Old { folder });
        }
        let whole = found.files.iter().find(|name| !name.ends_with(UNFINISHED)).map(String::as_str);
        let foreign = found.foreign.as_deref().or(found.strays.first().map(String::as_str)).or(whole);
        return match foreign.map(str::to_owned) {
            Some(entry) => Err(FolderError::Foreign { folder, entry }),
            None => Ok(found),
        };
    }
    let damage =
        |name: &str, is_there: bool| format!("{name}: {}", if is_there { "its content has changed" } else { MISSING });
    if there.is_none() {
        found.damage.push(damage(HEAD, head.is_some()));
    }
    let is_marked = top.iter().any(|entry| entry.is_file && entry.name == SUCCESS && entry.size == 0);
    found.is_finished = is_marked && found.manifest.is_some();
    if found.manifest.is_none() && (is_marked || manifest.is_some()) {
        found.damage.push(damage(MANIFEST, manifest.is_some()));
    }
    if found.manifest.as_ref().zip(there).is_some_and(|(manifest, head)| manifest.head != head) {
        found.damage.push(format!("{MANIFEST}: lists other rows than those of {HEAD}"));
        (found.manifest, found.is_finished) = (None, false);
    }
    let plan = store.read(PLAN)?.ok().and_then(|bytes| String::from_utf8(bytes).ok());
    found.plan = plan.clone().unwrap_or_default();
    if let Some(manifest) = found.manifest.as_ref().filter(|manifest| plan.as_ref() != Some(&manifest.plan)) {
        found.damage.push(damage(PLAN, found.files.contains(PLAN)));
        found.plan = manifest.plan.clone();
    }
    Ok(found)
}

impl Found {
    fn add(&mut self, name: String, is_file: bool) {
        if !is_ours(&name) {
            self.strays.push(name);
        } else if is_file {
            self.files.insert(name);
        } else {
            self.foreign.get_or_insert(name);
        }
    }

    /// The identity recorded by the first sealed file of rows.
    fn identity_of_rows(&self, store: &dyn Store) -> Result<Option<Identity>> {
        for name in self.files.iter().filter(|name| part_of(name).is_some()) {
            if let Ok(bytes) = store.read(name)?
                && sealed(&bytes).is_some()
                && let Some(rows) = RowsMetadata::of(bytes.into())
            {
                return Ok(Some(rows.identity));
            }
        }
        Ok(None)
    }

    /// Leftovers of an interrupted process in an unfinished dataset: temporary files, and bands without rows.
    pub(super) fn leftovers(&self) -> impl Iterator<Item = &String> {
        let has_rows = |name: &str| self.files.contains(&name.replacen(PART_BANDS, RUNS, 1));
        self.files.iter().filter(move |name| {
            name.ends_with(UNFINISHED) || name.starts_with(&format!("{PART_BANDS}/")) && !has_rows(name)
        })
    }
}
