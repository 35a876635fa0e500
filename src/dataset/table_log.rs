//! [`update`], [`damage`]: the log by which table engines (Spark, Trino, DuckDB, polars, pandas) open a dataset as one table.
//!
//! It is a transaction log of Delta Lake: <https://github.com/delta-io/delta/blob/master/PROTOCOL.md>, reader version 1, writer version 2. Each
//! commit `_delta_log/<version>.json` has lines of JSON, one action each: the first has the `protocol`, the `metaData` with the columns,
//! their units and meanings, and an `add` for every file of rows; when a campaign was made longer, one more commit adds the new files, and
//! again the last one before, if it has grown. The log follows from the manifest, which stays the truth: its times are zero, the id of the
//! table is from the row hash, and the columns have a checksum, so that every changed bit is found by writing the log again ([`damage`]).

use std::collections::BTreeMap;
use std::path::Path;

use serde_json::{Value, json};

use crate::dataset::columnar::{Content, Heading};
use crate::dataset::folder::Folder;
use crate::dataset::identity::sha256;
use crate::dataset::manifest::{Identity, PartRecord};
use crate::dataset::names::{RUNS, TABLE_LOG};
use crate::dataset::storage::{Storage, StorageError, at, entries_in};
use crate::dataset::stored_file::is_unfit;

/// Most bytes of a commit: a file of rows takes some 400.
const MOST_COMMIT: u64 = 1 << 36;
/// The key of the table's configuration with the SHA-256 of its columns.
const COLUMNS_CHECKSUM: &str = "spindrift.columns_sha256";

/// A file of rows as the log lists it.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Listed {
    bytes: u64,
    rows: u64,
}

/// The files of rows that the log has to list, by name.
type Files = BTreeMap<String, Listed>;

/// The files of rows of `parts`.
fn files(parts: &[PartRecord]) -> Files {
    let is_of_rows = |name: &str| name.split('/').next() == Some(RUNS);
    let of_part = |part: &PartRecord| {
        let file = part.files.iter().find(|file| is_of_rows(&file.name))?;
        Some((file.name.clone(), Listed { bytes: file.bytes, rows: part.rows }))
    };
    parts.iter().filter_map(of_part).collect()
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
    }})
}

/// The name and the numbers of a file that is added.
fn added(action: &Value) -> Option<(String, Listed)> {
    let action = action.get("add")?;
    let statistics: Value = serde_json::from_str(action.get("stats")?.as_str()?).ok()?;
    let listed = Listed { bytes: action.get("size")?.as_u64()?, rows: statistics.get("numRecords")?.as_u64()? };
    Some((action.get("path")?.as_str()?.to_owned(), listed))
}

