//! [`contents`]: what is in the folder of a result, as it was found: its manifests, its plan, and what does not belong
//! there.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use crate::campaign::difference::text_differences;
use crate::storage::disk::{Storage, StorageError, at, is_absent};
use crate::storage::folder::MOST_MANIFEST;
use crate::storage::identity::in_rows;
use crate::storage::manifest::{FileRecord, Identity, Manifest, PartRecord};
use crate::storage::names::{
    DATA, FOLDERS, MANIFEST, PLAN, REPLACEMENT, REPORT, SHARDS, SUCCESS, UNFINISHED, is_derived, is_ours,
};
use crate::storage::stored_file::is_unfit;

/// Most bytes of a plan that is read.
pub(super) const MOST_PLAN: u64 = 1 << 28;

/// What a folder of results has in it.
#[derive(Debug)]
pub enum FolderContents {
    /// Nothing, or only what a campaign left that was stopped before it wrote its manifest.
    Blank,
    Dataset(Box<Found>),
    /// Something that is no dataset: the first entry.
    Foreign(String),
}

/// A dataset as it was found.
#[derive(Debug, Default)]
pub struct Found {
    /// The text of its plan: that of `plan.toml` where a manifest has the same, else that of a manifest; empty where
    /// there is none.
    pub plan: String,
    /// What is wrong with `plan.toml`, where it is not the plan.
    pub plan_damage: Option<String>,
    /// What its rows are; where no manifest says, what the first file of rows says. `None` where nothing does.
    pub identity: Option<Identity>,
    /// Which manifest is of other rows than another, and the keys that differ.
    pub conflict: Option<String>,
    /// Which shard has a plan with other keys than another, though of the same rows, and these keys.
    pub shards_differ: Option<String>,
    /// The records of its manifests by their names.
    pub manifests: BTreeMap<String, Manifest>,
    pub is_finished: bool,
    /// Whether it has a page, or had one.
    pub has_page: bool,
    /// The first entry that has a name of the dataset and is something else: a link, or a folder where a file should
    /// be.
    pub foreign: Option<String>,
    /// Entries whose names no file of a dataset has: they are left alone.
    pub strays: Vec<String>,
    /// Files with names of the dataset that no manifest lists although everything is there.
    pub unlisted: Vec<String>,
    /// Of a result that is not finished: the files that follow from rows and that no manifest lists. Nothing says what
    /// should be in them.
    pub unchecked: Vec<String>,
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
    pub(super) fn listed(&self) -> BTreeSet<String> {
        let parts = self.manifests.values().flat_map(|manifest| manifest.parts.values());
        parts.flat_map(|part| &part.files).map(|file| file.name.clone()).collect()
    }

    /// The files that follow from plan and rows, of a result in which everything is there.
    pub fn derived(&self) -> &[FileRecord] {
        if self.is_finished { self.written() } else { &[] }
    }

    /// The same of a result of which only the mark may be missing.
    pub fn written(&self) -> &[FileRecord] {
        self.manifests.get(MANIFEST).filter(|manifest| manifest.is_finished).map_or(&[], |manifest| &manifest.derived)
    }

    /// What a note says of each entry that is not part of the result, and is left alone.
    pub fn notes(&self) -> Vec<String> {
        let notes = self.strays.iter().chain(&self.unlisted);
        notes.map(|entry| format!("{entry}: not part of the result; left alone")).collect()
    }

    /// The first entry that is not part of the dataset.
    pub(super) fn not_its_own(&self) -> Option<&String> {
        self.foreign.iter().chain(&self.strays).chain(&self.unlisted).next()
    }

    pub fn rows(&self) -> u64 {
        self.parts().values().map(|part| part.rows).sum()
    }

    /// Number of samples up to the last one of a part that is listed. Parts are not made in order: it may be more than
    /// the rows.
    pub(super) fn extent(&self) -> u64 {
        self.parts().values().map(|part| part.first_sample.saturating_add(part.rows)).max().unwrap_or(0)
    }

    /// What is wrong with manifests and plan, each with its file.
    pub fn damage(&self) -> Vec<String> {
        let lines = |(name, manifest): (&String, &Manifest)| -> Vec<String> {
            manifest.damaged.iter().map(|line| format!("{name}:{line}: damaged line")).collect()
        };
        self.manifests.iter().flat_map(lines).chain(self.plan_damage.clone()).collect()
    }
}

