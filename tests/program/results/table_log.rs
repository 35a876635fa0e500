//! The Delta Lake log of a result: what the published protocol asks for, read on its own, and by the packages that read
//! such tables.
//!
//! The protocol: <https://github.com/delta-io/delta/blob/master/PROTOCOL.md>. `SPINDRIFT_PYTHON` names the interpreter
//! (default: `python3`); packages that it does not have are skipped, and said so.

use std::collections::BTreeMap;
use std::fs;
use std::process::Command;

use parquet::basic::Type;
use parquet::file::reader::{FileReader, SerializedFileReader};
use serde_json::Value;

use crate::small_campaign::folder;
use crate::support::scratch_folder::ScratchFolder;

/// The actions of each commit of a result.
fn commits(scratch: &ScratchFolder, result: &str) -> Vec<Vec<Value>> {
    let mut names: Vec<String> = fs::read_dir(scratch.path(result).join("_delta_log"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    let expected: Vec<String> = (0..names.len()).map(|version| format!("{version:020}.json")).collect();
    assert_eq!(names, expected, "commits are numbered from zero without gaps");
    let actions = |name: &String| {
        let text = fs::read_to_string(scratch.path(result).join("_delta_log").join(name)).unwrap();
        text.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
    };
    names.iter().map(actions).collect()
}

/// What a reader of the protocol sees: the columns, and the files with their sizes and numbers of rows. A later `add`
/// of a file replaces an earlier one.
fn snapshot(commits: &[Vec<Value>]) -> (Value, BTreeMap<String, (u64, u64)>) {
    let mut files = BTreeMap::new();
    let mut columns = Value::Null;
    for (version, actions) in commits.iter().enumerate() {
        for (line, action) in actions.iter().enumerate() {
            let action = action.as_object().unwrap();
            assert_eq!(action.len(), 1, "one action a line");
            let (kind, body) = action.iter().next().unwrap();
            match (version, line, kind.as_str()) {
                (0, 0, "protocol") => {
                    assert_eq!((&body["minReaderVersion"], &body["minWriterVersion"]), (&1.into(), &2.into()));
                }
                (0, 1, "metaData") => {
                    assert_eq!(body["format"]["provider"], "parquet");
                    assert_eq!(body["partitionColumns"], Value::Array(Vec::new()));
                    assert_eq!(body["createdTime"], 0);
                    assert!(body["configuration"].as_object().unwrap().values().all(Value::is_string));
                    assert_eq!(body["id"].as_str().unwrap().len(), 36);
                    columns = serde_json::from_str(body["schemaString"].as_str().unwrap()).unwrap();
                }
                (_, 2.., "add") | (1.., _, "add") => {
                    assert!(body["partitionValues"].as_object().unwrap().is_empty());
                    assert_eq!((&body["modificationTime"], &body["dataChange"]), (&0.into(), &true.into()));
                    let statistics: Value = serde_json::from_str(body["stats"].as_str().unwrap()).unwrap();
                    let numbers = (body["size"].as_u64().unwrap(), statistics["numRecords"].as_u64().unwrap());
                    files.insert(body["path"].as_str().unwrap().to_owned(), numbers);
                }
                (1.., _, "remove") => {
                    assert_eq!((&body["deletionTimestamp"], &body["dataChange"]), (&0.into(), &true.into()));
                    files.remove(body["path"].as_str().unwrap()).expect("a file that was added");
                }
                other => panic!("{other:?} has no such action in its protocol version"),
            }
        }
    }
    (columns, files)
}

/// Law: the log lists every file of rows with its size and its number of rows, and its columns are those of the files,
/// with types that Delta Lake has, and a comment with unit and meaning.
#[test]
fn the_log_is_the_table() {
    let scratch = folder("table-log");
    scratch.prints("campaign small.toml --out r --audit 0.02", 0);
    let (columns, files) = snapshot(&commits(&scratch, "r"));
    let paths = scratch.part_files("r");
    assert_eq!(files.len(), paths.len());
    for (path, name) in paths.iter().zip(["runs/part-000000", "runs/part-000001", "versions/part-000002-000088"]) {
        let name = format!("{name}.parquet");
        assert!(fs::read(path).unwrap() == fs::read(scratch.path("r").join(&name)).unwrap(), "{name}");
        let reader = SerializedFileReader::new(fs::File::open(path).unwrap()).unwrap();
        let rows = reader.metadata().file_metadata().num_rows() as u64;
        assert_eq!(files[&name], (fs::metadata(path).unwrap().len(), rows), "{name}");
        let schema = reader.metadata().file_metadata().schema_descr_ptr();
        let fields = columns["fields"].as_array().unwrap();
        assert_eq!((&columns["type"], fields.len()), (&"struct".into(), schema.num_columns()));
        for (field, column) in fields.iter().zip(schema.columns()) {
            assert_eq!(field["name"], column.name());
            let kind = match column.physical_type() {
                Type::DOUBLE => "double",
                Type::INT64 => "long",
                Type::BYTE_ARRAY => "string",
                other => panic!("{}: {other}", column.name()),
            };
            let converted = column.converted_type().to_string();
            assert!(!converted.starts_with("UINT"), "{}: {converted}", column.name());
            assert_eq!(field["type"], kind, "{}", column.name());
            assert_eq!(field["nullable"], column.max_def_level() == 1, "{}", column.name());
            let [comment, unit, meaning] =
                ["comment", "unit", "meaning"].map(|key| field["metadata"][key].as_str().unwrap());
            assert!(!meaning.is_empty() && comment.starts_with(meaning) && comment.contains(unit), "{field}");
        }
    }
}

/// Law: more samples are one more commit, which leaves the first and every file that it lists as they were; another
/// question of the same rows is none. Files that are no part of the result are in no snapshot.
#[test]
fn an_extension_adds_a_commit() {
    let scratch = folder("table-log-grown");
    scratch.prints("campaign small.toml --samples 900 --out r", 0);
    let first = commits(&scratch, "r");
    let content = |name: &String| fs::read(scratch.path("r").join(name)).unwrap();
    let before: Vec<Vec<u8>> = snapshot(&first).1.keys().map(content).collect();
    scratch.file("other.toml", &crate::small_campaign::campaign().replace("\"small\"", "\"other\""));
    scratch.prints("campaign other.toml --samples 900 --out r", 0);
    assert_eq!(commits(&scratch, "r"), first);
    scratch.prints("campaign small.toml --samples 2000 --out r", 0);
    let all = commits(&scratch, "r");
    assert_eq!((all.len(), &all[0]), (2, &first[0]));
    assert!(before == snapshot(&first).1.keys().map(content).collect::<Vec<_>>(), "readers of the first version");
    assert_eq!(scratch.part_files("r").len(), snapshot(&all).1.len(), "the folder of rows has every row once");
    let rows = |files: &BTreeMap<String, (u64, u64)>| files.values().map(|(_, rows)| rows).sum::<u64>();
    assert_eq!((rows(&snapshot(&first).1), rows(&snapshot(&all).1)), (900, 2000));
    scratch.prints("verify r", 0);
}

/// What Python prints, or `None` where it does not have the package.
fn python(scratch: &ScratchFolder, package: &str, code: &str) -> Option<String> {
    let python = std::env::var("SPINDRIFT_PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let is_there = Command::new(&python).args(["-c", &format!("import {package}")]).output();
    if !is_there.is_ok_and(|output| output.status.success()) {
        println!("skipped: {python} does not have {package}");
        return None;
    }
    let output = Command::new(&python).args(["-c", code]).current_dir(&scratch.0).output().unwrap();
    assert!(output.status.success(), "{code}\n{}", String::from_utf8_lossy(&output.stderr));
    println!("ran {package}");
    Some(String::from_utf8(output.stdout).unwrap().trim().to_owned())
}

/// Law: the packages `deltalake` and polars open the folder as one table with the rows of its parts, and a foreign file
/// beside them is no part of it; after an extension they see the longer table.
#[test]
fn table_engines_read_the_result() {
    let scratch = folder("table-log-engines");
    let polars = "import polars as pl\nt = pl.read_delta('r')\n\
        f = pl.read_parquet('r/runs/part-*.parquet')\n\
        assert t.sort('sample_id').equals(f.sort('sample_id')), 'rows differ'\n\
        print(t.height, t['sample_id'].dtype)";
    let deltalake = "from deltalake import DeltaTable\nt = DeltaTable('r')\n\
        c = {field.name: field for field in t.schema().fields}\n\
        n = sum(t.get_add_actions(flatten=True).to_pydict()['num_records']) if \
        hasattr(t.get_add_actions(flatten=True), 'to_pydict') else \
        sum(x.as_py() for x in t.get_add_actions(flatten=True)['num_records'])\n\
        first = DeltaTable('r', version=0)\n\
        import pyarrow.parquet as pq\n\
        print(sum(pq.read_metadata(u.replace('file://', '')).num_rows for u in first.file_uris()), end=' ')\n\
        print(t.version(), len(t.file_uris()), n, c['sample_id'].type.type, c['energy_error_max'].metadata['comment'])";
    for (samples, version, parts) in [(600, 0, 3), (1100, 1, 5)] {
        scratch.prints(&format!("campaign small.toml --samples {samples} --out r"), 0);
        if let Some(said) = python(&scratch, "deltalake", deltalake) {
            assert!(said.starts_with(&format!("600 {version} {parts} {samples} long ")) && said.len() > 20, "{said}");
            if let Some(said) = python(&scratch, "polars", polars) {
                assert_eq!(said, format!("{samples} Int64"));
            }
        }
    }
}
