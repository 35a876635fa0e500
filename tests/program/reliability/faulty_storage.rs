//! [`Faulty`]: the disk, on which the k-th operation fails; and the making of a small dataset on it.

use std::collections::BTreeMap;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, Write};
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};

use serde_json::Value;
use spindrift::campaign::{Overrides, Plan};
use spindrift::ensemble::{Ensemble, Parts, Supervision, run};
use spindrift::math::Isa;
use spindrift::storage::claim::{Claim, ClaimOptions, FolderError, claim};
use spindrift::storage::disk::{Disk, Entry, Storage};
use spindrift::storage::identity::sha256;
use spindrift::storage::part_sink::write_parts;
use spindrift::storage::rows_file::identity;
use spindrift::storage::stored_file::StoredFile;
use spindrift::workflow::finishing::{Finishing, complete};
use spindrift::workflow::{Outputs, Quiet, Session, WorkflowError as Failure};

use crate::small_campaign::campaign_without_debris;
pub use crate::support::scratch_folder::contents;

/// A file that a manifest lists.
#[derive(Debug)]
pub struct ListedFile {
    pub path: PathBuf,
    pub bytes: u64,
    pub sha256: String,
}

/// The files of the parts that the manifests of a dataset list; lines that are cut off list nothing.
pub fn listed_files(root: &Path) -> Vec<ListedFile> {
    let shards = fs::read_dir(root.join("shards")).into_iter().flatten().map(|entry| entry.unwrap().path());
    let mut parts = BTreeMap::new();
    for manifest in shards.chain([root.join("manifest.jsonl")]) {
        let text = fs::read_to_string(manifest).unwrap_or_default();
        for line in text.lines().filter_map(|line| serde_json::from_str::<Value>(line).ok()) {
            if let Some(part) = line["part"].as_u64() {
                parts.insert(part, line["files"].as_array().unwrap().clone());
            }
            line["dropped"].as_u64().map(|dropped| parts.remove(&dropped));
        }
    }
    let file = |file: &Value| ListedFile {
        path: root.join(file["name"].as_str().unwrap()),
        bytes: file["bytes"].as_u64().unwrap(),
        sha256: file["sha256"].as_str().unwrap().to_owned(),
    };
    parts.values().flatten().map(file).collect()
}

/// What is done to a file or folder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operation {
    /// Everything that changes it.
    Write,
    /// It is opened.
    Open,
    /// Its length is asked for.
    Length,
    /// A piece of it is read.
    Read,
    /// The entries of a folder are listed.
    List,
    /// It is locked.
    Lock,
}

/// How an operation fails.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// An error of this kind.
    Kind(io::ErrorKind),
    /// The error of the operating system with this number.
    System(i32),
    /// Of a read: there is nothing more.
    End,
    /// Of a read: it is interrupted, or has some of the bytes only. No error.
    Piecewise,
    /// Of a new file: its last bit is another one. No error.
    Altered,
}

impl Fault {
    /// The error; none where it is told otherwise.
    pub fn error(self) -> Option<io::Error> {
        match self {
            Fault::Kind(kind) => Some(kind.into()),
            Fault::System(number) => Some(io::Error::from_raw_os_error(number)),
            Fault::End | Fault::Piecewise | Fault::Altered => None,
        }
    }
}

/// The disk, on which an operation fails.
#[derive(Debug)]
pub struct Faulty(Arc<Plot>);

/// Which operation fails, and what was done so far.
#[derive(Debug)]
struct Plot {
    /// Which operations are counted, and may fail.
    is_counted: fn(Operation) -> bool,
    /// The operation that fails, from zero.
    fails: u64,
    /// Whether all later ones fail too.
    persists: bool,
    fault: Fault,
    /// The dataset whose listed parts are checked before every operation.
    watched: Option<PathBuf>,
    done: Mutex<Vec<(Operation, PathBuf)>>,
}

impl Faulty {
    /// The disk on which operation `fails` of those that are counted fails, and all later ones where it `persists`.
    pub fn new(is_counted: fn(Operation) -> bool, fails: u64, persists: bool, fault: Fault) -> &'static Self {
        Self::leaked(Plot { is_counted, fails, persists, fault, watched: None, done: Mutex::default() })
    }

    /// The disk without a fault, on which at every operation each part that the dataset in `root` lists is there and
    /// whole.
    pub fn watched(root: &Path) -> &'static Self {
        let (fault, watched) = (Fault::Kind(io::ErrorKind::Other), Some(root.to_owned()));
        let is_counted = |operation| operation == Operation::Write;
        Self::leaked(Plot { is_counted, fails: u64::MAX, persists: false, fault, watched, done: Mutex::default() })
    }

    fn leaked(plot: Plot) -> &'static Self {
        Box::leak(Box::new(Faulty(Arc::new(plot))))
    }

    /// The operations that were counted so far, each with its path.
    pub fn done(&self) -> Vec<(Operation, PathBuf)> {
        self.0.done.lock().unwrap().clone()
    }

    fn check(&self, operation: Operation, path: &Path) -> io::Result<()> {
        self.0.check(operation, path)
    }
}

