//! A fault at the k-th file operation, for every k: SQLite's method. Whatever fails, nothing half-written has a final name, and continuing
//! completes the dataset to the same bytes.

use std::collections::BTreeMap;
use std::fs::{self, OpenOptions};
use std::io::{self, Write};
use std::num::NonZeroUsize;
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};

use spindrift::campaign::{Overrides, Plan};
use spindrift::cli::command_outcome::Failure;
use spindrift::cli::finish_campaign::{Finishing, complete};
use spindrift::dataset::claim::{Claim, ClaimOptions, FolderError, claim};
use spindrift::dataset::identity::identity;
use spindrift::dataset::part_sink::write_parts;
use spindrift::dataset::storage::{Disk, Entry, Storage};
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

/// [`Disk::create`] without a flush: no power is lost here, and the test creates some ten thousand files.
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
        if self.is_due() {
            // half of it is there
            create(path, &bytes[..bytes.len() / 2])?;
            return Err(self.error.into());
        }
        create(path, bytes)
    }

    fn append(&self, path: &Path, length: u64, bytes: &[u8]) -> io::Result<()> {
        if self.is_due() {
            append(path, length, &bytes[..bytes.len() / 2])?;
            return Err(self.error.into());
        }
        append(path, length, bytes)
    }

    fn read(&self, path: &Path, most: u64) -> io::Result<Vec<u8>> {
        self.check()?;
        Disk.read(path, most)
    }

    fn has(&self, path: &Path, bytes: &[u8]) -> io::Result<bool> {
        self.check()?;
        Disk.has(path, bytes)
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
        if path.is_dir() { Ok(()) } else { Err(io::ErrorKind::NotFound.into()) }
    }

    fn list(&self, path: &Path) -> io::Result<Vec<Entry>> {
        self.check()?;
        Disk.list(path)
    }
}

/// Ten seconds of waiting for a lock.
const LOCK_TRIES: usize = 2000;

/// Makes the dataset of `plan` in `root`, or what is missing of it, with its page or without.
fn make(storage: &'static dyn Storage, root: &Path, plan: &Plan, has_page: bool) -> Result<(), String> {
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
        run(&ensemble, missing, NonZeroUsize::new(1), sink, Supervision::progress(&|_| {}))
    })
    .map_err(|error| error.to_string())?
    .map_err(|error| error.to_string())?;
    let job = Finishing {
        ensemble: &ensemble,
        ready: &ready,
        root,
        threads: NonZeroUsize::new(1),
        replayed: "small.toml",
        junit: None,
        page: (has_page, None),
        made: None,
        seconds: [0.0; 2],
    };
    match complete(&job, None) {
        Ok(_) => Ok(()),
        Err(Failure::Files(message) | Failure::Input(message)) => Err(message),
    }
}

fn contents(root: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    for folder in ["", "runs", "bands", "trajectories", "_delta_log"] {
        for entry in fs::read_dir(root.join(folder)).into_iter().flatten().map(Result::unwrap) {
            if entry.path().is_file() {
                let name = format!("{folder}/{}", entry.file_name().to_string_lossy());
                found.insert(name, fs::read(entry.path()).unwrap());
            }
        }
    }
    found
}

/// Three parts; few columns, since the work is done a thousand times.
fn plan() -> Plan {
    let overrides = Overrides { samples: Some(520), ..Overrides::default() };
    let observed = "points = 11\ngroups = [\"energy_conservation\"]\n";
    let text = campaign_without_debris().replace("points = 11\n", observed);
    let text = format!("{text}[retain]\ntrajectories = \"sample:2\"\n");
    Plan::from_text("small", &text, overrides).unwrap()
}

