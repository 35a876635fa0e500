//! A result that takes the place of another one: what the folder is, what is beside it, and every interruption.

use std::collections::BTreeSet;
use std::path::Path;
use std::{fs, io};

use spindrift::campaign::{Overrides, Plan};
use spindrift::storage::claim::ClaimOptions;
use spindrift::storage::disk::{Disk, Storage};

use crate::reliability::faulty_storage::{self, Fault, Faulty, Operation, make, make_with, plan, reason};
use crate::reliability::interrupted::{assert_same, start};
use crate::small_campaign::{campaign_without_debris, folder};
use crate::support::scratch_folder::{ScratchFolder, contents};

/// What is beside the results, by name.
fn entries(folder: &Path) -> BTreeSet<String> {
    fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect()
}

/// Samples of two parts.
const SAMPLES: u64 = 300;

/// Folders beside a result `r` that no command made, with the names that replacements have or had.
const NOT_OURS: [&str; 5] =
    [".r.old", ".r.new", ".r.0123456789abcdef.new", ".r.0123456789abcdef.old", ".r.fedcba9876543210.new"];

/// Makes folders of these names: notes, whole results, and one whose proof is that of another folder.
fn plant(scratch: &ScratchFolder, result: &Path) {
    for name in NOT_OURS {
        let folder = scratch.path(name);
        fs::create_dir(&folder).unwrap();
        for (name, bytes) in contents(result) {
            fs::create_dir_all(folder.join(&name).parent().unwrap()).unwrap();
            fs::write(folder.join(&name), bytes).unwrap();
        }
        if name.starts_with(".r.f") {
            fs::write(folder.join("_REPLACEMENT"), "0123456789abcdef\n").unwrap();
        }
    }
}

/// Law: a fault at any operation of a replacement is an error that names a path; either the old result is whole in its
/// place, or one of both is whole beside it; and the next command ends with the new result, with nothing beside it but
/// what was not made for this, which is as it was.
#[test]
fn every_operation_of_a_replacement_may_fail() {
    let scratch = ScratchFolder::new("replaced-faults");
    let root = scratch.path("r");
    let overrides = Overrides { samples: Some(SAMPLES), seed: Some(99), ..Overrides::default() };
    let text = campaign_without_debris().replace("points = 11\n", "points = 11\ngroups = [\"energy_conservation\"]\n");
    let (old, new) = (plan(SAMPLES), Plan::from_text("small", &text, overrides).unwrap());
    let options = ClaimOptions { overwrite: true, shard: None, threads: 1 };
    let overwrite = |storage: &'static dyn Storage| make_with(options, storage, &root, &new, false);
    make(&Disk, &scratch.path("old"), &old, false).unwrap();
    make(&Disk, &scratch.path("new"), &new, false).unwrap();
    let [before, after] = ["old", "new"].map(|name| contents(&scratch.path(name)));
    plant(&scratch, &scratch.path("old"));
    let planted = NOT_OURS.map(|name| contents(&scratch.path(name)));
    let beside = entries(&scratch.0);
    let is_counted = |operation| !matches!(operation, Operation::Length | Operation::Read);
    let never = || Faulty::new(is_counted, u64::MAX, false, Fault::Kind(io::ErrorKind::Other));
    let begin = || make(&Disk, &root, &old, false).unwrap();
    begin();
    let counted = never();
    overwrite(counted).unwrap();
    assert!(contents(&root) == after);
    let operations = counted.done().len() as u64;
    let (mut errors, mut gone) = (0, 0);
    for persists in [false, true] {
        for fails in 0..operations {
            fs::remove_dir_all(&root).unwrap();
            begin();
            let kind = if fails % 2 == 0 { io::ErrorKind::Other } else { io::ErrorKind::StorageFull };
            let ended = overwrite(Faulty::new(is_counted, fails, persists, Fault::Kind(kind)));
            if let Err(failure) = &ended {
                errors += 1;
                assert!(reason(failure).contains("spindrift-"), "operation {fails}: {failure:?}");
            }
            let is_whole = |folder: &Path| {
                let mut found = if folder.exists() { contents(folder) } else { return false };
                found.remove("_REPLACEMENT");
                found == before || found == after
            };
            let made =
                || entries(&scratch.0).into_iter().filter(|name| !beside.contains(name) && name.starts_with(".r."));
            gone += u32::from(!root.exists());
            assert!(
                is_whole(&root) || made().any(|name| is_whole(&scratch.path(&name))),
                "operation {fails}: both results are lost"
            );
            overwrite(never()).unwrap_or_else(|error| panic!("operation {fails}: {error:?}"));
            assert!(contents(&root) == after, "operation {fails}, persists: {persists}");
            // of a folder that was to get a proof and did not, nobody knows whose it is
            let (known, empty): (Vec<String>, Vec<String>) =
                made().partition(|name| !persists || scratch.path(name).join("_REPLACEMENT").exists());
            assert_eq!(known, [""; 0], "operation {fails}, persists: {persists}");
            for name in empty {
                let left = entries(&scratch.path(&name));
                assert!(left.iter().all(|name| name.ends_with(".tmp")), "operation {fails}: {left:?}");
                fs::remove_dir_all(scratch.path(&name)).unwrap();
            }
        }
    }
    assert!(errors > operations && gone > 0, "{errors} errors of {operations} operations, {gone} between two renames");
    assert!(NOT_OURS.map(|name| contents(&scratch.path(name))) == planted, "what was beside is as it was");
}