impl Plot {
    fn is_due(&self, operation: Operation, path: &Path) -> bool {
        if !(self.is_counted)(operation) {
            return false;
        }
        for file in self.watched.iter().flat_map(|root| listed_files(root)) {
            let bytes = fs::read(&file.path).unwrap_or_else(|error| panic!("{}: {error}", file.path.display()));
            assert!(
                sha256(&bytes) == file.sha256,
                "{} is listed and not whole before {operation:?} of {}",
                file.path.display(),
                path.display()
            );
        }
        let mut done = self.done.lock().unwrap();
        let now = done.len() as u64;
        done.push((operation, path.to_owned()));
        now == self.fails || (self.persists && now > self.fails)
    }

    fn check(&self, operation: Operation, path: &Path) -> io::Result<()> {
        match self.fault.error() {
            Some(error) if self.is_due(operation, path) => Err(error),
            Some(_) => Ok(()),
            None => {
                self.is_due(operation, path);
                Ok(())
            }
        }
    }
}

/// [`Disk::create`] without a flush: no power is lost here, and the tests create some ten thousand files.
fn create(path: &Path, bytes: &[u8]) -> io::Result<()> {
    OpenOptions::new().write(true).create_new(true).open(path)?.write_all(bytes)
}

/// [`Disk::append`] without a flush.
fn append(path: &Path, length: u64, bytes: &[u8]) -> io::Result<()> {
    let mut file = OpenOptions::new().append(true).open(path)?;
    file.set_len(length)?;
    file.write_all(bytes)
}

impl Storage for Faulty {
    fn create(&self, path: &Path, bytes: &[u8]) -> io::Result<()> {
        if self.0.fault == Fault::Altered {
            let mut written = bytes.to_vec();
            if self.0.is_due(Operation::Write, path) {
                match written.last_mut() {
                    Some(last) => *last ^= 1,
                    None => written.push(0),
                }
            }
            return create(path, &written);
        }
        if let Err(error) = self.check(Operation::Write, path) {
            // half of it is there
            create(path, &bytes[..bytes.len() / 2])?;
            return Err(error);
        }
        create(path, bytes)
    }

    fn append(&self, path: &Path, length: u64, bytes: &[u8]) -> io::Result<()> {
        if let Err(error) = self.check(Operation::Write, path) {
            append(path, length, &bytes[..bytes.len() / 2])?;
            return Err(error);
        }
        append(path, length, bytes)
    }

    fn open(&self, path: &Path) -> io::Result<Box<dyn StoredFile>> {
        self.check(Operation::Open, path)?;
        Ok(Box::new(FaultyFile { plot: self.0.clone(), path: path.to_owned(), file: Disk.open(path)? }))
    }

    fn lock(&self, path: &Path, _: bool) -> Result<Option<File>, TryLockError> {
        // no real lock: a process that another test is about to start would have it too, from its fork to its exec
        self.check(Operation::Lock, path).map(|()| None).map_err(TryLockError::Error)
    }

    fn rename(&self, from: &Path, to: &Path) -> io::Result<()> {
        self.check(Operation::Write, from)?;
        Disk.rename(from, to)
    }

    fn link(&self, from: &Path, to: &Path) -> io::Result<()> {
        self.check(Operation::Write, to)?;
        Disk.link(from, to)
    }

    fn remove(&self, path: &Path) -> io::Result<()> {
        self.check(Operation::Write, path)?;
        Disk.remove(path)
    }

    fn remove_folder(&self, path: &Path) -> io::Result<()> {
        self.check(Operation::Write, path)?;
        Disk.remove_folder(path)
    }

    fn create_folder(&self, path: &Path) -> io::Result<()> {
        self.check(Operation::Write, path)?;
        Disk.create_folder(path)
    }

    fn sync_folder(&self, path: &Path) -> io::Result<()> {
        self.check(Operation::Write, path)?;
        if path.is_dir() { Ok(()) } else { Err(io::ErrorKind::NotFound.into()) }
    }

    fn entries(&self, path: &Path) -> io::Result<Vec<Entry>> {
        self.check(Operation::List, path)?;
        Disk.entries(path)
    }
}

/// An open file of a [`Faulty`] disk.
#[derive(Debug)]
struct FaultyFile {
    plot: Arc<Plot>,
    path: PathBuf,
    file: Box<dyn StoredFile>,
}

