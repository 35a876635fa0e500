//! A fault at the k-th file operation, for every k: SQLite's method. Whatever fails, nothing half-written has a final
//! name, and continuing completes the dataset to the same bytes.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::{fs, io};

use spindrift::campaign::Plan;
use spindrift::storage::disk::Disk;

use crate::reliability::faulty_storage::{Fault, Faulty, Operation, contents, listed_files, make, plan, reason};
use crate::support::scratch_folder::ScratchFolder;

/// What changes files, and what asks for them; reads one by one are those of `read_faults`.
fn is_counted(operation: Operation) -> bool {
    !matches!(operation, Operation::Length | Operation::Read)
}

/// Samples of three parts.
const SAMPLES: u64 = 520;

/// Whether faults persist, and what they are in turn.
type Faults<'a> = (bool, &'a [Fault]);

/// Makes a campaign with a fault at every operation in turn, from its folder to its mark, and checks what is left and
/// what the next attempt makes of it. Returns the number of errors and of operations.
fn fail_everywhere(scratch: &ScratchFolder, plan: &Plan, has_page: bool, (persists, faults): Faults<'_>) -> (u64, u64) {
    let never = || Faulty::new(is_counted, u64::MAX, false, Fault::Kind(io::ErrorKind::Other));
    let counted = never();
    make(counted, &scratch.path("whole"), plan, has_page).unwrap();
    let whole = contents(&scratch.path("whole"));
    fs::remove_dir_all(scratch.path("whole")).unwrap();
    for name in ["statistics.parquet", "sensitivity.parquet", "bands.parquet", "summary.json", "_SUCCESS"] {
        assert!(whole.contains_key(name), "{name}");
    }
    assert_eq!(whole.contains_key("report.html"), has_page);
    assert_eq!(whole.keys().filter(|name| name.starts_with("trajectories/")).count(), 2);
    let operations = counted.done().len() as u64;
    assert!(operations > 80, "{operations} operations");
    // what is before the page is the same without it
    let is_of_page = |(_, path): &(Operation, PathBuf)| path.to_string_lossy().contains("report.html");
    let page = counted.done().iter().position(is_of_page).expect("a page is written, or an old one removed");
    let (mut errors, mut faults) = (0, faults.iter().cycle());
    for fails in if has_page { page as u64 } else { 0 }..operations {
        let fault = *faults.next().expect("a cycle");
        let root = scratch.path("r");
        let _ = fs::remove_dir_all(&root);
        let ended = make(Faulty::new(is_counted, fails, persists, fault), &root, plan, has_page);
        if let Err(failure) = &ended {
            errors += 1;
            let message = reason(failure);
            assert!(message.contains("spindrift-"), "operation {fails}: no path in {message:?}");
        }
        let is_growing = |name: &str| name.ends_with(".tmp") || name.ends_with("manifest.jsonl");
        for (name, bytes) in contents(&root).iter().filter(|(name, _)| !is_growing(name)) {
            assert!(*bytes == whole[name], "operation {fails}: {name} is not whole");
        }
        make(never(), &root, plan, has_page).unwrap_or_else(|error| panic!("operation {fails}: {error:?}"));
        let now = contents(&root);
        assert_eq!(now.keys().collect::<Vec<_>>(), whole.keys().collect::<Vec<_>>(), "operation {fails}");
        assert!(now == whole, "operation {fails} ({fault:?}, persists: {persists})");
    }
    (errors, operations)
}

/// Law: a fault at any operation of a campaign, from its folder to its mark, once or from then on, is an error that
/// names the path; every file under a final name is whole; and the next attempt completes the dataset to the same
/// bytes. The kinds of faults take turns; the long version has every kind at every operation.
#[test]
fn every_operation_may_fail() {
    let [full, other, read_only] =
        [io::ErrorKind::StorageFull, io::ErrorKind::Other, io::ErrorKind::ReadOnlyFilesystem].map(Fault::Kind);
    let (scratch, plan) = (ScratchFolder::new("faults"), plan(SAMPLES));
    // the page is one file more, and most of the work
    fail_everywhere(&scratch, &plan, true, (false, &[full]));
    let (once, operations) = fail_everywhere(&scratch, &plan, false, (false, &[full, other]));
    let (lasting, _) = fail_everywhere(&scratch, &plan, false, (true, &[full, read_only]));
    // what fails once is repeated where that is safe; what fails for good is an error
    assert!(
        once > operations / 4 && lasting > operations / 2,
        "{once} and {lasting} errors of {operations} operations"
    );
}

