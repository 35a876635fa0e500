//! Processes that begin in one folder at the same instant, with locks and without, make one result or are refused.

use crate::prelude::*;
use std::process::Output;

use crate::reliability::interrupted::assert_same;

const ROUNDS: u32 = 10;
const MANY_ROUNDS: u32 = 200;
const SHARDS: u32 = 8;

/// Linux's EOPNOTSUPP, ENOLCK and ENOSYS, which mean that there are no locks.
#[cfg(target_os = "linux")]
const WITHOUT: [i32; 3] = [95, 37, 38];
#[cfg(target_os = "linux")]
const EIO: i32 = 5;

#[cfg(target_os = "linux")]
fn no_locks(scratch: &ScratchFolder) -> Option<PathBuf> {
    let (source, library) =
        (concat!(env!("CARGO_MANIFEST_DIR"), "/tests/program/reliability/no_locks.c"), scratch.path("no_locks.so"));
    let compiled = Command::new("cc").args(["-shared", "-fPIC", "-o"]).arg(&library).arg(source).status();
    if compiled.is_ok_and(|status| status.success()) {
        return Some(library);
    }
    println!("skipped: there is no C compiler");
    None
}

type Locks<'a> = Option<(&'a Path, i32)>;

fn start(scratch: &ScratchFolder, arguments: &str, locks: Locks<'_>) -> Child {
    let mut program = Command::new(env!("CARGO_BIN_EXE_spindrift"));
    program.args(arguments.split_whitespace()).current_dir(&scratch.0).stdout(Stdio::null()).stderr(Stdio::piped());
    if let Some((library, error)) = locks {
        program.env("LD_PRELOAD", library).env("NO_LOCKS", error.to_string());
    }
    program.spawn().unwrap()
}

fn together(scratch: &ScratchFolder, commands: &[String], locks: Locks<'_>) -> Vec<(i32, String)> {
    let started: Vec<Child> = commands.iter().map(|command| start(scratch, command, locks)).collect();
    let ended = |child: Child| {
        let Output { status, stderr, .. } = child.wait_with_output().unwrap();
        (status.code().unwrap_or(-1), String::from_utf8_lossy(&stderr).into_owned())
    };
    started.into_iter().map(ended).collect()
}

fn shards_begin(scratch: &ScratchFolder, rounds: u32, locks: Locks<'_>) {
    let command = "campaign small.toml --samples 2100 --threads 1 --no-report";
    scratch.prints(&format!("{command} --out whole"), 0);
    for round in 0..rounds {
        let shards: Vec<String> =
            (1..=SHARDS).map(|shard| format!("{command} --out r --shard {shard}/{SHARDS}")).collect();
        for (code, said) in together(scratch, &shards, locks) {
            assert_eq!(code, 0, "round {round}: {said}");
            assert!(!said.contains("damaged"), "round {round}: {said}");
        }
        scratch.prints("finish r --no-report", 0);
        assert_same(scratch, "r", "whole");
        fs::remove_dir_all(scratch.path("r")).unwrap();
    }
    fs::remove_dir_all(scratch.path("whole")).unwrap();
}

/// Law: shards that begin at the same instant all complete, with the bytes of one process.
#[test]
fn shards_begin_together() {
    shards_begin(&folder("together"), ROUNDS, None);
}

#[cfg(target_os = "linux")]
#[test]
fn shards_begin_together_without_locks() {
    let scratch = folder("together-unlocked");
    let Some(library) = no_locks(&scratch) else { return };
    for error in WITHOUT {
        shards_begin(&scratch, ROUNDS / 3 + 1, Some((&library, error)));
    }
}

#[cfg(target_os = "linux")]
#[test]
#[ignore = "minutes: cargo test --release --test program -- --ignored many_rounds_of_shards"]
fn many_rounds_of_shards() {
    let scratch = folder("together-long");
    shards_begin(&scratch, MANY_ROUNDS, None);
    if let Some(library) = no_locks(&scratch) {
        shards_begin(&scratch, MANY_ROUNDS, Some((&library, WITHOUT[0])));
    }
}

fn others_begin(scratch: &ScratchFolder, rounds: u32, locks: Locks<'_>) {
    let other = campaign().replace("duration_s = 1.0", "duration_s = 1.5");
    scratch.file("other.toml", &other);
    let kinds = ["small.toml --seed 7", "small.toml --seed 8", "other.toml --seed 7"];
    let options = "--samples 1100 --threads 1 --no-report";
    for (kind, name) in kinds.iter().enumerate() {
        scratch.prints(&format!("campaign {name} {options} --out whole{kind}"), 0);
    }
    for round in 0..rounds {
        for shard in ["", "--shard 1/2"] {
            let mut commands: Vec<String> =
                kinds.iter().map(|kind| format!("campaign {kind} {options} --out r {shard}")).collect();
            commands.rotate_left(round as usize % kinds.len());
            let ended = together(scratch, &commands, locks);
            let done: Vec<usize> = (0..ended.len()).filter(|at| ended[*at].0 == 0).collect();
            assert_eq!(done.len(), 1, "round {round} {shard}: {ended:?}");
            for (code, said) in ended.iter().filter(|(code, _)| *code != 0) {
                assert_eq!(*code, 4, "{said}");
                assert!(said.contains("another plan") || said.contains("another process is using"), "{said}");
            }
            let winner = (done[0] + round as usize) % kinds.len();
            if !shard.is_empty() {
                scratch.prints(&format!("campaign {} {options} --out r --shard 2/2", kinds[winner]), 0);
                scratch.prints("finish r --no-report", 0);
            }
            assert_same(scratch, "r", &format!("whole{winner}"));
            fs::remove_dir_all(scratch.path("r")).unwrap();
        }
    }
}

/// Law: of different plans that begin at the same instant one makes its result, and the others leave nothing in it.
#[test]
fn of_two_plans_one_wins() {
    others_begin(&folder("two-plans"), ROUNDS, None);
}

#[cfg(target_os = "linux")]
#[test]
fn of_two_plans_one_wins_without_locks() {
    let scratch = folder("two-plans-unlocked");
    let Some(library) = no_locks(&scratch) else { return };
    others_begin(&scratch, ROUNDS, Some((&library, WITHOUT[0])));
}

/// Law: a lock that fails for another reason ends the command with path, cause and code 4 before anything is written.
#[cfg(target_os = "linux")]
#[test]
fn a_lock_that_fails_is_an_error() {
    let scratch = folder("lock-error");
    let Some(library) = no_locks(&scratch) else { return };
    scratch.small("--samples 20 --out r", 0);
    let commands = ["campaign small.toml --samples 20 --out new", "verify r", "finish r", "report r", "compare r r"];
    let commands = commands.map(str::to_owned);
    for (code, said) in together(&scratch, &commands, Some((&library, EIO))) {
        assert!(code == 4 && said.contains("Input/output error"), "{code}: {said}");
    }
    assert_eq!(fs::read_dir(scratch.path("new")).unwrap().count(), 0);
    for (code, said) in together(&scratch, &commands, Some((&library, WITHOUT[0]))) {
        assert_eq!(code, 0, "{said}");
    }
}
