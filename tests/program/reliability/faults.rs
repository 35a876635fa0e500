//! A fault at the k-th file operation, for every k (SQLite's method).

use crate::prelude::*;
use std::io;
use std::sync::Arc;

use crate::reliability::failing_store::{Fault, Making, Plot, contents, made, reason, whole_parts};

const SAMPLES: u64 = 520;

/// With a fault at every operation in turn. Returns the number of errors and of operations.
fn fail_everywhere(scratch: &ScratchFolder, has_page: bool, persists: bool, faults: &[Fault]) -> [usize; 2] {
    let making = Making { has_page, ..Making::of(SAMPLES) };
    let counted = Plot::harmless(|_| true);
    making.make(&counted, &scratch.path("whole")).unwrap();
    let whole = contents(&scratch.path("whole"));
    fs::remove_dir_all(scratch.path("whole")).unwrap();
    for name in ["statistics.parquet", "sensitivity.parquet", "bands.parquet", "summary.json", "_SUCCESS"] {
        assert!(whole.contains_key(name), "{name}");
    }
    assert_eq!(whole.contains_key("report.html"), has_page);
    assert_eq!(whole.keys().filter(|name| name.starts_with("trajectories/")).count(), 2);
    let operations = counted.done();
    assert!(operations.len() > 25, "{} operations", operations.len());
    let page = operations.iter().position(|(_, path)| path.ends_with("report.html")).unwrap();
    let mut errors = 0;
    for (fails, fault) in (0..operations.len()).zip(faults.iter().cycle()).skip(if has_page { page } else { 0 }) {
        let root = scratch.path("r");
        let _ = fs::remove_dir_all(&root);
        let what = format!("operation {fails} {:?} ({fault:?}, persists: {persists})", operations[fails]);
        if let Err(failure) = making.make(&Plot::new(|_| true, fails as u64, persists, *fault), &root) {
            errors += 1;
            assert!(reason(&failure).contains("spindrift-"), "{what}: no path in {failure:?}");
        }
        for (name, bytes) in contents(&root).iter().filter(|(name, _)| !name.ends_with(".tmp")) {
            assert!(*bytes == whole[name], "{what}: {name} is not whole");
        }
        assert!(made(making, &root) == whole, "{what}");
    }
    [errors, operations.len()]
}

/// Law: a fault is an error with the path; files are whole; the next attempt gives the same bytes.
#[test]
fn every_operation_may_fail() {
    use io::ErrorKind::{Other, ReadOnlyFilesystem, StorageFull};
    let scratch = ScratchFolder::new("faults");
    fail_everywhere(&scratch, true, false, &[Fault::Kind(StorageFull)]);
    let late = Fault::Late(Other);
    for (persists, faults) in
        [(false, [Fault::Kind(StorageFull), late]), (true, [late, Fault::Kind(ReadOnlyFilesystem)])]
    {
        let [errors, operations] = fail_everywhere(&scratch, false, persists, &faults);
        assert!(errors > operations / 2, "{errors} errors of {operations} operations");
    }
}

#[test]
#[ignore = "a minute: cargo test --release --test program -- --ignored every_operation"]
fn every_operation_may_fail_in_every_way() {
    use io::ErrorKind::{Other, PermissionDenied, ReadOnlyFilesystem, StorageFull};
    let scratch = ScratchFolder::new("faults-every-way");
    for persists in [false, true] {
        for kind in [StorageFull, ReadOnlyFilesystem, PermissionDenied, Other] {
            for fault in [Fault::Kind(kind), Fault::Late(kind)] {
                let [errors, operations] = fail_everywhere(&scratch, false, persists, &[fault]);
                println!("{fault:?}, persists: {persists}: {errors} errors of {operations} operations");
            }
        }
    }
}