/// Law: a new folder, and each above it, is made durable in the folder above, and so are the names of a replacement.
#[test]
fn names_of_folders_are_flushed() {
    let scratch = ScratchFolder::new("replaced-flushed");
    let root = scratch.path("a/b/r");
    let all =
        || Faulty::new(|operation| operation == Operation::Write, u64::MAX, false, Fault::Kind(io::ErrorKind::Other));
    let times = |storage: &Faulty, folder: &Path| storage.done().iter().filter(|(_, path)| path == folder).count();
    let made = all();
    make(made, &root, &plan(20), false).unwrap();
    assert_eq!(["", "a", "a/b"].map(|folder| times(made, &scratch.path(folder))), [1, 1, 1]);
    let again = all();
    make(again, &root, &plan(20), false).unwrap();
    assert_eq!(times(again, &scratch.path("a/b")), 0, "nothing was created");
    let replaced = all();
    let options = ClaimOptions { overwrite: true, shard: None, threads: 1 };
    make_with(options, replaced, &root, &plan(30), false).unwrap();
    let [new, renamed, removed] = [1, 1, 1];
    assert_eq!(times(replaced, &scratch.path("a/b")), new + renamed + removed);
    assert!(contents(&root).contains_key("_SUCCESS"));
}

/// Law: a link that is named as the folder of a result means the folder that it leads to, whether that is there already
/// or not, and stays.
#[cfg(unix)]
#[test]
fn a_link_is_the_folder_that_it_leads_to() {
    let scratch = folder("replaced-link");
    fs::create_dir(scratch.path("disk")).unwrap();
    std::os::unix::fs::symlink("disk/r", scratch.path("link")).unwrap();
    std::os::unix::fs::symlink("link", scratch.path("links")).unwrap();
    let command = "campaign small.toml --samples 300 --no-report";
    for seed in [1, 2, 3] {
        scratch.prints(&format!("{command} --seed {seed} --out whole --overwrite"), 0);
        scratch.prints(&format!("{command} --seed {seed} --out links --overwrite"), 0);
        assert_same(&scratch, "disk/r", "whole");
        assert_eq!(entries(&scratch.path("disk")).len(), 1);
        scratch.prints("verify links", 0);
        let said = scratch.prints(&format!("{command} --seed {seed} --out links"), 0);
        assert!(said.contains("already complete"), "{said}");
    }
    assert!(["link", "links"].iter().all(|name| fs::symlink_metadata(scratch.path(name)).unwrap().is_symlink()));
    std::os::unix::fs::symlink("round", scratch.path("round")).unwrap();
    let said = scratch.prints(&format!("{command} --out round"), 4);
    assert!(said.contains("a link that leads to itself"), "{said}");
}

