//! [`Dataset`]: the files of a result, and the rule by which parts are added.
//!
//! ```text
//! dataset.json             identity of the rows and size of parts, put whole and only if absent
//! data/, plan.toml         copies of the files of numbers; the resolved plan
//! bands/part-000000.parquet
//! runs/part-000000.parquet rows: sealed, with the identity and the SHA-256 of the bands, which were put first
//! summary.json, ...        what follows from the rows
//! manifest.json            every file with its SHA-256: sealed, written once
//! _SUCCESS                 everything is there
//! ```
//! A row is a function of plan and sample, so processes that write the same part write the same bytes. A part exists
//! if its sealed file of rows has this identity, its number, its first sample and its count. Before anything that the
//! manifest lists changes, `_SUCCESS` and the manifest are removed.

use super::store::{Result, Store};
use crate::ensemble::threads::unpoisoned;
use crate::ensemble::{Ensemble, Part, PartId, Parts};
use crate::storage::identity::{Identity, SEAL_KEY, UNSEALED, seal, sealed, sha256};
use crate::storage::names::{DATA, MANIFEST, PLAN, SUCCESS, SUMMARY, bands_of, is_of_part, is_ours, rows_of};
use crate::storage::rows_file::identity;
use crate::storage::rows_reader::RowsReader;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::{Arc, Mutex, MutexGuard};

#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct FileRecord {
    /// Name below the folder of the dataset, with `/`.
    pub name: String,
    /// Bytes.
    pub bytes: u64,
    /// SHA-256 of its content, hexadecimal.
    pub sha256: String,
}

impl FileRecord {
    pub fn of(name: &str, bytes: &[u8]) -> Self {
        FileRecord { name: name.to_owned(), bytes: bytes.len() as u64, sha256: sha256(bytes) }
    }
}

/// A whole part: its file of rows, then its file of bands, if any.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PartRecord {
    pub part: Part,
    pub files: Vec<FileRecord>,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PartFile {
    pub record: FileRecord,
    pub bytes: Vec<u8>,
}

/// `dataset.json`: identity of the rows, and sizes of parts.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Head {
    #[serde(flatten)]
    pub identity: Identity,
    /// Most samples of a part.
    pub largest_part: u64,
}

impl Head {
    /// For `ensemble`, with parts of `largest_part` samples, else sized by counted work.
    pub fn of(ensemble: &Ensemble<'_>, largest_part: Option<u64>) -> Self {
        let largest_part = largest_part.unwrap_or_else(|| ensemble.parts().largest());
        Head { identity: identity(ensemble), largest_part }
    }

    pub fn bytes(&self) -> Vec<u8> {
        sealed_json(&serde_json::to_string_pretty(self).unwrap_or_default())
    }

    pub fn parts(&self, samples: u64) -> Parts {
        Parts::up_to(samples, self.largest_part)
    }
}

/// `manifest.json`: a finished dataset.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Manifest {
    #[serde(flatten)]
    pub head: Head,
    pub rows: u64,
    pub plan: String,
    /// All files but the mark, ascending by name.
    pub files: Vec<FileRecord>,
}

impl Manifest {
    /// The file, with a line per file of the dataset.
    pub fn bytes(&self) -> Vec<u8> {
        let line = |file: &FileRecord| format!("    {}", serde_json::to_string(file).unwrap_or_default());
        let head = serde_json::to_string_pretty(&Manifest { files: Vec::new(), ..self.clone() }).unwrap_or_default();
        let files: Vec<String> = self.files.iter().map(line).collect();
        sealed_json(&head.replace("\"files\": []", &format!("\"files\": [\n{}\n  ]", files.join(",\n"))))
    }

    /// Reads a file; `None` if it is not a sealed manifest.
    pub fn of(bytes: &[u8]) -> Option<Manifest> {
        sealed(bytes)?;
        let manifest: Manifest = serde_json::from_slice(bytes).ok()?;
        let is_whole = manifest.parts().map(|part| part.part.count as u64).sum::<u64>() == manifest.rows;
        (is_whole && manifest.files.iter().all(|file| is_ours(&file.name))).then_some(manifest)
    }

    pub fn parts(&self) -> impl Iterator<Item = PartRecord> + '_ {
        let file = |name: &str| {
            let found = self.files.binary_search_by(|file| file.name.as_str().cmp(name));
            found.ok().map(|index| self.files[index].clone())
        };
        self.head.parts(self.rows).iter().filter_map(move |part| {
            let files = [Some(file(&rows_of(part.id))?), file(&bands_of(part.id))];
            Some(PartRecord { part, files: files.into_iter().flatten().collect() })
        })
    }

    /// The files outside of parts.
    pub fn derived(&self) -> impl Iterator<Item = &FileRecord> {
        self.files.iter().filter(|file| !is_of_part(&file.name))
    }
}