/// What is in `root`.
///
/// # Errors
/// Where a file operation fails.
pub fn contents(storage: &dyn Storage, root: &Path) -> Result<FolderContents, StorageError> {
    let top = storage.list(root).map_err(at(root))?;
    let mut found = Found::default();
    let mut names: Vec<String> =
        top.iter().filter(|entry| entry.is_file && entry.name == MANIFEST).map(|_| MANIFEST.to_owned()).collect();
    let mut files = Vec::new();
    for entry in &top {
        if entry.is_folder && FOLDERS.contains(&entry.name.as_str()) {
            let folder = root.join(&entry.name);
            // it was listed just now
            for inner in storage.entries(&folder).map_err(at(&folder))? {
                let name = format!("{}/{}", entry.name, inner.name);
                if !is_ours(&entry.name, &inner.name) {
                    found.strays.push(name);
                } else if !inner.is_file {
                    found.foreign.get_or_insert(name);
                } else if entry.name == SHARDS && !inner.name.ends_with(UNFINISHED) {
                    names.push(name);
                } else {
                    files.push(name);
                }
            }
        } else if !is_ours("", &entry.name) && !FOLDERS.contains(&entry.name.as_str()) {
            found.strays.push(entry.name.clone());
        } else if !(entry.is_file && is_ours("", &entry.name)) {
            found.foreign.get_or_insert(entry.name.clone());
        }
    }
    for name in names {
        let path = root.join(&name);
        let manifest = Manifest::of(&storage.read(&path, MOST_MANIFEST).map_err(at(&path))?);
        found.manifests.insert(name, manifest);
    }
    let is_marked = found.manifests.values().any(|manifest| manifest.identity.is_some() || !manifest.parts.is_empty());
    if !is_marked {
        // a folder without a manifest of ours is nobody's: only temporary files of this program may be in it
        let is_whole = |name: &str| !name.ends_with(UNFINISHED) && name != REPLACEMENT;
        let whole = top.iter().find(|entry| entry.is_file && is_whole(&entry.name)).map(|entry| entry.name.clone());
        return Ok(
            match found
                .not_its_own()
                .cloned()
                .or(whole)
                .or_else(|| files.into_iter().find(|file| !file.ends_with(UNFINISHED)))
            {
                Some(entry) => FolderContents::Foreign(entry),
                None => FolderContents::Blank,
            },
        );
    }
    let has = |name: &str| top.iter().any(|entry| entry.is_file && entry.name == name);
    let is_marked_whole = top.iter().any(|entry| entry.is_file && entry.name == SUCCESS && entry.size == 0);
    found.is_finished = is_marked_whole && found.manifests.get(MANIFEST).is_some_and(|manifest| manifest.is_finished);
    found.conflict = conflict(&found.manifests, |manifest| manifest.identity.as_ref());
    let shards = found.manifests.iter().filter(|(name, _)| name.starts_with(SHARDS));
    found.shards_differ = conflict(shards, |manifest| manifest.plan.as_ref());
    found.identity = match found.manifests.values().find_map(|manifest| manifest.identity.clone()) {
        None => identity_in_rows(storage, &found.row_files(root))?,
        identity => identity,
    };
    found.has_page = has(REPORT) || found.derived().iter().any(|file| file.name == REPORT);
    let mut listed = found.listed();
    listed.extend(found.derived().iter().map(|file| file.name.clone()));
    if !found.is_finished {
        let written: BTreeSet<&str> = found.written().iter().map(|file| file.name.as_str()).collect();
        // the manifest has the plan, and the plan has the checksums of files of numbers
        let is_unchecked = |name: &String| {
            is_derived(name) && name != PLAN && !name.starts_with(DATA) && !written.contains(name.as_str())
        };
        let top = top.iter().filter(|entry| entry.is_file).map(|entry| &entry.name);
        found.unchecked = top.chain(&files).filter(|name| is_unchecked(name)).cloned().collect();
    } else {
        let top = top.iter().filter(|entry| entry.is_file && is_derived(&entry.name)).map(|entry| entry.name.clone());
        let is_unlisted = |name: &String| !name.ends_with(UNFINISHED) && !listed.contains(name);
        found.unlisted = files.into_iter().chain(top).filter(is_unlisted).collect();
    }
    (found.plan, found.plan_damage) = plan_of(&found.manifests, plan_text(storage, root)?);
    Ok(FolderContents::Dataset(Box::new(found)))
}

