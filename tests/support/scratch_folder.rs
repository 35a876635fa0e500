//! A folder in which a test runs the program.

use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::Command;

use arrow_array::RecordBatch;
use parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder;

/// A folder of its own for each test, removed at its end.
pub struct ScratchFolder(pub PathBuf);

impl ScratchFolder {
    /// An empty folder; `name` is unique among all tests.
    pub fn new(name: &str) -> Self {
        let folder = std::env::temp_dir().join(format!("spindrift-{}-{name}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).unwrap();
        ScratchFolder(folder)
    }

    /// Runs a command on a shipped campaign and checks the exit code; returns both output streams.
    pub fn says(&self, command: &str, campaign: &str, arguments: &str, code: i32) -> String {
        let output = Command::new(env!("CARGO_BIN_EXE_spindrift"))
            .arg(command)
            .arg(Path::new(env!("CARGO_MANIFEST_DIR")).join("campaigns").join(campaign))
            .args(arguments.split_whitespace())
            .current_dir(&self.0)
            .output()
            .unwrap();
        let said = format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
        assert_eq!(output.status.code(), Some(code), "{command} {campaign} {arguments}:\n{said}");
        said
    }

    /// The first batch of a Parquet file in the folder.
    pub fn table(&self, file: &str) -> RecordBatch {
        let file = File::open(self.0.join(file)).unwrap();
        ParquetRecordBatchReaderBuilder::try_new(file).unwrap().build().unwrap().next().unwrap().unwrap()
    }
}

/// All batches of a Parquet file.
pub fn batches(path: &Path) -> Vec<RecordBatch> {
    let reader = ParquetRecordBatchReaderBuilder::try_new(File::open(path).unwrap()).unwrap().build().unwrap();
    reader.map(|batch| batch.unwrap()).collect()
}

impl Drop for ScratchFolder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}