/// Law: the current folder takes a result and continues it; it is not replaced, and that is said before a sample is
/// run.
#[test]
fn the_current_folder_is_not_replaced() {
    let scratch = folder("replaced-current");
    scratch.prints("campaign small.toml --samples 300 --out r", 0);
    let inside = ScratchFolder(scratch.path("r"));
    let said = inside.prints("campaign ../small.toml --samples 300 --out .", 0);
    assert!(said.contains("already complete"), "{said}");
    inside.prints("campaign ../small.toml --samples 600 --out .", 0);
    let before = contents(&inside.0);
    for out in [".", "../r", "runs/.."] {
        let said = inside.prints(&format!("campaign ../small.toml --seed 9 --overwrite --out {out}"), 4);
        assert!(said.contains("cannot be replaced") && said.contains("the current folder"), "{said}");
        assert!(said.contains("another one as --out"), "no remedy: {said}");
        assert!(contents(&inside.0) == before);
        assert!(entries(&scratch.0).iter().all(|name| !name.starts_with('.')), "{:?}", entries(&scratch.0));
    }
    scratch.prints("campaign small.toml --seed 9 --overwrite --out r", 0);
}

/// Law: the same of a mount point.
#[cfg(target_os = "linux")]
#[test]
fn a_mount_point_is_not_replaced() {
    let scratch = folder("replaced-mount");
    fs::create_dir_all(scratch.path("inner")).unwrap();
    let root = scratch.path("r");
    fs::create_dir(&root).unwrap();
    // another folder of the same file system: its number says nothing
    let mount = std::process::Command::new("mount").arg("--bind").arg(scratch.path("inner")).arg(&root).output();
    if !mount.is_ok_and(|output| output.status.success()) {
        println!("skipped: this process may not mount a folder");
        return;
    }
    let ended = std::panic::catch_unwind(|| {
        scratch.prints("campaign small.toml --samples 300 --out r", 0);
        let before = contents(&root);
        let said = scratch.prints("campaign small.toml --seed 9 --overwrite --out r", 4);
        assert!(said.contains("cannot be replaced") && said.contains("another one as --out"), "{said}");
        assert!(contents(&root) == before);
        assert!(entries(&scratch.0).iter().all(|name| !name.starts_with('.')), "{:?}", entries(&scratch.0));
        scratch.prints("campaign small.toml --samples 600 --out r", 0);
    });
    assert!(std::process::Command::new("umount").arg(&root).status().unwrap().success());
    ended.unwrap();
}

/// Law: a folder of a result that becomes a link during a run is not written through: the command ends with code 4 and
/// names it, what the link leads to is as it was, and with the folder back the same command completes the result.
#[cfg(target_os = "linux")]
#[test]
fn links_swapped_in_during_a_run_are_not_followed() {
    use rustix::fs::{CWD, RenameFlags, renameat_with};
    let scratch = folder("replaced-swapped");
    scratch.prints("campaign small.toml --seed 3 --out victim", 0);
    let before = contents(&scratch.path("victim"));
    let command = "campaign small.toml --samples 60000 --threads 1 --no-report";
    scratch.prints(&format!("{command} --out whole"), 0);
    for (name, target) in [("r/runs", "victim/runs"), ("r", "victim"), ("r/bands", "victim/bands")] {
        let (folder, link) = (scratch.path(name), scratch.path("link"));
        std::os::unix::fs::symlink(scratch.path(target), &link).unwrap();
        let swap = || renameat_with(CWD, &folder, CWD, &link, RenameFlags::EXCHANGE).unwrap();
        let mut child = start(&scratch, &format!("{command} --out r"));
        while faulty_storage::listed_files(&scratch.path("r")).is_empty() {
            assert!(child.try_wait().unwrap().is_none());
            std::thread::sleep(std::time::Duration::from_millis(2));
        }
        swap();
        assert_eq!(child.wait().unwrap().code(), Some(4), "{name}");
        assert!(contents(&scratch.path("victim")) == before, "{name}");
        swap();
        fs::remove_file(&link).unwrap();
        scratch.prints(&format!("{command} --out r"), 0);
        assert_same(&scratch, "r", "whole");
        fs::remove_dir_all(scratch.path("r")).unwrap();
    }
}
