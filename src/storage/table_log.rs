//! [`update`]: the log by which table engines (Spark, Trino, DuckDB, polars, pandas) open a dataset as one table.
//!
//! It is a transaction log of Delta Lake: <https://github.com/delta-io/delta/blob/master/PROTOCOL.md>, reader version
//! 1, writer version 2. Each commit `_delta_log/<version>.json` has lines of JSON, one action each: the first has the
//! `protocol`, the `metaData` with the columns, their units and meanings, and an `add` for every file of rows; when a
//! campaign was made longer, one more commit adds the new files. The log follows from the manifest, which stays the
//! truth: its times are zero, and the id of the table is from the row hash.
//!
//! What a version lists never changes: the last part, which gets further rows when the campaign is made longer, is
//! listed as a copy in `versions/`, which the next version removes and which stays for readers of the version before.
//! So `runs/` has every row once.

use std::collections::BTreeMap;
use std::path::Path;

use serde_json::{Value, json};

use crate::ensemble::PartId;
use crate::storage::disk::{Storage, StorageError, at, entries_in};
use crate::storage::folder::Folder;
use crate::storage::identity::sha256;
use crate::storage::manifest::{FileRecord, Identity, PartRecord};
use crate::storage::names::{RUNS, TABLE_LOG, VERSIONS, is_ours, version_of};
use crate::storage::stored_file::is_unfit;
use crate::storage::verify::derived_damage;
use crate::table::{Column, Content};

/// Most bytes of a commit: a file of rows takes some 400.
const MOST_COMMIT: u64 = 1 << 36;
/// The key of the table's configuration with the SHA-256 of its columns.
const COLUMNS_CHECKSUM: &str = "spindrift.columns_sha256";

/// A file of rows as the log lists it.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Listed {
    bytes: u64,
    rows: u64,
    sha256: String,
}

/// The files of rows that the log has to list, by name.
type Files = BTreeMap<String, Listed>;

/// The files of rows of `parts`; `growing` is the part that can get further rows.
fn files(parts: &[PartRecord], growing: Option<PartId>) -> Files {
    let of_part = |part: &PartRecord| {
        let file = rows_file(part)?;
        let id = PartId(part.part);
        let name = if growing == Some(id) { version_of(id, part.rows) } else { file.name.clone() };
        Some((name, Listed { bytes: file.bytes, rows: part.rows, sha256: file.sha256.clone() }))
    };
    parts.iter().filter_map(of_part).collect()
}

/// The file of the rows of `part`.
fn rows_file(part: &PartRecord) -> Option<&FileRecord> {
    part.files.iter().find(|file| file.name.split('/').next() == Some(RUNS))
}

/// The action that adds a file.
fn add(name: &str, file: &Listed) -> Value {
    // a name of ours needs no escapes in a URI
    json!({"add": {
        "path": name,
        "partitionValues": {},
        "size": file.bytes,
        "modificationTime": 0,
        "dataChange": true,
        "stats": json!({"numRecords": file.rows}).to_string(),
        "tags": {"sha256": file.sha256},
    }})
}

/// The action that removes a file.
fn remove(name: &str) -> Value {
    json!({"remove": {"path": name, "deletionTimestamp": 0, "dataChange": true}})
}

/// The name and the numbers of a file that is added.
fn added(action: &Value) -> Option<(String, Listed)> {
    let action = action.get("add")?;
    let statistics: Value = serde_json::from_str(action.get("stats")?.as_str()?).ok()?;
    let sha256 = action.pointer("/tags/sha256")?.as_str()?.to_owned();
    let listed = Listed { bytes: action.get("size")?.as_u64()?, rows: statistics.get("numRecords")?.as_u64()?, sha256 };
    Some((action.get("path")?.as_str()?.to_owned(), listed))
}

/// The columns as the log has them: a schema of Delta Lake, as text.
fn schema(columns: &[Column]) -> String {
    let field = |column: &Column| {
        let (unit, meaning) = (column.quantity.unit(), column.quantity.meaning());
        let comment = if unit.is_empty() { meaning.to_owned() } else { format!("{meaning} [{unit}]") };
        // there are no unsigned integers
        let kind = match column.content {
            Content::Real => "double",
            Content::Count => "long",
            Content::Word => "string",
        };
        let metadata = json!({"comment": comment, "unit": unit, "meaning": meaning});
        json!({"name": column.quantity.name(), "type": kind, "nullable": column.nullable, "metadata": metadata})
    };
    json!({"type": "struct", "fields": columns.iter().map(field).collect::<Vec<_>>()}).to_string()
}

