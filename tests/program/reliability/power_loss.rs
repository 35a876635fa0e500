//! Loss of power: at any call that changes or flushes a file all unflushed content and names are gone; the same command
//! then ends with the same bytes. A library (`power_loss.c`, loaded before libc) keeps what is flushed.

use crate::prelude::*;

use crate::reliability::failing_store::contents;

const STEP: usize = 7;

/// The library; `None` where there is no compiler for it.
fn library(scratch: &ScratchFolder) -> Option<PathBuf> {
    let source = root().join("tests/program/reliability/power_loss.c");
    let library = scratch.path("power_loss.so");
    let compiled =
        Command::new("cc").args(["-shared", "-fPIC", "-O1", "-o"]).arg(&library).arg(source).args(["-ldl"]).status();
    match compiled {
        Ok(status) => {
            assert!(status.success(), "the library does not compile");
            Some(library)
        }
        Err(error) => {
            println!("skipped: cc: {error}");
            None
        }
    }
}

fn entries(durable: &Path, inode: &str) -> Vec<(String, bool, String)> {
    let text = fs::read_to_string(durable.join(format!("folder-{inode}"))).unwrap_or_default();
    let entry = |line: &str| {
        let mut words = line.splitn(3, ' ');
        let mut word = || words.next().unwrap().to_owned();
        (word(), word() == "1", word())
    };
    text.lines().map(entry).collect()
}

fn put_back(durable: &Path, inode: &str, to: &Path) {
    for (inode, is_folder, name) in entries(durable, inode) {
        let path = to.join(name);
        if is_folder {
            fs::create_dir(&path).unwrap();
            put_back(durable, &inode, &path);
        } else {
            fs::write(&path, fs::read(durable.join(format!("file-{inode}"))).unwrap_or_default()).unwrap();
        }
    }
}

fn inode(path: &Path) -> String {
    use std::os::unix::fs::MetadataExt;
    fs::metadata(path).unwrap().ino().to_string()
}

fn copy(from: &Path, to: &Path) {
    let _ = fs::remove_dir_all(to);
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap().map(Result::unwrap) {
        let target = to.join(entry.file_name());
        if entry.path().is_dir() {
            copy(&entry.path(), &target);
        } else {
            fs::copy(entry.path(), target).unwrap();
        }
    }
}

struct Case {
    name: &'static str,
    before: &'static str,
    command: &'static str,
}

const CASES: [Case; 4] = [
    Case { name: "campaign", before: "nothing", command: "campaign small.toml --samples 300" },
    Case { name: "extension", before: "small", command: "campaign small.toml --samples 300" },
    Case { name: "overwrite", before: "other", command: "campaign small.toml --samples 300 --overwrite" },
    Case { name: "repair", before: "damaged", command: "verify --repair" },
];

fn power_fails(step: usize) {
    let scratch = folder(&format!("power-{step}"));
    let Some(library) = library(&scratch) else { return };
    for name in ["nothing", "small", "other", "damaged"] {
        fs::create_dir_all(scratch.path(name)).unwrap();
    }
    scratch.small("--samples 20 --no-report --threads 1 --out small/r", 0);
    scratch.small("--samples 300 --seed 8 --no-report --threads 1 --out other/r", 0);
    scratch.small("--samples 300 --no-report --threads 1 --out damaged/r", 0);
    let whole = contents(&scratch.path("damaged/r"));
    fs::write(scratch.path("damaged/r/runs/part-000001.parquet"), "damaged").unwrap();
    fs::write(scratch.path("damaged/r/summary.json"), "damaged").unwrap();
    let (disk, durable) = (scratch.path("disk"), scratch.path("durable"));
    for case in &CASES {
        let arguments = match case.name {
            "repair" => format!("{} --threads 1 --fraction 0 disk/r", case.command),
            _ => format!("{} --no-report --threads 1 --out disk/r", case.command),
        };
        let run = |fails: usize| -> (Option<i32>, usize) {
            copy(&scratch.path(case.before), &disk);
            let _ = fs::remove_dir_all(&durable);
            fs::create_dir(&durable).unwrap();
            let mut program = Command::new(env!("CARGO_BIN_EXE_spindrift"));
            program.args(arguments.split_whitespace()).current_dir(&scratch.0).env("LD_PRELOAD", &library);
            program.env("POWER_ROOT", &disk).env("POWER_DURABLE", &durable).env("POWER_CALL", fails.to_string());
            let output = program.output().unwrap();
            let calls = fs::read_to_string(durable.join("calls")).unwrap().parse().unwrap();
            (output.status.code(), calls)
        };
        let (code, calls) = run(0);
        assert_eq!(code, Some(0), "{}", case.name);
        assert!(calls > 40, "{}: {calls} calls", case.name);
        let goal = contents(&disk.join("r"));
        let rows = |files: &BTreeMap<String, Vec<u8>>| -> Vec<Vec<u8>> {
            files.iter().filter(|(name, _)| name.starts_with("runs/")).map(|(_, bytes)| bytes.clone()).collect()
        };
        assert!(rows(&goal) == rows(&whole), "{}", case.name);
        let root = inode(&disk);
        let _ = fs::remove_dir_all(&disk);
        fs::create_dir(&disk).unwrap();
        put_back(&durable, &root, &disk);
        assert!(contents(&disk.join("r")) == goal, "{}: not all is flushed at the end", case.name);
        for fails in (1..=calls).step_by(step) {
            assert_eq!(run(fails).0, Some(137), "{}: call {fails} of {calls}", case.name);
            let root = inode(&disk);
            fs::remove_dir_all(&disk).unwrap();
            fs::create_dir(&disk).unwrap();
            put_back(&durable, &root, &disk);
            let what = format!("{}: power lost at call {fails} of {calls}", case.name);
            if case.name == "overwrite" {
                let there = contents(&disk.join("r"));
                let older = contents(&scratch.path("other/r"));
                assert!(there == older || there == goal, "{what}: neither the old nor the new result");
            }
            scratch.prints(&arguments, 0);
            assert!(contents(&disk.join("r")) == goal, "{what}: other files");
            let left: Vec<_> = fs::read_dir(&disk).unwrap().map(|entry| entry.unwrap().file_name()).collect();
            assert_eq!(left, ["r"], "{what}");
        }
        println!("{}: {calls} calls", case.name);
    }
}

/// Law: whenever the power fails, the same command ends with the same bytes.
#[test]
fn a_loss_of_power_loses_nothing() {
    power_fails(STEP);
}

#[ignore = "a minute or two: cargo test --release --test program -- --ignored a_loss_of_power_at_every_call"]
#[test]
fn a_loss_of_power_at_every_call() {
    power_fails(1);
}