impl StoredFile for FaultyFile {
    fn length(&self) -> io::Result<u64> {
        self.plot.check(Operation::Length, &self.path)?;
        self.file.length()
    }

    fn read_at(&self, offset: u64, bytes: &mut [u8]) -> io::Result<usize> {
        if !self.plot.is_due(Operation::Read, &self.path) {
            return self.file.read_at(offset, bytes);
        }
        match self.plot.fault {
            Fault::End => Ok(0),
            Fault::Piecewise if self.plot.done.lock().unwrap().len().is_multiple_of(2) => {
                Err(io::ErrorKind::Interrupted.into())
            }
            Fault::Piecewise => {
                let some = bytes.len().div_ceil(2);
                self.file.read_at(offset, &mut bytes[..some])
            }
            Fault::Kind(_) | Fault::System(_) | Fault::Altered => self.plot.fault.error().map_or(Ok(0), Err),
        }
    }
}

/// Tries of a command whose folder is locked: a process that another test is about to start has the lock too, from its
/// fork to its exec, which on a loaded machine takes longer than the command waits.
const LOCK_TRIES: usize = 30;

/// What `command` returns, as soon as no other process has the lock.
pub fn unlocked(command: impl Fn() -> Result<(), Failure>) -> Result<(), Failure> {
    let is_locked = |ended: &Result<(), Failure>| {
        ended.as_ref().is_err_and(|failure| reason(failure).contains("another process is using"))
    };
    let mut ended = command();
    for _ in 0..LOCK_TRIES {
        if !is_locked(&ended) {
            break;
        }
        ended = command();
    }
    ended
}

/// Makes the dataset of `plan` in `root`, or what is missing of it, with its page or without.
pub fn make(storage: &'static dyn Storage, root: &Path, plan: &Plan, has_page: bool) -> Result<(), Failure> {
    make_with(ClaimOptions { overwrite: false, shard: None, threads: 1 }, storage, root, plan, has_page)
}

/// The same with these options.
pub fn make_with(
    options: ClaimOptions,
    storage: &'static dyn Storage,
    root: &Path,
    plan: &Plan,
    has_page: bool,
) -> Result<(), Failure> {
    let ensemble = Ensemble::new(plan, Isa::best());
    let mut claimed = claim(storage, root, (plan, &identity(&ensemble)), options);
    for _ in 0..LOCK_TRIES {
        if !matches!(claimed, Err(FolderError::Busy { .. })) {
            break;
        }
        claimed = claim(storage, root, (plan, &identity(&ensemble)), options);
    }
    let ready = match claimed {
        Ok(Claim::Ready(ready)) => *ready,
        Ok(Claim::Finished(_)) => return Ok(()),
        Err(error @ FolderError::Foreign { .. }) => panic!("its own files are foreign: {error}"),
        Err(error) => return Err(Failure::files(error)),
    };
    let missing = ready.folder.missing(Parts::of(plan.samples).iter());
    // a last part that is made again with its further rows
    let is_there = |part: &u64| ready.folder.parts().iter().any(|record| record.part == *part);
    ready.folder.drop_parts(missing.iter().map(|part| part.id.0).filter(is_there)).map_err(Failure::files)?;
    write_parts(&ready.folder, &ensemble, (None, &|_| Ok(())), |sink| {
        run(&ensemble, missing, NonZeroUsize::new(1), sink, Supervision::progress(&|_| {}))
    })
    .map_err(Failure::files)?
    .map_err(Failure::files)?;
    let outputs = Outputs { without_page: !has_page, ..Outputs::default() };
    on(storage, |session| {
        let job =
            Finishing { session: *session, ensemble: &ensemble, ready: &ready, root, outputs: &outputs, made: None };
        complete(&job, None).map(|_| ())
    })
}

/// Does `work` on `storage` with one thread.
pub fn on(
    storage: &'static dyn Storage,
    work: impl FnOnce(&Session<'_>) -> Result<(), Failure>,
) -> Result<(), Failure> {
    let watch = Quiet::default();
    let session = Session::new(&watch).expect("an instruction set").on_threads(NonZeroUsize::new(1));
    work(&Session { storage, ..session })
}

/// The reason of a failure.
pub fn reason(failure: &Failure) -> &str {
    let (Failure::Files(reason) | Failure::Input(reason)) = failure;
    reason
}

/// `samples` samples in parts of 256; few columns, since the work is done a thousand times.
pub fn plan(samples: u64) -> Plan {
    let overrides = Overrides { samples: Some(samples), ..Overrides::default() };
    let observed = "points = 11\ngroups = [\"energy_conservation\"]\n";
    let text = campaign_without_debris().replace("points = 11\n", observed);
    let text = format!("{text}[retain]\ntrajectories = \"sample:2\"\n");
    Plan::from_text("small", &text, overrides).unwrap()
}