/// The id of the table of these rows: a UUID of version 8 (RFC 9562) from the row hash.
fn id(identity: &Identity) -> String {
    let hash = sha256(format!("{}/{}", identity.row_hash, identity.columns).as_bytes());
    format!("{}-{}-8{}-8{}-{}", &hash[..8], &hash[8..12], &hash[12..15], &hash[15..18], &hash[18..30])
}

/// The actions that begin the log.
fn head(identity: &Identity, columns: &str) -> [Value; 2] {
    [
        json!({"protocol": {"minReaderVersion": 1, "minWriterVersion": 2}}),
        json!({"metaData": {
            "id": id(identity),
            "description": format!("Rows of a campaign of spindrift, one for each sample; row hash {}.",
                identity.row_hash),
            "format": {"provider": "parquet", "options": {}},
            "schemaString": columns,
            "partitionColumns": [],
            "configuration": {COLUMNS_CHECKSUM: sha256(columns.as_bytes())},
            "createdTime": 0,
        }}),
    ]
}

fn lines(actions: impl Iterator<Item = Value>) -> String {
    actions.map(|action| format!("{action}\n")).collect()
}

/// The name of a commit.
fn commit_of(version: usize) -> String {
    format!("{TABLE_LOG}/{version:020}.json")
}

/// A log as it was read.
#[derive(Debug, Default)]
struct Log {
    /// The columns of the table, as text.
    columns: String,
    commits: Vec<FileRecord>,
    /// The files that the last version lists.
    files: Files,
    /// The files in `versions/` that any version lists.
    versions: Vec<FileRecord>,
}

/// Reads the log in `root`; `None` where it is not one that this program has written for these rows.
///
/// # Errors
/// Where it cannot be read.
fn read(storage: &dyn Storage, root: &Path, identity: &Identity) -> Result<Option<Log>, StorageError> {
    let folder = root.join(TABLE_LOG);
    let mut commits = Vec::new();
    for entry in entries_in(storage, root, &folder)?.into_iter().filter(|entry| is_ours(TABLE_LOG, &entry.name)) {
        let path = folder.join(&entry.name);
        match storage.read(&path, MOST_COMMIT) {
            Ok(bytes) => commits.push((entry.name, bytes)),
            Err(error) if is_unfit(&error) => return Ok(None),
            Err(error) => return Err(at(&path)(error)),
        }
    }
    let Some(log) = log_of(commits, identity) else { return Ok(None) };
    Ok(derived_damage(storage, root, &log.versions)?.is_empty().then_some(log))
}

/// The log of commits in their order: their text has to be what this program writes for what it says.
fn log_of(commits: Vec<(String, Vec<u8>)>, identity: &Identity) -> Option<Log> {
    let mut log = Log::default();
    for (version, (file, bytes)) in commits.into_iter().enumerate() {
        let name = commit_of(version);
        if format!("{TABLE_LOG}/{file}") != name {
            return None;
        }
        log.commits.push(FileRecord::of(&name, &bytes));
        let text = String::from_utf8(bytes).ok()?;
        let actions = text.lines().map(serde_json::from_str).collect::<Result<Vec<Value>, _>>().ok()?;
        let mut again = Vec::new();
        if version == 0 {
            let columns = actions.iter().find_map(|action| action.pointer("/metaData/schemaString")?.as_str());
            log.columns = columns?.to_owned();
            again.extend(head(identity, &log.columns));
        }
        for action in actions.iter().skip(again.len()) {
            if let Some(name) = action.pointer("/remove/path").and_then(Value::as_str) {
                log.files.remove(name)?;
                again.push(remove(name));
                continue;
            }
            let (name, file) = added(action)?;
            again.push(add(&name, &file));
            if name.starts_with(VERSIONS) {
                let sha256 = file.sha256.clone();
                log.versions.push(FileRecord { name: name.clone(), bytes: file.bytes, sha256 });
            }
            log.files.insert(name, file);
        }
        if lines(again.into_iter()) != text {
            return None;
        }
    }
    (!log.commits.is_empty()).then_some(log)
}

/// Whether `before` is what a campaign of fewer samples has: the same files, and a copy of its last part, which may
/// have further rows now.
fn is_earlier(before: &Files, now: &Files) -> bool {
    let part =
        |name: &str| name.split('/').next_back().and_then(|file| file.split(['-', '.']).nth(1).map(str::to_owned));
    before.iter().all(|(name, file)| match now.get(name) {
        Some(now) => now == file,
        None => {
            name.starts_with(VERSIONS)
                && now.iter().any(|(other, now)| part(other) == part(name) && now.rows > file.rows)
        }
    })
}