/// Law: a disk that alters what is written, from any operation on, is noticed before a file has its final name. What is
/// left is completed to the same bytes.
#[test]
fn altered_bytes_are_noticed() {
    let (scratch, plan) = (ScratchFolder::new("faults-altered"), plan(SAMPLES));
    let (errors, operations) = fail_everywhere(&scratch, &plan, false, (true, &[Fault::Altered]));
    assert!(errors > operations / 2, "{errors} errors of {operations} operations");
}

/// Law: at every operation each part that is listed is there and whole, while a dataset is made and while it is
/// extended, which replaces its last part.
#[test]
fn what_is_listed_is_whole_at_every_operation() {
    let scratch = ScratchFolder::new("faults-watched");
    let root = scratch.path("r");
    for (samples, parts) in [(SAMPLES - 100, 2), (SAMPLES, 3)] {
        let watched = Faulty::watched(&root);
        make(watched, &root, &plan(samples), false).unwrap();
        assert!(watched.done().len() > 30 && listed_files(&root).len() == 2 * parts);
    }
}

/// The long version of [`every_operation_may_fail`].
#[test]
#[ignore = "a minute: cargo test --release --test program -- --ignored every_operation"]
fn every_operation_may_fail_in_every_way() {
    use io::ErrorKind::{Interrupted, Other, PermissionDenied, ReadOnlyFilesystem, StorageFull};
    let (scratch, plan) = (ScratchFolder::new("faults-every-way"), plan(SAMPLES));
    for persists in [false, true] {
        for kind in [StorageFull, ReadOnlyFilesystem, PermissionDenied, Interrupted, Other] {
            // the standard library repeats what is interrupted: one that lasts would never end
            if !(persists && kind == Interrupted) {
                let (errors, operations) = fail_everywhere(&scratch, &plan, false, (persists, &[Fault::Kind(kind)]));
                println!("{kind:?}, persists: {persists}: {errors} errors of {operations} operations");
            }
        }
    }
}

/// Law: a dataset that is extended says that it is complete before the first change and after the last one, and not
/// between: neither people nor programs take a part of it for the whole.
#[test]
fn what_is_extended_is_not_marked_complete() {
    let scratch = ScratchFolder::new("faults-extended");
    let (short, long) = (plan(SAMPLES - 100), plan(SAMPLES));
    let start = |name: &str, fails: u64, kind| {
        let root = scratch.path(name);
        let _ = fs::remove_dir_all(&root);
        make(&Disk, &root, &short, false).unwrap();
        let faulty = Faulty::new(is_counted, fails, true, Fault::Kind(kind));
        let before = contents(&root);
        (make(faulty, &root, &long, false), faulty, before, contents(&root))
    };
    let (ended, counted, before, whole) = start("whole", u64::MAX, io::ErrorKind::Other);
    ended.unwrap();
    assert!(before != whole && before.contains_key("_SUCCESS") && whole.contains_key("_SUCCESS"));
    let (mut without, operations) = (0, counted.done().len());
    for fails in (0..operations).step_by(3) {
        let (ended, _, before, now) = start("r", fails as u64, io::ErrorKind::StorageFull);
        assert!(ended.is_err(), "operation {fails}");
        let is_marked = now.contains_key("_SUCCESS");
        without += usize::from(!is_marked);
        // the manifest loses its last line first: what it lists is then still everything
        let content = |files: &BTreeMap<String, Vec<u8>>| -> BTreeMap<String, Vec<u8>> {
            let is_content = |name: &str| name != "manifest.jsonl" && !name.ends_with(".tmp");
            files.clone().into_iter().filter(|(name, _)| is_content(name)).collect()
        };
        let is_whole = [&before, &whole].iter().any(|files| content(files) == content(&now));
        assert!(!is_marked || is_whole, "operation {fails}: part of an extension is marked complete");
    }
    assert!(without * 3 > operations / 2, "{without} of {operations} operations");
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

/// Law: on a real disk that is full after any number of bytes the error names path and cause, every file under a final
/// name is whole, and with more space the same command completes the result to the same bytes.
#[cfg(target_os = "linux")]
#[test]
fn a_small_disk_fills_up() {
    let (scratch, plan) = (ScratchFolder::new("full"), plan(SAMPLES));
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
        let Err(failure) = make(&Disk, &root, &plan, true) else { break };
        let message = reason(&failure);
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
        make(&Disk, &root, &plan, true).unwrap_or_else(|error| panic!("after {kilobytes} kB: {error:?}"));
        assert!(contents(&root) == whole, "after {kilobytes} kB");
        kilobytes += kilobytes / 8 + 4;
    }
    assert!(full > 20 && kilobytes < ENOUGH, "{full} full disks, {kilobytes} kB were enough");
}