/// A JSON object with a seal as its last key.
fn sealed_json(object: &str) -> Vec<u8> {
    let body = object.trim_end_matches(['}', '\n']);
    let mut bytes = format!("{body},\n  \"{SEAL_KEY}\": \"{UNSEALED}\"\n}}\n").into_bytes();
    seal(&mut bytes);
    bytes
}

/// A dataset being written.
#[derive(Debug)]
pub struct Dataset {
    store: Arc<dyn Store>,
    head: Head,
    plan: String,
    /// True if the last part may still grow.
    grows: bool,
    state: Mutex<Files>,
}

#[derive(Debug, Default)]
struct Files {
    parts: BTreeMap<u64, PartRecord>,
    /// Files of growing parts.
    for_now: BTreeSet<String>,
    /// Files outside of parts, by name.
    derived: BTreeMap<String, FileRecord>,
}

impl Dataset {
    /// The dataset with these parts in `store`, which has a `dataset.json`.
    pub(super) fn new(
        store: Arc<dyn Store>,
        head: Head,
        (plan, grows): (String, bool),
        parts: impl IntoIterator<Item = PartRecord>,
    ) -> Self {
        let parts = parts.into_iter().map(|part| (part.part.id.0, part)).collect();
        let bytes = head.bytes();
        let state = Mutex::new(Files { parts, ..Files::default() });
        let dataset = Dataset { store, head, plan, grows, state };
        dataset.list(FileRecord::of(super::names::HEAD, &bytes));
        dataset
    }

    pub fn store(&self) -> &Arc<dyn Store> {
        &self.store
    }

    pub fn head(&self) -> &Head {
        &self.head
    }

    fn files(&self) -> MutexGuard<'_, Files> {
        unpoisoned(self.state.lock())
    }

    /// The whole parts, in order.
    pub fn parts(&self) -> Vec<PartRecord> {
        self.files().parts.values().cloned().collect()
    }

    pub fn rows(&self) -> RowsReader {
        rows(&self.store, &self.parts())
    }

    pub fn missing(&self, parts: impl IntoIterator<Item = Part>) -> Vec<Part> {
        let files = self.files();
        parts.into_iter().filter(|part| files.parts.get(&part.id.0).is_none_or(|there| there.part != *part)).collect()
    }

    fn list(&self, file: FileRecord) {
        self.files().derived.insert(file.name.clone(), file);
    }

    /// Puts a file derived from plan and rows.
    pub fn put(&self, name: &str, bytes: &[u8]) -> Result<()> {
        self.store.put(name, bytes).map_err(self.store.at(name))?;
        self.list(FileRecord::of(name, bytes));
        Ok(())
    }

    /// Adds a part: its bands, then its rows.
    ///
    /// # Errors
    /// A failed file operation, after which the part is absent.
    pub fn commit(&self, part: Part, files: &[PartFile]) -> Result<()> {
        let is_final = !self.grows || self.head.parts(u64::MAX).part(part.id) == Some(part);
        for PartFile { record, bytes } in files.iter().rev() {
            let name = &*record.name;
            let put = if is_final { self.store.put(name, bytes) } else { self.store.put_for_now(name, bytes) };
            put.map_err(self.store.at(name))?;
        }
        let mut all = self.files();
        for PartFile { record, .. } in files {
            if is_final {
                all.for_now.remove(&record.name)
            } else {
                all.for_now.insert(record.name.clone())
            };
        }
        let record = PartRecord { part, files: files.iter().map(|file| file.record.clone()).collect() };
        all.parts.insert(part.id.0, record);
        Ok(())
    }

    /// Removes parts, which are then computed again.
    pub fn drop_parts(&self, parts: impl IntoIterator<Item = PartId>) -> Result<()> {
        for part in parts {
            self.remove(&rows_of(part))?;
            self.files().parts.remove(&part.0);
        }
        Ok(())
    }

    /// Puts `copies` of data files, then the plan that names them, unless present.
    pub fn keep(&self, copies: &[(String, Vec<u8>)]) -> Result<()> {
        let copies = copies.iter().map(|(name, bytes)| (format!("{DATA}/{name}"), &**bytes));
        for (name, bytes) in copies.chain([(PLAN.to_owned(), self.plan.as_bytes())]) {
            match self.store.read(&name)? {
                Ok(there) if there == bytes => self.list(FileRecord::of(&name, bytes)),
                _ => self.put(&name, bytes)?,
            }
        }
        Ok(())
    }

    pub fn remove(&self, name: &str) -> Result<()> {
        self.files().derived.remove(name);
        self.store.remove(name).map_err(self.store.at(name))
    }

    /// Removes the files of a dataset in `folder`, and the folder if then empty.
    pub fn clear(&self, folder: &str) -> Result<()> {
        let entries = self.store.entries(folder)?;
        for entry in &entries {
            let name = format!("{folder}/{}", entry.name);
            if entry.is_file && is_ours(&name) {
                self.remove(&name)?;
            }
        }
        if !entries.is_empty() && self.store.entries(folder)?.is_empty() { self.remove(folder) } else { Ok(()) }
    }

    /// Puts the manifest and the mark.
    pub fn finish(&self) -> Result<()> {
        let (manifest, for_now) = {
            let all = self.files();
            let parts = all.parts.values();
            let rows = parts.clone().map(|part| part.part.count as u64).sum();
            let files: BTreeMap<&str, &FileRecord> = parts
                .flat_map(|part| &part.files)
                .chain(all.derived.values())
                .map(|file| (&*file.name, file))
                .collect();
            let files = files.into_values().cloned().collect();
            (Manifest { head: self.head.clone(), rows, plan: self.plan.clone(), files }, all.for_now.clone())
        };
        // bands before rows
        for name in for_now {
            let bytes = self.store.read(&name)?.map_err(self.store.at(&name))?;
            self.store.put(&name, &bytes).map_err(self.store.at(&name))?;
        }
        put_end(&*self.store, &manifest)
    }
}