/// Whether the log in `root` is one that this program has written for the rows of `parts`, with these `columns`;
/// `growing` as for [`update`].
///
/// # Errors
/// Where it cannot be read.
pub fn is_of(
    (storage, root): (&dyn Storage, &Path),
    identity: &Identity,
    columns: &[Column],
    (parts, growing): (&[PartRecord], Option<PartId>),
) -> Result<bool, StorageError> {
    let log = read(storage, root, identity)?;
    Ok(log.is_some_and(|log| log.columns == schema(columns) && log.files == files(parts, growing)))
}

/// Brings the log of a dataset whose parts are all there up to date: nothing where it is, one more commit where files
/// were added, and a new log where there is none, or another one. `growing` is the part that gets further rows when the
/// campaign is made longer.
///
/// # Errors
/// Where a file operation fails.
pub fn update(folder: &Folder, columns: &[Column], growing: Option<PartId>) -> Result<(), StorageError> {
    let parts = folder.parts();
    let files = files(&parts, growing);
    let columns = schema(columns);
    let log = read(folder.storage(), folder.root(), folder.identity())?
        .filter(|log| log.columns == columns && is_earlier(&log.files, &files));
    let is_new = log.is_none();
    if is_new {
        folder.clear(TABLE_LOG)?;
        folder.clear(VERSIONS)?;
        let path = folder.path(TABLE_LOG);
        folder.storage().create_folder(&path).map_err(at(&path))?;
    }
    let log = log.unwrap_or_default();
    log.commits.iter().chain(&log.versions).for_each(|file| folder.list(file.clone()));
    let growing = parts.iter().find(|part| Some(PartId(part.part)) == growing);
    if let Some((part, file)) = growing.and_then(|part| Some((part, rows_file(part)?)))
        && !log.files.contains_key(&version_of(PartId(part.part), part.rows))
    {
        let (path, copies) = (folder.path(&file.name), folder.path(VERSIONS));
        folder.storage().create_folder(&copies).map_err(at(&copies))?;
        let bytes = folder.storage().read(&path, file.bytes).map_err(at(&path))?;
        folder.write(&version_of(PartId(part.part), part.rows), &bytes)?;
    }
    let gone = log.files.keys().filter(|name| !files.contains_key(*name)).map(|name| remove(name));
    let new = files.iter().filter(|(name, _)| !log.files.contains_key(*name)).map(|(name, file)| add(name, file));
    let head = is_new.then(|| head(folder.identity(), &columns)).into_iter().flatten();
    let text = lines(head.chain(gone).chain(new));
    if text.is_empty() {
        return Ok(());
    }
    folder.write(&commit_of(log.commits.len()), text.as_bytes())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ensemble::{Part, PartId};
    use crate::run::Quantity;
    use crate::sampling::SampleId;
    use crate::storage::disk::Disk;
    use crate::storage::folder::PartFile;
    use crate::storage::manifest::tests::identity;
    use crate::storage::names::{MANIFEST, bands_of, rows_of};
    use std::path::PathBuf;

    struct Root(PathBuf);

    impl Drop for Root {
        fn drop(&mut self) {
            let _ = std::fs::remove_dir_all(&self.0);
        }
    }

    fn headings() -> [Column; 3] {
        [("sample_id", "", Content::Count), ("status", "", Content::Word), ("energy_j", "J", Content::Real)]
            .map(|(name, unit, content)| Column::new(Quantity::new(name, unit, "What it \"means\"."), content))
    }

    fn dataset(name: &str) -> (Root, Folder) {
        let root = std::env::temp_dir().join(format!("spindrift-log-{}-{name}", std::process::id()));
        let _ = std::fs::remove_dir_all(&root);
        std::fs::create_dir_all(&root).expect("a folder");
        let folder =
            Folder::open(&Disk, &root, (String::new(), identity()), (MANIFEST.to_owned(), None), BTreeMap::new());
        (Root(root), folder.expect("a dataset"))
    }

    fn commit(folder: &Folder, part: u64, rows: usize) {
        let (id, first) = (PartId(part), SampleId(256 * part));
        let files = [PartFile::new(bands_of(id), vec![1; 5]), PartFile::new(rows_of(id), vec![0; 100 + rows])];
        folder.commit(Part { id, first, count: rows }, &files).expect("committed");
    }

    fn text(root: &Root, version: usize) -> Option<String> {
        std::fs::read_to_string(root.0.join(commit_of(version))).ok()
    }

    fn made(folder: &Folder, growing: Option<u64>) {
        update(folder, &headings(), growing.map(PartId)).expect("written");
    }

    /// The files of rows that version `version` lists, as an engine finds them: what was added, without what was
    /// removed.
    fn listed(root: &Root, version: usize) -> Vec<String> {
        let mut files = Vec::new();
        for version in 0..=version {
            for line in text(root, version).expect("a commit").lines() {
                let action: Value = serde_json::from_str(line).expect("JSON");
                let path = |kind: &str| action.pointer(&format!("/{kind}/path"))?.as_str().map(str::to_owned);
                files.extend(path("add"));
                files.retain(|file| path("remove").as_ref() != Some(file));
            }
        }
        files
    }

    /// Law: the log lists the files of rows of the manifest and nothing else; it is written once; more parts are one
    /// more commit, which replaces the copy of the part that grew; what a version lists stays as it was.
    #[test]
    fn the_log_follows_the_manifest() {
        let (root, folder) = dataset("follows");
        commit(&folder, 0, 256);
        commit(&folder, 1, 40);
        made(&folder, Some(1));
        let first = text(&root, 0).expect("a commit");
        let actions: Vec<Value> = first.lines().map(|line| serde_json::from_str(line).expect("JSON")).collect();
        assert_eq!(actions.len(), 4);
        assert_eq!(actions[3]["add"]["path"], "versions/part-000001-000040.parquet");
        assert_eq!(
            (&actions[3]["add"]["size"], &actions[3]["add"]["stats"]),
            (&json!(140), &json!("{\"numRecords\":40}"))
        );
        made(&folder, Some(1));
        assert_eq!((text(&root, 0), text(&root, 1)), (Some(first.clone()), None));
        let content = |root: &Root, files: &[String]| -> Vec<Vec<u8>> {
            files.iter().map(|file| std::fs::read(root.0.join(file)).expect("a file of rows")).collect()
        };
        let (before, rows) = (listed(&root, 0), content(&root, &listed(&root, 0)));
        // the last part grows, and one is added
        commit(&folder, 1, 256);
        commit(&folder, 2, 7);
        assert_eq!(content(&root, &before), rows, "an extension that is not committed");
        made(&folder, None);
        assert_eq!((text(&root, 0), content(&root, &before)), (Some(first), rows));
        let now = ["part-000000", "part-000001", "part-000002"].map(|part| format!("runs/{part}.parquet"));
        assert_eq!(listed(&root, 1), now);
    }

    /// Law: a log in which a bit has changed, a commit is missing or one is too many is replaced by a new one, and so
    /// is one with a damaged copy.
    #[test]
    fn a_damaged_log_is_replaced() {
        let (root, folder) = dataset("damage");
        let log = |root: &Root| (listed(root, 0), text(root, 1));
        commit(&folder, 0, 256);
        commit(&folder, 1, 9);
        made(&folder, None);
        let whole = log(&root);
        let path = root.0.join(commit_of(0));
        let bytes = std::fs::read(&path).expect("a commit");
        for at in 0..bytes.len() {
            let mut changed = bytes.clone();
            changed[at] ^= 1 << (at % 8);
            assert!(
                log_of(vec![("0".repeat(20) + ".json", changed)], &identity())
                    .is_none_or(|log| { !is_earlier(&log.files, &files(&folder.parts(), None)) }),
                "byte {at}"
            );
        }
        std::fs::write(root.0.join(commit_of(2)), &bytes).expect("written");
        made(&folder, None);
        assert_eq!((log(&root), text(&root, 2)), (whole, None));
        commit(&folder, 2, 5);
        made(&folder, Some(2));
        assert!(text(&root, 1).is_some());
        std::fs::write(root.0.join(version_of(PartId(2), 5)), b"damaged").expect("written");
        made(&folder, Some(2));
        assert_eq!((listed(&root, 0).len(), text(&root, 1)), (3, None));
        std::fs::read(root.0.join(version_of(PartId(2), 5))).map(|bytes| assert_eq!(bytes.len(), 105)).expect("a copy");
    }

    /// Law: the table has an id of its own for other rows, and it is a UUID.
    #[test]
    fn the_id_is_that_of_the_rows() {
        let other = Identity { row_hash: "ac".repeat(32), ..identity() };
        assert!(id(&identity()) == id(&identity()) && id(&identity()) != id(&other));
        let id = id(&identity());
        let lengths: Vec<usize> = id.split('-').map(str::len).collect();
        assert_eq!((lengths, &id[14..15], &id[19..20]), (vec![8, 4, 4, 4, 12], "8", "8"));
    }
}