/// Which of `manifests` has something else than the first that has it, and the keys in which their plans differ.
fn conflict<'m, T: PartialEq + 'm>(
    manifests: impl IntoIterator<Item = (&'m String, &'m Manifest)>,
    what: impl Fn(&'m Manifest) -> Option<&'m T>,
) -> Option<String> {
    let mut known = manifests.into_iter().filter_map(|(name, manifest)| Some((name, what(manifest)?, manifest)));
    let (first, of_first, one) = known.next()?;
    let (name, _, other) = known.find(|(_, of_other, _)| *of_other != of_first)?;
    let value = |value: Option<String>| value.unwrap_or_else(|| "absent".to_owned());
    let text = |plan: &Option<String>| plan.clone().unwrap_or_default();
    let keys = text_differences(&text(&one.plan), &text(&other.plan)).into_iter();
    let mut keys: Vec<String> = keys
        .map(|one| format!("{}: {} in {first}, {} in {name}", one.key, value(one.first), value(one.second)))
        .collect();
    if keys.is_empty() {
        keys.push(format!("{:?} in {first}, {:?} in {name}", one.identity, other.identity));
    }
    Some(format!("{name} is of another plan than {first}:\n  {}", keys.join("\n  ")))
}

/// What the first of the files of rows says that is one.
fn identity_in_rows(storage: &dyn Storage, files: &[PathBuf]) -> Result<Option<Identity>, StorageError> {
    for path in files {
        match storage.read(path, u64::MAX) {
            Ok(bytes) => {
                if let Some((identity, ..)) = in_rows(bytes.into()) {
                    return Ok(Some(identity));
                }
            }
            Err(error) if is_unfit(&error) || error.kind() == std::io::ErrorKind::NotFound => {}
            Err(error) => return Err(at(path)(error)),
        }
    }
    Ok(None)
}

/// The plan of a dataset in which `plan.toml` has the text `there`, and what is wrong with that.
fn plan_of(manifests: &BTreeMap<String, Manifest>, there: String) -> (String, Option<String>) {
    let mut recorded = manifests.values().filter_map(|manifest| manifest.plan.as_ref());
    let Some(first) = recorded.clone().next() else { return (there, None) };
    if recorded.any(|plan| *plan == there) {
        return (there, None);
    }
    let what = if there.is_empty() { "is missing, or no text file" } else { "its content has changed" };
    (first.clone(), Some(format!("{PLAN}: {what}; {MANIFEST} has the plan")))
}

/// The text of `plan.toml` in `root`; empty where there is none, or no text.
///
/// # Errors
/// Where it cannot be read.
pub fn plan_text(storage: &dyn Storage, root: &Path) -> Result<String, StorageError> {
    let path = root.join(PLAN);
    let text = |bytes| String::from_utf8(bytes).unwrap_or_default();
    match storage.read(&path, MOST_PLAN) {
        Ok(bytes) => Ok(text(bytes)),
        Err(error) if is_unfit(&error) || is_absent(storage, root, &path, &error)? => Ok(String::new()),
        // its folder lists it now: another shard has just written it
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => {
            storage.read(&path, MOST_PLAN).map(text).map_err(at(&path))
        }
        Err(error) => Err(at(&path)(error)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::storage::disk::Disk;

    /// Law: without a manifest, files that are whole are not taken for this program's, and what it left unfinished is
    /// nothing.
    #[test]
    fn whole_files_without_a_manifest_are_foreign() {
        let root = std::env::temp_dir().join(format!("spindrift-found-{}", std::process::id()));
        let _ = std::fs::remove_dir_all(&root);
        let runs = root.join(crate::storage::names::RUNS);
        std::fs::create_dir_all(&runs).expect("a folder");
        let found = || contents(&Disk, &root).expect("readable");
        assert!(matches!(found(), FolderContents::Blank), "an empty folder");
        std::fs::write(runs.join("part-000000.parquet.tmp"), b"half").expect("written");
        assert!(matches!(found(), FolderContents::Blank), "an unfinished part");
        std::fs::write(runs.join("part-000001.parquet"), b"whole").expect("written");
        assert!(matches!(found(), FolderContents::Foreign(name) if name == "runs/part-000001.parquet"), "a whole part");
        std::fs::remove_dir_all(&root).expect("removed");
    }
}