pub fn rows(store: &Arc<dyn Store>, parts: &[PartRecord]) -> RowsReader {
    let names = |index: usize| parts.iter().filter_map(|part| Some(part.files.get(index)?.name.clone())).collect();
    RowsReader::new(store.clone(), names(0), names(1))
}

/// Removes mark, manifest and summary before anything listed changes.
pub fn unfinish(store: &dyn Store) -> Result<()> {
    [SUCCESS, MANIFEST, SUMMARY].into_iter().try_for_each(|name| store.remove(name).map_err(store.at(name)))
}

fn put_end(store: &dyn Store, manifest: &Manifest) -> Result<()> {
    store.put(MANIFEST, &manifest.bytes()).map_err(store.at(MANIFEST))?;
    store.put(SUCCESS, b"").map_err(store.at(SUCCESS))
}

/// Replaces and lists one file of a finished dataset, unless its bytes are unchanged.
pub fn replace_file(store: &dyn Store, manifest: &Manifest, (name, bytes): (&str, &[u8])) -> Result<()> {
    let mut files: BTreeMap<&str, FileRecord> = manifest.files.iter().map(|file| (&*file.name, file.clone())).collect();
    let put = || store.put(name, bytes).map_err(store.at(name));
    let file = FileRecord::of(name, bytes);
    if files.insert(name, file.clone()).as_ref() == Some(&file) {
        return put();
    }
    let manifest = Manifest { files: files.into_values().collect(), ..manifest.clone() };
    for end in [SUCCESS, MANIFEST] {
        store.remove(end).map_err(store.at(end))?;
    }
    put()?;
    put_end(store, &manifest)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::storage::identity::{ARITHMETIC, FORMAT};

    /// Law: a manifest is read back; one with any changed bit, a file elsewhere, or a missing part is refused.
    #[test]
    fn only_a_whole_manifest_is_read() {
        let spindrift = "dataset".to_owned();
        let (row_hash, columns) = ("ab".repeat(32), "cd".repeat(32));
        let identity = Identity { spindrift, format: FORMAT, arithmetic: ARITHMETIC, row_hash, seed: 7, columns };
        let files = ["bands/part-000000.parquet", "plan.toml", "runs/part-000000.parquet"];
        let of = |rows, files: &[&str]| {
            let files = files.iter().map(|name| FileRecord::of(name, b"x")).collect();
            let head = Head { identity: identity.clone(), largest_part: 1000 };
            Manifest { head, rows, plan: "[campaign]\n\"files\": []".to_owned(), files }
        };
        let manifest = of(256, &files);
        let bytes = manifest.bytes();
        assert_eq!(Manifest::of(&bytes), Some(manifest.clone()));
        let parts: Vec<PartRecord> = manifest.parts().collect();
        assert_eq!((parts.len(), parts[0].files[0].name.as_str(), parts[0].files.len()), (1, files[2], 2));
        assert_eq!(manifest.derived().map(|file| &*file.name).collect::<Vec<_>>(), ["plan.toml"]);
        for bit in 0..8 * bytes.len() {
            let mut changed = bytes.clone();
            changed[bit / 8] ^= 1 << (bit % 8);
            assert_eq!(Manifest::of(&changed), None, "bit {bit}");
        }
        for wrong in [of(257, &files), of(255, &[]), of(256, &["../x", "bands/part-000000.parquet", files[2]])] {
            assert_eq!(Manifest::of(&wrong.bytes()), None, "{wrong:?}");
        }
    }
}
