//! [`Failing`]: a folder in which the k-th operation fails, and a small dataset made in it.

use crate::prelude::*;
use std::{fs::TryLockError, io, sync::Arc};

use spindrift::{
    storage::{
        disk::folder,
        identity::{RowsMetadata, sealed, sha256},
        store::{Entry, Store},
    },
    workflow::{Outputs, WorkflowError as Failure},
};

pub use crate::support::scratch_folder::contents;

pub fn whole_parts(root: &Path) -> usize {
    let entries = fs::read_dir(root.join("runs")).into_iter().flatten().map(|entry| entry.unwrap().path());
    let files = entries.filter(|path| path.extension().is_some_and(|extension| extension == "parquet"));
    let check = |path: PathBuf| {
        // a part that is made again is removed first
        let Ok(bytes) = fs::read(&path) else { return };
        assert!(sealed(&bytes).is_some(), "{} is not whole", path.display());
        let rows = RowsMetadata::of(bytes.into()).unwrap();
        if let Ok(bands) = fs::read(root.join("bands").join(path.file_name().unwrap())) {
            assert!(rows.bands == Some(sha256(&bands)), "{}: of other bands", path.display());
        }
    };
    files.map(check).count()
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operation {
    Write,
    Read,
    List,
    Lock,
}

/// As an error of this kind, with half of a put file; after it was done; or with an error number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    Kind(io::ErrorKind),
    Late(io::ErrorKind),
    System(i32),
}

impl Fault {
    pub fn error(self) -> io::Error {
        match self {
            Fault::Kind(kind) | Fault::Late(kind) => kind.into(),
            Fault::System(number) => io::Error::from_raw_os_error(number),
        }
    }
}

#[derive(Debug)]
pub struct Plot {
    is_counted: fn(Operation) -> bool,
    fails: u64,
    persists: bool,
    fault: Fault,
    watched: Option<PathBuf>,
    done: Mutex<Vec<(Operation, PathBuf)>>,
}

impl Plot {
    pub fn new(is_counted: fn(Operation) -> bool, fails: u64, persists: bool, fault: Fault) -> Arc<Self> {
        Arc::new(Plot { is_counted, fails, persists, fault, watched: None, done: Mutex::default() })
    }

    pub fn harmless(is_counted: fn(Operation) -> bool) -> Arc<Self> {
        Plot::new(is_counted, u64::MAX, false, Fault::System(5))
    }

    /// No operation fails, and at each the parts of the dataset in `root` are whole.
    pub fn watched(root: &Path) -> Arc<Self> {
        let (fault, watched) = (Fault::System(5), Some(root.to_owned()));
        let is_counted = |operation| operation == Operation::Write;
        Arc::new(Plot { is_counted, fails: u64::MAX, persists: false, fault, watched, done: Mutex::default() })
    }

    pub fn done(&self) -> Vec<(Operation, PathBuf)> {
        self.done.lock().unwrap().clone()
    }

    fn is_due(&self, operation: Operation, path: &Path) -> bool {
        if !(self.is_counted)(operation) {
            return false;
        }
        self.watched.iter().for_each(|root| {
            whole_parts(root);
        });
        let mut done = self.done.lock().unwrap();
        let now = done.len() as u64;
        done.push((operation, path.to_owned()));
        now == self.fails || (self.persists && now > self.fails)
    }

    fn check(&self, operation: Operation, path: &Path) -> io::Result<()> {
        let is_due = self.is_due(operation, path);
        if is_due { Err(self.fault.error()) } else { Ok(()) }
    }
}

#[derive(Debug)]
struct Failing {
    plot: Arc<Plot>,
    disk: Arc<dyn Store>,
}

impl Failing {
    /// Makes the change, unless it fails; then `half` of it may be left.
    fn change(
        &self,
        name: &str,
        change: impl FnOnce() -> io::Result<()>,
        half: impl FnOnce() -> io::Result<()>,
    ) -> io::Result<()> {
        let failed = self.plot.check(Operation::Write, &self.disk.path(name));
        match (failed, self.plot.fault) {
            (Ok(()), _) => change(),
            (Err(error), Fault::Late(_)) => change().and(Err(error)),
            (Err(error), _) => half().and(Err(error)),
        }
    }

