//! [`Folder`]: the folder of one result.
//!
//! ```text
//! results/<name>/plan.toml                 the resolved plan, written first
//! results/<name>/runs/part-000000.parquet  one file per part, each whole or absent
//! results/<name>/summary.json              written last: it marks the result as complete
//! ```
//! A folder with a plan and without a summary is an unfinished result. Only files of these names are ever removed.

use std::fs::{self, File, TryLockError};
use std::io;
use std::path::{Path, PathBuf};

use serde_json::Value;
use thiserror::Error;

use crate::campaign::Plan;
use crate::dataset::atomic;
use crate::dataset::rows_file::file_name;
use crate::ensemble::{PartId, Parts};

const PLAN: &str = "plan.toml";
const RUNS: &str = "runs";
const SUMMARY: &str = "summary.json";

/// Why a folder cannot take a result.
#[derive(Debug, Error)]
pub enum FolderError {
    /// It has the result of another plan.
    #[error(
        "`{folder}` contains the result of another plan (hash {found}, this one is {expected}); choose another --out, or replace it with --overwrite"
    )]
    Occupied {
        /// The folder.
        folder: String,
        /// Hash of the plan that is there.
        found: String,
        /// Hash of the plan to be run.
        expected: String,
    },
    /// It has the unfinished result of another plan.
    #[error(
        "`{folder}` contains an unfinished result of another plan; choose another --out, or replace it with --overwrite"
    )]
    Leftover {
        /// The folder.
        folder: String,
    },
    /// It is marked as complete, and files are missing.
    #[error("`{folder}` is damaged: `{missing}` is missing; run it again with --overwrite")]
    Damaged {
        /// The folder.
        folder: String,
        /// The file.
        missing: String,
    },
    /// It has something else.
    #[error("`{folder}` exists and is not a result of spindrift; choose another --out")]
    Foreign {
        /// The folder.
        folder: String,
    },
    /// Another process writes to it.
    #[error("another process is writing to `{folder}`; wait for it, or choose another --out")]
    Busy {
        /// The folder.
        folder: String,
    },
    /// A file operation failed.
    #[error("{path}: {source}")]
    Io {
        /// The file or folder.
        path: String,
        /// Why.
        source: io::Error,
    },
}

/// The state of the folder of a result.
#[derive(Debug)]
pub enum Claim {
    /// The folder is ready for the result.
    Ready(Folder),
    /// The result of the same plan is complete there; the text of its summary.
    Finished(String),
}

/// A folder that is ready for a result, locked against other processes until it is dropped.
#[derive(Debug)]
pub struct Folder {
    root: PathBuf,
    /// Whether an unfinished result of the same plan was found and cleared.
    pub restarted: bool,
    _lock: Option<File>,
}

fn failed(path: &Path) -> impl FnOnce(io::Error) -> FolderError + use<> {
    let path = path.display().to_string();
    move |source| FolderError::Io { path, source }
}

impl Folder {
    /// Prepares `root` for the result of `plan`, unless that result is already complete.
    ///
    /// # Errors
    /// Where the folder has something that must not be replaced, or a file operation fails.
    pub fn claim(root: &Path, plan: &Plan, overwrite: bool) -> Result<Claim, FolderError> {
        let folder = root.display().to_string();
        fs::create_dir_all(root).map_err(failed(root))?;
        let lock = lock(root)?;
        let summary = root.join(SUMMARY);
        let unfinished = root.join(PLAN).is_file();
        let mut restarted = false;
        if summary.is_file() {
            let text = fs::read_to_string(&summary).map_err(failed(&summary))?;
            let Some(found) = plan_hash(&text) else { return Err(FolderError::Foreign { folder }) };
            if !overwrite {
                let expected = plan.hash();
                if found != expected {
                    return Err(FolderError::Occupied { folder, found, expected });
                }
                return match missing(root, plan) {
                    Some(missing) => Err(FolderError::Damaged { folder, missing }),
                    None => Ok(Claim::Finished(text)),
                };
            }
        } else if unfinished {
            restarted = fs::read_to_string(root.join(PLAN)).is_ok_and(|text| text == plan.text());
            if !restarted && !overwrite {
                return Err(FolderError::Leftover { folder });
            }
        } else if !is_blank(root).map_err(failed(root))? {
            return Err(FolderError::Foreign { folder });
        }
        clear(root)?;
        let runs = root.join(RUNS);
        fs::create_dir_all(&runs).map_err(failed(&runs))?;
        let path = root.join(PLAN);
        atomic::write_bytes(&path, plan.text().as_bytes()).map_err(failed(&path))?;
        Ok(Claim::Ready(Folder { root: root.to_owned(), restarted, _lock: lock }))
    }

