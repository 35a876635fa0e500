//! A fault at the k-th file operation, for every k: SQLite's method. Whatever fails, nothing half-written has a final name, and continuing
//! completes the dataset to the same bytes.

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};

use spindrift::campaign::{Overrides, Plan};
use spindrift::dataset::claim::{Claim, ClaimOptions, FolderError, claim};
use spindrift::dataset::identity::identity;
use spindrift::dataset::part_sink::write_parts;
use spindrift::dataset::rows_file::headings;
use spindrift::dataset::storage::{Disk, Entry, Storage};
use spindrift::dataset::table_log;
use spindrift::ensemble::{Ensemble, Parts, Supervision, run};
use spindrift::math::Isa;

use super::small_campaign::campaign_without_debris;
use crate::support::scratch_folder::ScratchFolder;

/// The disk, on which an operation fails.
#[derive(Debug)]
struct Faulty {
    /// Operations so far.
    done: AtomicU64,
    /// The operation that fails, from zero.
    fails: u64,
    /// Whether all later ones fail too.
    persists: bool,
    error: io::ErrorKind,
}

impl Faulty {
    fn new(fails: u64, persists: bool, error: io::ErrorKind) -> &'static Self {
        Box::leak(Box::new(Faulty { done: AtomicU64::new(0), fails, persists, error }))
    }

    fn is_due(&self) -> bool {
        let now = self.done.fetch_add(1, Ordering::Relaxed);
        now == self.fails || (self.persists && now > self.fails)
    }

    fn check(&self) -> io::Result<()> {
        if self.is_due() { Err(self.error.into()) } else { Ok(()) }
    }
}

impl Storage for Faulty {
    fn create(&self, path: &Path, bytes: &[u8]) -> io::Result<()> {
        if self.is_due() {
            // half of it is there
            Disk.create(path, &bytes[..bytes.len() / 2])?;
            return Err(self.error.into());
        }
        Disk.create(path, bytes)
    }

    fn append(&self, path: &Path, length: u64, bytes: &[u8]) -> io::Result<()> {
        if self.is_due() {
            Disk.append(path, length, &bytes[..bytes.len() / 2])?;
            return Err(self.error.into());
        }
        Disk.append(path, length, bytes)
    }

    fn read(&self, path: &Path, most: u64) -> io::Result<Vec<u8>> {
        self.check()?;
        Disk.read(path, most)
    }

    fn rename(&self, from: &Path, to: &Path) -> io::Result<()> {
        self.check()?;
        Disk.rename(from, to)
    }

    fn remove(&self, path: &Path) -> io::Result<()> {
        self.check()?;
        Disk.remove(path)
    }

    fn remove_folder(&self, path: &Path) -> io::Result<()> {
        self.check()?;
        Disk.remove_folder(path)
    }

    fn create_folder(&self, path: &Path) -> io::Result<()> {
        self.check()?;
        Disk.create_folder(path)
    }

    fn sync_folder(&self, path: &Path) -> io::Result<()> {
        self.check()?;
        Disk.sync_folder(path)
    }

    fn list(&self, path: &Path) -> io::Result<Vec<Entry>> {
        self.check()?;
        Disk.list(path)
    }
}

/// Ten seconds of waiting for a lock.
const LOCK_TRIES: usize = 2000;

/// Makes the dataset of `plan` in `root`, or what is missing of it.
fn make(storage: &'static dyn Storage, root: &Path, plan: &Plan) -> Result<(), String> {
    let ensemble = Ensemble::new(plan, Isa::best());
    let options = ClaimOptions { overwrite: false, shard: None, threads: 1 };
    let mut claimed = claim(storage, root, (plan, &identity(&ensemble)), options);
    // a process that another test is about to start has the lock too, from its fork to its exec
    for _ in 0..LOCK_TRIES {
        if !matches!(claimed, Err(FolderError::Busy { .. })) {
            break;
        }
        std::thread::sleep(std::time::Duration::from_millis(5));
        claimed = claim(storage, root, (plan, &identity(&ensemble)), options);
    }
    let ready = match claimed {
        Ok(Claim::Ready(ready)) => *ready,
        Ok(Claim::Finished(_)) => return Ok(()),
        Err(error @ FolderError::Foreign { .. }) => panic!("its own files are foreign: {error}"),
        Err(error) => return Err(error.to_string()),
    };
    let missing = ready.folder.missing(Parts::of(plan.samples).iter());
    write_parts(&ready.folder, &ensemble, None, |sink| {
        run(&ensemble, missing, std::num::NonZeroUsize::new(1), sink, Supervision::progress(&|_| {}))
    })
    .map_err(|error| error.to_string())?
    .map_err(|error| error.to_string())?;
    ready.folder.write("summary.json", b"{}").map_err(|error| error.to_string())?;
    table_log::update(&ready.folder, &headings(&ensemble)).map_err(|error| error.to_string())?;
    ready.folder.finish().map_err(|error| error.to_string())
}

fn contents(root: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    for folder in ["", "runs", "bands", "_delta_log"] {
        for entry in fs::read_dir(root.join(folder)).into_iter().flatten().map(Result::unwrap) {
            if entry.path().is_file() {
                let name = format!("{folder}/{}", entry.file_name().to_string_lossy());
                found.insert(name, fs::read(entry.path()).unwrap());
            }
        }
    }
    found
}

fn plan() -> Plan {
    let overrides = Overrides { samples: Some(520), ..Overrides::default() };
    Plan::from_text("small", &campaign_without_debris(), overrides).unwrap()
}

/// Law: a fault at any operation, once or from then on, of any kind, is an error that names the path; every file under a final name of a
/// part is whole; and the next attempt completes the dataset to the same bytes.
#[test]
fn every_operation_may_fail() {
    let (scratch, plan) = (ScratchFolder::new("faults"), plan());
    let counted = Faulty::new(u64::MAX, false, io::ErrorKind::Other);
    make(counted, &scratch.path("whole"), &plan).unwrap();
    let (operations, whole) = (counted.done.load(Ordering::Relaxed), contents(&scratch.path("whole")));
    assert!(operations > 40, "{operations} operations");
    let mut errors = 0;
    for (persists, kind) in [
        (false, io::ErrorKind::StorageFull),
        (true, io::ErrorKind::StorageFull),
        (true, io::ErrorKind::ReadOnlyFilesystem),
        (false, io::ErrorKind::Other),
    ] {
        for fails in 0..operations {
            let root = scratch.path("r");
            let _ = fs::remove_dir_all(&root);
            let ended = make(Faulty::new(fails, persists, kind), &root, &plan);
            if let Err(message) = &ended {
                errors += 1;
                assert!(message.contains("spindrift-"), "operation {fails}: no path in {message:?}");
            }
            for (name, bytes) in
                contents(&root).iter().filter(|(name, _)| name.ends_with(".parquet") || name.ends_with(".bands"))
            {
                assert!(*bytes == whole[name], "operation {fails}: {name} is not whole");
            }
            make(&Disk, &root, &plan).unwrap_or_else(|error| panic!("operation {fails}: {error}"));
            let now = contents(&root);
            assert_eq!(now.keys().collect::<Vec<_>>(), whole.keys().collect::<Vec<_>>(), "operation {fails}");
            assert!(now == whole, "operation {fails} ({kind:?}, persists: {persists})");
        }
    }
    // what fails once is repeated where that is safe; what fails for good is an error
    assert!(errors as u64 > 3 * operations / 2, "{errors} errors of {operations} operations");
}