/// Law: every part present is whole, with its bands, at every operation of making and extending a dataset.
#[test]
fn what_is_there_is_whole_at_every_operation() {
    let scratch = ScratchFolder::new("faults-watched");
    let root = scratch.path("r");
    for (samples, parts) in [(SAMPLES - 100, 2), (SAMPLES, 3)] {
        let watched = Plot::watched(&root);
        Making::of(samples).make(&watched, &root).unwrap();
        assert!(watched.done().len() > 15 && whole_parts(&root) == parts, "{} operations", watched.done().len());
    }
}

/// Law: a dataset that is extended has no mark between the first change and the last one.
#[test]
fn what_is_extended_is_not_marked_complete() {
    let scratch = ScratchFolder::new("faults-extended");
    let root = scratch.path("r");
    let extended = |plot: &Arc<Plot>| {
        let _ = fs::remove_dir_all(&root);
        let before = made(Making::of(SAMPLES - 100), &root);
        let ended = Making::of(SAMPLES).make(plot, &root);
        (ended.is_ok(), before, contents(&root))
    };
    let counted = Plot::harmless(|_| true);
    let (_, before, whole) = extended(&counted);
    assert!(before != whole && before.contains_key("_SUCCESS") && whole.contains_key("_SUCCESS"));
    let (mut without, operations) = (0, counted.done().len());
    for fails in (0..operations).step_by(2) {
        let fault = Fault::Kind(io::ErrorKind::StorageFull);
        let (is_done, _, now) = extended(&Plot::new(|_| true, fails as u64, true, fault));
        assert!(!is_done, "operation {fails}");
        let without_tmp: BTreeMap<_, _> = now.into_iter().filter(|(name, _)| !name.ends_with(".tmp")).collect();
        let is_marked = without_tmp.contains_key("_SUCCESS");
        without += usize::from(!is_marked);
        let is_whole = [&before, &whole].contains(&&without_tmp);
        assert!(!is_marked || is_whole, "operation {fails}: part of an extension is marked complete");
    }
    assert!(without * 2 > operations / 2, "{without} of {operations} operations");
}

#[cfg(target_os = "linux")]
struct SmallDisk(std::path::PathBuf);

#[cfg(target_os = "linux")]
impl SmallDisk {
    fn new(path: std::path::PathBuf, kilobytes: u64) -> Option<Self> {
        fs::create_dir_all(&path).unwrap();
        let options = format!("size={kilobytes}k");
        let mut mount = std::process::Command::new("mount");
        let mounted = mount.args(["-t", "tmpfs", "-o", &options, "tmpfs"]).arg(&path).output();
        mounted.is_ok_and(|output| output.status.success()).then_some(SmallDisk(path))
    }

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

#[cfg(target_os = "linux")]
const ENOUGH: u64 = 65_536;

/// Law: so on a real full disk.
#[cfg(target_os = "linux")]
#[test]
fn a_small_disk_fills_up() {
    let scratch = ScratchFolder::new("full");
    let making = Making { has_page: true, ..Making::of(SAMPLES) };
    let Some(disk) = SmallDisk::new(scratch.path("disk"), ENOUGH) else {
        println!("skipped: this process may not mount a file system");
        return;
    };
    let root = disk.0.join("r");
    let whole = made(making, &root);
    let (mut kilobytes, mut full) = (8, 0);
    loop {
        fs::remove_dir_all(&root).unwrap();
        disk.resize(kilobytes);
        let Err(failure) = making.make(&Plot::harmless(|_| true), &root) else { break };
        let message = reason(&failure);
        full += 1;
        assert!(message.contains("/disk/r") && message.contains("No space left"), "{kilobytes} kB: {message}");
        for (name, bytes) in contents(&root).iter().filter(|(name, _)| !name.ends_with(".tmp")) {
            assert!(*bytes == whole[name], "{kilobytes} kB: {name} is not whole");
        }
        disk.resize(ENOUGH);
        assert!(made(making, &root) == whole, "after {kilobytes} kB");
        kilobytes += kilobytes / 8 + 4;
    }
    assert!(full > 20 && kilobytes < ENOUGH, "{full} full disks, {kilobytes} kB were enough");
}