    fn half(&self, name: &str, bytes: &[u8]) -> io::Result<()> {
        let path = self.disk.path(&format!("{name}.0123456789abcdef.tmp"));
        fs::create_dir_all(path.parent().unwrap())?;
        fs::write(path, &bytes[..bytes.len() / 2])
    }
}

impl Store for Failing {
    fn root(&self) -> &Path {
        self.disk.root()
    }

    fn put(&self, name: &str, bytes: &[u8]) -> io::Result<()> {
        self.change(name, || self.disk.put(name, bytes), || self.half(name, bytes))
    }

    fn put_if_absent(&self, name: &str, bytes: &[u8]) -> io::Result<()> {
        self.change(name, || self.disk.put_if_absent(name, bytes), || self.half(name, bytes))
    }

    fn get(&self, name: &str) -> io::Result<Vec<u8>> {
        self.plot.check(Operation::Read, &self.disk.path(name))?;
        self.disk.get(name)
    }

    fn list(&self, folder: &str) -> io::Result<Vec<Entry>> {
        self.plot.check(Operation::List, &self.disk.path(folder))?;
        self.disk.list(folder)
    }

    fn remove(&self, name: &str) -> io::Result<()> {
        self.change(name, || self.disk.remove(name), || Ok(()))
    }

    fn lock(&self, _: bool) -> Result<Option<File>, TryLockError> {
        self.plot.check(Operation::Lock, self.root()).map(|()| None).map_err(TryLockError::Error)
    }

    fn rename(&self, to: &Path) -> io::Result<()> {
        self.change("", || self.disk.rename(to), || Ok(()))
    }
}

/// Does `work` with one thread in folders that fail by `plot`.
pub fn on(plot: &Arc<Plot>, work: impl FnOnce(&Session<'_>) -> Result<(), Failure>) -> Result<(), Failure> {
    let folders = |root: &Path| -> Arc<dyn Store> { Arc::new(Failing { plot: plot.clone(), disk: folder(root) }) };
    let watch = Quiet::default();
    let session = Session::new(&watch).unwrap().on_threads(NonZeroUsize::new(1));
    work(&Session { folders: &folders, ..session })
}

#[derive(Clone, Copy, Debug, Default)]
pub struct Making {
    pub samples: u64,
    pub seed: u64,
    pub has_page: bool,
    pub overwrite: bool,
}

impl Making {
    pub fn of(samples: u64) -> Self {
        Making { samples, seed: 7, ..Making::default() }
    }

    /// Makes the dataset in `root`, or completes it, with few columns since it is made a thousand times.
    pub fn make(self, plot: &Arc<Plot>, root: &Path) -> Result<(), Failure> {
        let observed = "points = 11\ngroups = [\"energy_conservation\"]\n";
        let text = campaign_without_debris().replace("points = 11\n", observed);
        let text = format!("{text}[retain]\ntrajectories = \"sample:2\"\n");
        on(plot, |session| {
            let outputs = Outputs { without_page: !self.has_page, ..Outputs::default() };
            let campaign = Campaign::from_text("small.toml", &text, *session).samples(self.samples).seed(self.seed);
            let campaign = campaign.store(root).outputs(outputs);
            let campaign = if self.overwrite { campaign.overwrite() } else { campaign };
            campaign.prepare()?.unwrap().run().map(|_| ())
        })
    }
}

pub fn made(making: Making, root: &Path) -> BTreeMap<String, Vec<u8>> {
    making.make(&Plot::harmless(|_| false), root).unwrap_or_else(|error| panic!("{error:?}"));
    contents(root)
}

pub fn reason(failure: &Failure) -> &str {
    let (Failure::Files(reason) | Failure::Input(reason)) = failure;
    reason
}