    /// The file of `part`.
    pub fn part(&self, part: PartId) -> PathBuf {
        self.root.join(RUNS).join(file_name(part))
    }

    /// Completes the result with its summary, after everything else is on the disk.
    ///
    /// # Errors
    /// Where a file operation fails.
    pub fn finish(&self, summary: &str) -> Result<(), FolderError> {
        let runs = self.root.join(RUNS);
        atomic::sync_folder(&runs).map_err(failed(&runs))?;
        let path = self.root.join(SUMMARY);
        atomic::write_bytes(&path, summary.as_bytes()).map_err(failed(&path))?;
        atomic::sync_folder(&self.root).map_err(failed(&self.root))
    }

    /// Total size of the files of rows, bytes.
    ///
    /// # Errors
    /// Where a file operation fails.
    pub fn size(&self) -> Result<u64, FolderError> {
        let runs = self.root.join(RUNS);
        let mut size = 0;
        for entry in fs::read_dir(&runs).map_err(failed(&runs))? {
            size += entry.and_then(|entry| entry.metadata()).map_err(failed(&runs))?.len();
        }
        Ok(size)
    }
}

/// Locks `root` against other processes of this program; no lock where the file system has none.
fn lock(root: &Path) -> Result<Option<File>, FolderError> {
    let Ok(file) = File::open(root) else { return Ok(None) };
    match file.try_lock() {
        Ok(()) => Ok(Some(file)),
        Err(TryLockError::WouldBlock) => Err(FolderError::Busy { folder: root.display().to_string() }),
        Err(TryLockError::Error(_)) => Ok(None),
    }
}

/// The hash in a summary; `None` where it is not one of this program.
fn plan_hash(summary: &str) -> Option<String> {
    let value: Value = serde_json::from_str(summary).ok()?;
    Some(value.get("plan_hash")?.as_str()?.to_owned())
}

/// The first file that a complete result of `plan` should have and does not have.
fn missing(root: &Path, plan: &Plan) -> Option<String> {
    let files = Parts::of(plan.samples).iter().map(|part| Path::new(RUNS).join(file_name(part.id)));
    files.chain([PathBuf::from(PLAN)]).find(|file| !root.join(file).is_file()).map(|file| file.display().to_string())
}

/// Whether `root` has nothing but temporary files of a campaign that was stopped before it wrote its plan.
fn is_blank(root: &Path) -> io::Result<bool> {
    for entry in fs::read_dir(root)? {
        if !entry?.file_name().to_string_lossy().ends_with(atomic::UNFINISHED) {
            return Ok(false);
        }
    }
    Ok(true)
}

/// Removes the files of a result: first the summary, so that a partly removed result is never taken for a complete one.
fn clear(root: &Path) -> Result<(), FolderError> {
    let runs = root.join(RUNS);
    let mut files = vec![root.join(SUMMARY), atomic::unfinished(&root.join(SUMMARY))];
    if runs.is_dir() {
        for entry in fs::read_dir(&runs).map_err(failed(&runs))? {
            let path = entry.map_err(failed(&runs))?.path();
            let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
            let whole = name.strip_suffix(atomic::UNFINISHED).unwrap_or(&name);
            if whole.starts_with("part-") && whole.ends_with(".parquet") {
                files.push(path);
            }
        }
    }
    files.extend([atomic::unfinished(&root.join(PLAN)), root.join(PLAN)]);
    for path in files {
        match fs::remove_file(&path) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(failed(&path)(error)),
            _ => {}
        }
    }
    Ok(())
}
