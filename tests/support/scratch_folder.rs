//! A folder in which a test runs the program.

use super::prelude::*;
use arrow_array::StringArray;

use spindrift::storage::{disk::folder, rows_reader::RowsReader};

use super::parquet_tables;

/// Waiting for a disk is half of the time of the tests.
const IN_MEMORY: &str = "/dev/shm";
const ENOUGH: u64 = 2 << 30;

fn base() -> PathBuf {
    #[cfg(unix)]
    if std::env::var_os("TMPDIR").is_none()
        && let Ok(found) = rustix::fs::statvfs(IN_MEMORY)
        && found.f_bavail.saturating_mul(found.f_frsize) >= ENOUGH
    {
        return PathBuf::from(IN_MEMORY);
    }
    std::env::temp_dir()
}

/// A folder of its own for each test, removed at its end.
pub struct ScratchFolder(pub PathBuf);

impl ScratchFolder {
    pub fn new(name: &str) -> Self {
        let folder = base().join(format!("spindrift-{}-{name}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).unwrap();
        ScratchFolder(folder)
    }

    pub fn file(&self, name: &str, text: &str) {
        fs::write(self.path(name), text).unwrap();
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    pub fn text(&self, name: &str) -> String {
        fs::read_to_string(self.path(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    pub fn command(&self, arguments: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_spindrift"));
        command.args(arguments.split_whitespace()).current_dir(&self.0);
        command
    }

    pub fn prints(&self, arguments: &str, code: i32) -> String {
        self.outputs(&mut self.command(arguments), code)
    }

    pub fn small(&self, options: &str, code: i32) -> String {
        self.prints(&format!("campaign small.toml {options}"), code)
    }

    pub fn shows(&self, arguments: &str, code: i32, words: &str) {
        assert_says(self.prints(arguments, code), [words]);
    }

    pub fn small_shows(&self, options: &str, code: i32, words: &str) {
        self.shows(&format!("campaign small.toml {options}"), code, words);
    }

    pub fn prints_wide(&self, arguments: &str, code: i32) -> String {
        self.prints_at(arguments, code, 1000)
    }

    pub fn prints_at(&self, arguments: &str, code: i32, width: usize) -> String {
        self.outputs(self.command(arguments).env("COLUMNS", width.to_string()), code)
    }

    pub fn says(&self, command: &str, campaign: &str, arguments: &str, code: i32) -> String {
        let campaign = Path::new(env!("CARGO_MANIFEST_DIR")).join("campaigns").join(campaign);
        let mut program = Command::new(env!("CARGO_BIN_EXE_spindrift"));
        self.outputs(program.arg(command).arg(campaign).args(arguments.split_whitespace()), code)
    }

    pub fn outputs(&self, program: &mut Command, code: i32) -> String {
        let output = program.current_dir(&self.0).output().unwrap();
        let said = format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
        assert_eq!(output.status.code(), Some(code), "{program:?}:\n{said}");
        said
    }

    pub fn part_files(&self, result: &str) -> Vec<PathBuf> {
        let entries = fs::read_dir(self.path(result).join("runs")).unwrap();
        let mut files: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
        files.sort();
        files
    }

    pub fn reader(&self, result: &str) -> RowsReader {
        let names = |folder: &str| {
            let entries = fs::read_dir(self.path(result).join(folder)).into_iter().flatten();
            let name = |entry: fs::DirEntry| format!("{folder}/{}", entry.file_name().to_string_lossy());
            let mut names: Vec<String> = entries.map(|entry| name(entry.unwrap())).collect();
            names.sort();
            names
        };
        RowsReader::new(folder(&self.path(result)), names("runs"), names("bands"))
    }

    pub fn parts(&self, result: &str) -> Vec<(String, Vec<u8>)> {
        let content = |path: PathBuf| (path.file_name().unwrap().to_str().unwrap().to_owned(), fs::read(path).unwrap());
        self.part_files(result).into_iter().map(content).collect()
    }

    pub fn rows(&self, result: &str) -> Vec<RecordBatch> {
        self.part_files(result).iter().flat_map(|file| batches(file)).collect()
    }

    pub fn summary(&self, result: &str) -> serde_json::Value {
        serde_json::from_slice(&fs::read(self.path(result).join("summary.json")).unwrap()).unwrap()
    }

    pub fn table(&self, file: &str) -> RecordBatch {
        batches(&self.0.join(file)).swap_remove(0)
    }
}

#[track_caller]
pub fn assert_says<const N: usize>(said: impl AsRef<str>, words: [&str; N]) {
    let said = said.as_ref();
    words.iter().for_each(|words| assert!(said.contains(words), "{words:?} is not in:\n{said}"));
}

pub fn assert_fits(said: &str, lines: usize, width: usize) {
    assert!(said.lines().count() <= lines, "{} lines:\n{said}", said.lines().count());
    assert!(said.lines().all(|line| line.chars().count() <= width), "{said}");
}

pub fn contents(root: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    let mut folders = vec![root.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(&folder).into_iter().flatten().map(Result::unwrap) {
            let path = entry.path();
            if path.is_dir() {
                folders.push(path);
            } else {
                let name = path.strip_prefix(root).unwrap().to_string_lossy().into_owned();
                found.insert(name, fs::read(&path).unwrap());
            }
        }
    }
    found
}

pub fn batches(path: &Path) -> Vec<RecordBatch> {
    parquet_tables::groups(path)
}

pub fn texts<'b>(batch: &'b RecordBatch, name: &str) -> &'b StringArray {
    batch.column_by_name(name).unwrap_or_else(|| panic!("no column {name}")).as_string()
}

pub fn floats(batch: &RecordBatch, name: &str) -> Vec<f64> {
    let column = batch.column_by_name(name).unwrap_or_else(|| panic!("no column {name}"));
    column.as_primitive::<Float64Type>().iter().map(|value| value.unwrap_or(f64::NAN)).collect()
}

pub fn column(rows: &[RecordBatch], name: &str) -> Vec<f64> {
    let of = |batch: &RecordBatch| -> Vec<f64> {
        let column = batch.column_by_name(name).unwrap_or_else(|| panic!("no column {name}"));
        match column.as_primitive_opt::<Int64Type>() {
            Some(counts) => counts.iter().map(|count| count.map_or(f64::NAN, |count| count as f64)).collect(),
            None => floats(batch, name),
        }
    };
    rows.iter().flat_map(of).collect()
}

pub fn ended(rows: &[RecordBatch]) -> Vec<(u64, String)> {
    let statuses = rows
        .iter()
        .flat_map(|batch| texts(batch, "status").iter().map(|status| status.unwrap().to_owned()).collect::<Vec<_>>());
    column(rows, "sample_id").into_iter().map(|sample| sample as u64).zip(statuses).collect()
}

impl Drop for ScratchFolder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}
