//! Files in the folder of a result that are not part of it are named and left alone.

use crate::prelude::*;

const STRAYS: [&str; 6] = [
    "notes.txt",
    ".DS_Store",
    "runs/part-000000.parquet.bak",
    "runs/part-00000-6f1c.snappy.parquet",
    "trajectories/plot.svg",
    "mine/thesis.tex",
];

fn plant(scratch: &ScratchFolder, result: &str, names: &[&str]) -> Vec<PathBuf> {
    let path = |name: &&str| {
        let path = scratch.path(result).join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(&path, "precious").unwrap();
        path
    };
    names.iter().map(path).collect()
}

/// Law: a stray file blocks no command, is named and left alone, and the result is the one without it.
#[test]
fn strays_are_named_and_left_alone() {
    let scratch = folder("strays");
    let retained = format!("{}\n[retain]\ntrajectories = \"sample:2\"\n", campaign());
    scratch.file("small.toml", &retained);
    for samples in [300, 900] {
        scratch.small(&format!("--samples {samples} --out whole{samples}"), 0);
    }
    let shard = |shard: u32| format!("campaign small.toml --samples 300 --out r --shard {shard}/2");
    scratch.prints(&shard(1), 0);
    let strays = plant(&scratch, "r", &STRAYS);
    let named = |said: &str| {
        for name in STRAYS {
            let name = if name.starts_with("mine") { "mine" } else { name };
            assert!(said.contains(&format!("{name}: not part of the result; left alone")), "{name}: {said}");
        }
    };
    named(&scratch.prints(&shard(2), 0));
    named(&scratch.prints("finish r", 0));
    for command in
        ["campaign small.toml --samples 300 --out r", "verify r --fraction 1", "finish r", "verify r --repair"]
    {
        let said = scratch.prints(command, 0);
        assert!(!said.contains("damaged") && !said.contains("problem"), "{command}: {said}");
        named(&said);
    }
    scratch.prints("report r", 0);
    scratch.prints("compare r whole300", 0);
    let mine = |result: &str| {
        let mut files = contents(&scratch.path(result));
        files.retain(|name, _| !STRAYS.contains(&name.as_str()));
        files
    };
    assert!(mine("r") == mine("whole300"));
    named(&scratch.small("--samples 900 --out r", 0));
    scratch.prints("verify r", 0);
    let same = |name: &str| {
        let [r, whole] = ["r", "whole900"].map(|result| fs::read(scratch.path(result).join(name)).unwrap());
        assert!(r == whole, "{name}");
    };
    ["runs/part-000003.parquet", "statistics.parquet", "summary.json"].into_iter().for_each(same);
    assert!(strays.iter().all(|path| fs::read_to_string(path).unwrap() == "precious"));
    scratch.small_shows("--samples 300 --out r --overwrite", 4, "not part of a result of spindrift; move it away");
    assert!(strays.iter().all(|path| path.exists()));
}

/// Law: a part or time series that no manifest lists blocks only its replacement or removal.
#[test]
fn what_no_manifest_lists_is_left_alone() {
    let scratch = folder("strays-part");
    scratch.small("--out r", 0);
    let before = contents(&scratch.path("r"));
    for name in ["runs/part-000003.parquet", "bands/part-000099.parquet", "trajectories/sample-000007.parquet"] {
        let stray = plant(&scratch, "r", &[name]).remove(0);
        for command in ["campaign small.toml --out r", "verify r", "finish r", "report r"] {
            let said = scratch.prints(command, 0);
            let is_named = said.contains(&format!("{name}: not part of the result; left alone"));
            assert!(is_named || command == "report r", "{command}: {said}");
        }
        for options in ["--samples 2000", "--seed 9 --overwrite"] {
            let said = scratch.small(&format!("--out r {options}"), 4);
            assert!(said.contains(&format!("`{name}`, which is not part of a result")), "{options}: {said}");
        }
        assert_eq!(fs::read_to_string(&stray).unwrap(), "precious");
        fs::remove_file(stray).unwrap();
        assert!(contents(&scratch.path("r")) == before, "{name}");
    }
}