/// Law: a fault at any operation of a campaign, from its folder to its mark, once or from then on, of any kind, is an error that names the
/// path; every file under a final name is whole; and the next attempt completes the dataset to the same bytes.
#[test]
fn every_operation_may_fail() {
    let (scratch, plan) = (ScratchFolder::new("faults"), plan());
    let (mut errors, mut operations) = (0, 0);
    // the page is one file more, and most of the work
    for (persists, kind, has_page) in [
        (false, io::ErrorKind::StorageFull, true),
        (true, io::ErrorKind::StorageFull, false),
        (true, io::ErrorKind::ReadOnlyFilesystem, false),
        (false, io::ErrorKind::Other, false),
    ] {
        let counted = Faulty::new(u64::MAX, false, kind);
        make(counted, &scratch.path("whole"), &plan, has_page).unwrap();
        let whole = contents(&scratch.path("whole"));
        fs::remove_dir_all(scratch.path("whole")).unwrap();
        for name in ["/statistics.parquet", "/sensitivity.parquet", "/bands.parquet", "/summary.json", "/_SUCCESS"] {
            assert!(whole.contains_key(name), "{name}");
        }
        assert_eq!(whole.contains_key("/report.html"), has_page);
        assert_eq!(whole.keys().filter(|name| name.starts_with("trajectories/")).count(), 2);
        operations = counted.done.load(Ordering::Relaxed);
        println!("{operations} operations");
        assert!(operations > 80, "{operations} operations");
        for fails in 0..operations {
            let root = scratch.path("r");
            let _ = fs::remove_dir_all(&root);
            let ended = make(Faulty::new(fails, persists, kind), &root, &plan, has_page);
            if let Err(message) = &ended {
                errors += 1;
                assert!(message.contains("spindrift-"), "operation {fails}: no path in {message:?}");
            }
            let is_growing = |name: &str| name.ends_with(".tmp") || name.ends_with("manifest.jsonl");
            for (name, bytes) in contents(&root).iter().filter(|(name, _)| !is_growing(name)) {
                assert!(*bytes == whole[name], "operation {fails}: {name} is not whole");
            }
            make(Faulty::new(u64::MAX, false, kind), &root, &plan, has_page)
                .unwrap_or_else(|error| panic!("operation {fails}: {error}"));
            let now = contents(&root);
            assert_eq!(now.keys().collect::<Vec<_>>(), whole.keys().collect::<Vec<_>>(), "operation {fails}");
            assert!(now == whole, "operation {fails} ({kind:?}, persists: {persists})");
        }
    }
    // what fails once is repeated where that is safe; what fails for good is an error
    assert!(errors as u64 > 3 * operations / 2, "{errors} errors of {operations} operations");
}

/// A small file system in memory, unmounted at its end.
#[cfg(target_os = "linux")]
struct SmallDisk(std::path::PathBuf);

#[cfg(target_os = "linux")]
impl SmallDisk {
    /// One of `kilobytes` kB; `None` where this process may not mount.
    fn new(path: std::path::PathBuf, kilobytes: u64) -> Option<Self> {
        fs::create_dir_all(&path).unwrap();
        let options = format!("size={kilobytes}k");
        let mut mount = std::process::Command::new("mount");
        let mounted = mount.args(["-t", "tmpfs", "-o", &options, "tmpfs"]).arg(&path).output();
        mounted.is_ok_and(|output| output.status.success()).then_some(SmallDisk(path))
    }

    /// Gives it another size.
    fn resize(&self, kilobytes: u64) {
        let options = format!("remount,size={kilobytes}k");
        let status = std::process::Command::new("mount").args(["-o", &options]).arg(&self.0).status().unwrap();
        assert!(status.success());
    }
}

#[cfg(target_os = "linux")]
impl Drop for SmallDisk {
    fn drop(&mut self) {
        let _ = std::process::Command::new("umount").arg(&self.0).status();
    }
}

/// A disk on which a whole result fits, kB.
#[cfg(target_os = "linux")]
const ENOUGH: u64 = 65_536;

/// Law: on a real disk that is full after any number of bytes the error names path and cause, every file under a final name is whole, and with
/// more space the same command completes the result to the same bytes.
#[cfg(target_os = "linux")]
#[test]
fn a_small_disk_fills_up() {
    let (scratch, plan) = (ScratchFolder::new("full"), plan());
    let Some(disk) = SmallDisk::new(scratch.path("disk"), ENOUGH) else {
        println!("skipped: this process may not mount a file system");
        return;
    };
    let root = disk.0.join("r");
    make(&Disk, &root, &plan, true).unwrap();
    let whole = contents(&root);
    let (mut kilobytes, mut full) = (8, 0);
    loop {
        fs::remove_dir_all(&root).unwrap();
        disk.resize(kilobytes);
        let Err(message) = make(&Disk, &root, &plan, true) else { break };
        full += 1;
        assert!(
            message.contains("/disk/r") && message.contains("No space left on device"),
            "{kilobytes} kB: {message}"
        );
        let is_growing = |name: &str| name.ends_with(".tmp") || name.ends_with("manifest.jsonl");
        for (name, bytes) in contents(&root).iter().filter(|(name, _)| !is_growing(name)) {
            assert!(*bytes == whole[name], "{kilobytes} kB: {name} is not whole");
        }
        disk.resize(ENOUGH);
        make(&Disk, &root, &plan, true).unwrap_or_else(|error| panic!("after {kilobytes} kB: {error}"));
        assert!(contents(&root) == whole, "after {kilobytes} kB");
        kilobytes += kilobytes / 8 + 4;
    }
    assert!(full > 20 && kilobytes < ENOUGH, "{full} full disks, {kilobytes} kB were enough");
}
