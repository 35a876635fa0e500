//! Results that take the place of others: links, neighbours, and every interruption.

use crate::prelude::*;
use std::io;

use crate::reliability::failing_store::{Fault, Making, Plot, made, reason, whole_parts};
use crate::reliability::interrupted::{assert_same, start};

fn entries(folder: &Path) -> BTreeSet<String> {
    fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect()
}

const SAMPLES: u64 = 300;

const NOT_OURS: [&str; 4] = [".r.old", ".r.new", ".r.0123456789abcdef.new", ".r.0123456789abcdef.old"];

fn plant(scratch: &ScratchFolder, result: &Path) {
    for name in NOT_OURS {
        let folder = scratch.path(name);
        fs::create_dir(&folder).unwrap();
        for (name, bytes) in contents(result) {
            fs::create_dir_all(folder.join(&name).parent().unwrap()).unwrap();
            fs::write(folder.join(&name), bytes).unwrap();
        }
    }
}

/// Law: after a fault at any operation the old or the new result is whole, and the next command ends with the new.
#[test]
fn every_operation_of_a_replacement_may_fail() {
    let scratch = ScratchFolder::new("replaced-faults");
    let root = scratch.path("r");
    let (old, new) = (Making::of(SAMPLES), Making { seed: 99, overwrite: true, ..Making::of(SAMPLES) });
    let before = made(old, &scratch.path("old"));
    let after = made(new, &scratch.path("new"));
    plant(&scratch, &scratch.path("old"));
    let planted = NOT_OURS.map(|name| contents(&scratch.path(name)));
    let beside = entries(&scratch.0);
    made(old, &root);
    let counted = Plot::harmless(|_| true);
    new.make(&counted, &root).unwrap();
    assert!(contents(&root) == after);
    let operations = counted.done().len();
    let (mut errors, mut gone) = (0, 0);
    for (persists, late) in [(false, false), (false, true), (true, false)] {
        for fails in 0..operations {
            fs::remove_dir_all(&root).unwrap();
            made(old, &root);
            let kind = io::ErrorKind::StorageFull;
            let fault = if late { Fault::Late(kind) } else { Fault::Kind(kind) };
            if let Err(failure) = new.make(&Plot::new(|_| true, fails as u64, persists, fault), &root) {
                errors += 1;
                assert!(reason(&failure).contains("spindrift-"), "operation {fails}: {failure:?}");
            }
            let is_whole = |folder: &Path| folder.exists() && [&before, &after].contains(&&contents(folder));
            let made_beside =
                || entries(&scratch.0).into_iter().filter(|name| !beside.contains(name) && name.starts_with(".r."));
            gone += u32::from(!root.exists());
            assert!(
                is_whole(&root) || made_beside().any(|name| is_whole(&scratch.path(&name))),
                "operation {fails}: both results are lost"
            );
            assert!(made(new, &root) == after, "operation {fails}, {fault:?}, persists: {persists}");
            assert_eq!(made_beside().next(), None, "operation {fails}, {fault:?}, persists: {persists}");
        }
    }
    assert!(errors > operations && gone > 0, "{errors} errors of {operations} operations, {gone} between two renames");
    assert!(NOT_OURS.map(|name| contents(&scratch.path(name))) == planted, "what was beside is as it was");
}

/// Law: a link named as the folder of a result means its target, existing or not, and stays.
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
        scratch.shows(&format!("{command} --seed {seed} --out links"), 0, "already complete");
    }
    assert!(["link", "links"].iter().all(|name| fs::symlink_metadata(scratch.path(name)).unwrap().is_symlink()));
    std::os::unix::fs::symlink("round", scratch.path("round")).unwrap();
    scratch.shows(&format!("{command} --out round"), 4, "a link that leads to itself");
}

/// Law: the current folder takes a result and continues it, but neither it nor one above it is replaced, which is
/// refused before any run.
#[test]
fn the_current_folder_is_not_replaced() {
    let scratch = folder("replaced-current");
    scratch.small("--samples 300 --out r", 0);
    let inside = ScratchFolder(scratch.path("r"));
    inside.shows("campaign ../small.toml --samples 300 --out .", 0, "already complete");
    inside.prints("campaign ../small.toml --samples 600 --out .", 0);
    let before = contents(&inside.0);
    let (below, campaign) = (ScratchFolder(scratch.path("r/runs")), scratch.path("small.toml"));
    for (folder, out) in [(&inside, "."), (&inside, "../r"), (&inside, "runs/.."), (&below, "..")] {
        let said = folder.prints(&format!("campaign {} --seed 9 --overwrite --out {out}", campaign.display()), 4);
        assert_says(&said, ["cannot be replaced", "the current folder"]);
        assert!(said.contains("another one as --out"), "no remedy: {said}");
        assert!(contents(&inside.0) == before);
        assert!(entries(&scratch.0).iter().all(|name| !name.starts_with('.')), "{:?}", entries(&scratch.0));
    }
    scratch.small("--seed 9 --overwrite --out r", 0);
}

/// Law: nor is a mount point.
#[cfg(target_os = "linux")]
#[test]
fn a_mount_point_is_not_replaced() {
    let scratch = folder("replaced-mount");
    fs::create_dir_all(scratch.path("inner")).unwrap();
    let root = scratch.path("r");
    fs::create_dir(&root).unwrap();
    let mount = std::process::Command::new("mount").arg("--bind").arg(scratch.path("inner")).arg(&root).output();
    if !mount.is_ok_and(|output| output.status.success()) {
        println!("skipped: this process may not mount a folder");
        return;
    }
    let ended = std::panic::catch_unwind(|| {
        scratch.small("--samples 300 --out r", 0);
        let before = contents(&root);
        assert_says(scratch.small("--seed 9 --overwrite --out r", 4), ["cannot be replaced", "another one as --out"]);
        assert!(contents(&root) == before);
        assert!(entries(&scratch.0).iter().all(|name| !name.starts_with('.')), "{:?}", entries(&scratch.0));
        scratch.small("--samples 600 --out r", 0);
    });
    assert!(std::process::Command::new("umount").arg(&root).status().unwrap().success());
    ended.unwrap();
}

/// Law: a folder of a result that becomes a link during a run is not written through.
#[cfg(target_os = "linux")]
#[test]
fn links_swapped_in_during_a_run_are_not_followed() {
    use rustix::fs::{CWD, RenameFlags, renameat_with};
    let scratch = folder("replaced-swapped");
    scratch.small("--seed 3 --out victim", 0);
    let before = contents(&scratch.path("victim"));
    let command = "campaign small.toml --samples 60000 --threads 1 --no-report";
    scratch.prints(&format!("{command} --out whole"), 0);
    for (name, target) in [("r/runs", "victim/runs"), ("r", "victim"), ("r/bands", "victim/bands")] {
        let (folder, link) = (scratch.path(name), scratch.path("link"));
        std::os::unix::fs::symlink(scratch.path(target), &link).unwrap();
        let swap = || renameat_with(CWD, &folder, CWD, &link, RenameFlags::EXCHANGE).unwrap();
        let mut child = start(&scratch, &format!("{command} --out r"));
        while whole_parts(&scratch.path("r")) == 0 {
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