/// The columns as the log has them: a schema of Delta Lake, as text.
fn columns(headings: &[Heading]) -> String {
    let field = |heading: &Heading| {
        let (unit, meaning) = (heading.quantity.unit(), heading.quantity.meaning());
        let comment = if unit.is_empty() { meaning.to_owned() } else { format!("{meaning} [{unit}]") };
        // there are no unsigned integers
        let kind = match heading.content {
            Content::Real => "double",
            Content::Count => "long",
            Content::Word => "string",
        };
        let metadata = json!({"comment": comment, "unit": unit, "meaning": meaning});
        json!({"name": heading.quantity.name(), "type": kind, "nullable": heading.nullable, "metadata": metadata})
    };
    json!({"type": "struct", "fields": headings.iter().map(field).collect::<Vec<_>>()}).to_string()
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
            "description": format!("Rows of a campaign of spindrift, one for each sample; row hash {}.", identity.row_hash),
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

/// A log as it was read: its number of commits, and the files that it lists.
#[derive(Debug, Default)]
struct Log {
    commits: usize,
    files: Files,
}

/// Reads the log in `root`; what is wrong, where it is not one that this program has written for these rows.
///
/// # Errors
/// Where it cannot be read.
fn read(storage: &dyn Storage, root: &Path, identity: &Identity) -> Result<Result<Log, String>, StorageError> {
    let folder = root.join(TABLE_LOG);
    let mut commits = Vec::new();
    for entry in entries_in(storage, root, &folder)? {
        let path = folder.join(&entry.name);
        match storage.read(&path, MOST_COMMIT) {
            Ok(bytes) => commits.push((entry.name, bytes)),
            Err(error) if is_unfit(&error) => return Ok(Err(format!("{TABLE_LOG}/{}: {error}", entry.name))),
            Err(error) => return Err(at(&path)(error)),
        }
    }
    Ok(log_of(commits, identity))
}

/// The log of commits in their order; what is wrong, where it is not one that this program has written for these rows.
fn log_of(commits: Vec<(String, Vec<u8>)>, identity: &Identity) -> Result<Log, String> {
    let mut log = Log::default();
    for (version, (file, bytes)) in commits.into_iter().enumerate() {
        let name = commit_of(version);
        let wrong = |what: &str| format!("{TABLE_LOG}/{file}: {what}");
        if format!("{TABLE_LOG}/{file}") != name {
            return Err(wrong("is not the next commit"));
        }
        let changed = || wrong("its content has changed");
        let text = String::from_utf8(bytes).map_err(|_| changed())?;
        let actions = text.lines().map(serde_json::from_str).collect::<Result<Vec<Value>, _>>();
        let actions = actions.map_err(|_| changed())?;
        let mut again = Vec::new();
        if version == 0 {
            let columns = actions.iter().find_map(|action| action.pointer("/metaData/schemaString")?.as_str());
            again.extend(head(identity, columns.ok_or_else(changed)?));
        }
        for action in actions.iter().skip(again.len()) {
            let (name, file) = added(action).ok_or_else(changed)?;
            again.push(add(&name, &file));
            log.files.insert(name, file);
        }
        if lines(again.into_iter()) != text {
            return Err(changed());
        }
        log.commits = version + 1;
    }
    Ok(log)
}

/// What is wrong with the log of the dataset in `root`, which consists of `parts`; `None` where it lists their files of rows.
///
/// # Errors
/// Where it cannot be read.
pub fn damage(
    storage: &dyn Storage,
    root: &Path,
    identity: &Identity,
    parts: &[PartRecord],
) -> Result<Option<String>, StorageError> {
    Ok(match read(storage, root, identity)? {
        Err(what) => Some(what),
        Ok(log) if log.commits == 0 => Some(format!("{}: missing", commit_of(0))),
        Ok(log) if log.files != files(parts) => Some(format!("{TABLE_LOG}: does not list the files of rows")),
        Ok(_) => None,
    })
}

/// Whether `before` is what a campaign of fewer samples has: the same files; the last may have fewer rows.
fn is_earlier(before: &Files, now: &Files) -> bool {
    let last = before.keys().next_back();
    before.iter().all(|(name, file)| {
        let grew = |now: &Listed| now.rows > file.rows && Some(name) == last;
        now.get(name).is_some_and(|now| now == file || grew(now))
    })
}

/// Brings the log of a dataset whose parts are all there up to date: nothing where it is, one more commit where files were added, and a new
/// log where there is none, or another one.
///
/// # Errors
/// Where a file operation fails.
pub fn update(folder: &Folder, headings: &[Heading]) -> Result<(), StorageError> {
    let files = files(&folder.parts());
    let log = read(folder.storage(), folder.root(), folder.identity())?.unwrap_or_default();
    let is_earlier = log.commits > 0 && is_earlier(&log.files, &files);
    if !is_earlier {
        folder.clear(TABLE_LOG)?;
        let path = folder.path(TABLE_LOG);
        folder.storage().create_folder(&path).map_err(at(&path))?;
    }
    let before = if is_earlier { log.files } else { Files::new() };
    let new = files.iter().filter(|(name, file)| before.get(*name) != Some(file)).map(|(name, file)| add(name, file));
    let text =
        if is_earlier { lines(new) } else { lines(head(folder.identity(), &columns(headings)).into_iter().chain(new)) };
    if text.is_empty() {
        return Ok(());
    }
    folder.write(&commit_of(if is_earlier { log.commits } else { 0 }), text.as_bytes())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dataset::folder::PartFile;
    use crate::dataset::manifest::tests::identity;
    use crate::dataset::names::{MANIFEST, bands_of, rows_of};
    use crate::dataset::storage::Disk;
    use crate::ensemble::{Part, PartId};
    use crate::run::Quantity;
    use crate::sampling::SampleId;
    use std::path::PathBuf;

    struct Root(PathBuf);

    impl Drop for Root {
        fn drop(&mut self) {
            let _ = std::fs::remove_dir_all(&self.0);
        }
    }

    fn headings() -> [Heading; 3] {
        [("sample_id", "", Content::Count), ("status", "", Content::Word), ("energy_j", "J", Content::Real)]
            .map(|(name, unit, content)| Heading::new(Quantity::new(name, unit, "What it \"means\"."), content))
    }

    /// A dataset without parts.
    fn dataset(name: &str) -> (Root, Folder) {
        let root = std::env::temp_dir().join(format!("spindrift-log-{}-{name}", std::process::id()));
        let _ = std::fs::remove_dir_all(&root);
        std::fs::create_dir_all(&root).expect("a folder");
        let folder = Folder::open(&Disk, &root, identity(), (MANIFEST.to_owned(), None), BTreeMap::new());
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

    fn check(root: &Root, folder: &Folder) -> Option<String> {
        damage(&Disk, &root.0, &identity(), &folder.parts()).expect("a readable log")
    }

    /// Law: the log lists the files of rows of the manifest and nothing else; it is written once; more parts are one more commit.
    #[test]
    fn the_log_follows_the_manifest() {
        let (root, folder) = dataset("follows");
        commit(&folder, 0, 256);
        commit(&folder, 1, 40);
        assert!(check(&root, &folder).is_some_and(|what| what.contains("missing")));
        update(&folder, &headings()).expect("written");
        assert_eq!(check(&root, &folder), None);
        let first = text(&root, 0).expect("a commit");
        let actions: Vec<Value> = first.lines().map(|line| serde_json::from_str(line).expect("JSON")).collect();
        assert_eq!(actions.len(), 4);
        assert_eq!(actions[3]["add"]["path"], "runs/part-000001.parquet");
        assert_eq!(actions[3]["add"]["size"], 140);
        assert_eq!(actions[3]["add"]["stats"], "{\"numRecords\":40}");
        update(&folder, &headings()).expect("nothing to do");
        assert_eq!((text(&root, 0), text(&root, 1)), (Some(first.clone()), None));
        // the last part grows, and one is added
        commit(&folder, 1, 256);
        commit(&folder, 2, 7);
        assert!(check(&root, &folder).is_some_and(|what| what.contains("does not list")));
        update(&folder, &headings()).expect("written");
        assert_eq!((text(&root, 0), check(&root, &folder)), (Some(first), None));
        let second = text(&root, 1).expect("a commit");
        assert_eq!(second.lines().count(), 2);
        assert!(second.contains("part-000001") && second.contains("part-000002"), "{second}");
    }

    /// Law: a bit that changes anywhere in the log is found, and so are a file that is missing and one too many; a new log is then written.
    #[test]
    fn every_changed_byte_is_found() {
        let (root, folder) = dataset("damage");
        commit(&folder, 0, 256);
        update(&folder, &headings()).expect("written");
        commit(&folder, 1, 9);
        update(&folder, &headings()).expect("written");
        for version in 0..2 {
            let path = root.0.join(commit_of(version));
            let whole = std::fs::read(&path).expect("a commit");
            for at in 0..whole.len() {
                let mut changed = whole.clone();
                changed[at] ^= 1 << (at % 8);
                std::fs::write(&path, changed).expect("written");
                assert!(check(&root, &folder).is_some(), "commit {version}, byte {at}");
            }
            std::fs::write(&path, &whole).expect("written");
            assert_eq!(check(&root, &folder), None);
        }
        std::fs::remove_file(root.0.join(commit_of(0))).expect("removed");
        assert!(check(&root, &folder).is_some_and(|what| what.contains("not the next commit")));
        update(&folder, &headings()).expect("written again");
        assert_eq!((check(&root, &folder), text(&root, 1)), (None, None));
        let whole = text(&root, 0).expect("a commit");
        assert_eq!(whole.lines().count(), 4);
        // other numbers in an else sound log are no earlier state
        std::fs::write(root.0.join(commit_of(0)), whole.replacen("\"size\":", "\"size\":1", 1)).expect("written");
        assert!(check(&root, &folder).is_some_and(|what| what.contains("does not list")));
        update(&folder, &headings()).expect("written again");
        assert_eq!((text(&root, 0), text(&root, 1)), (Some(whole), None));
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
