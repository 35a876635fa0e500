//! The commands of docs/cluster.md that a cluster runs with an index, as they stand there but for the path of the program and of the result.

use std::process::Command;

use crate::small_campaign::folder;
use crate::support::scratch_folder::contents;

const DOCUMENT: &str = include_str!("../../../docs/cluster.md");
const SHARDS: usize = 8;

/// What stands between `before` and `after` in the document; it is there once.
fn between(before: &str, after: &str) -> String {
    let mut found = DOCUMENT.split(before).skip(1);
    let (first, more) = (found.next().unwrap_or_else(|| panic!("no {before}")), found.next());
    assert!(more.is_none(), "{before} is there twice");
    first.split_once(after).unwrap_or_else(|| panic!("no {after} after {before}")).0.to_owned()
}

/// Law: the shell commands of Kubernetes and of AWS Batch, with each index, make the result of one process to the byte.
#[test]
fn indexed_jobs_make_the_bytes_of_one_process() {
    let recipes = [
        ("JOB_COMPLETION_INDEX", between("command: [sh, -c, '", "']")),
        ("AWS_BATCH_JOB_ARRAY_INDEX", between("{\"command\": [\"sh\", \"-c\", \"", "\"]}")),
    ];
    let scratch = folder("cluster-recipes");
    scratch.prints("campaign small.toml --samples 9000 --out one", 0);
    let one = contents(&scratch.path("one"));
    let parts = one.keys().filter(|name| name.starts_with("runs/part-")).count();
    assert!(parts >= SHARDS, "{parts} parts: a shard has none");
    for (variable, recipe) in recipes {
        let mut command = recipe;
        for (written, here) in [
            ("exec spindrift ", concat!("exec '", env!("CARGO_BIN_EXE_spindrift"), "' ")),
            (" spin_sweep.toml ", " small.toml --samples 9000 "),
            ("/data/spin_sweep", variable),
        ] {
            assert_eq!(command.matches(written).count(), 1, "{written:?} in {command}");
            command = command.replace(written, here);
        }
        for index in 0..SHARDS {
            let shell = Command::new("sh")
                .args(["-c", &command])
                .env(variable, index.to_string())
                .current_dir(scratch.path(""))
                .output()
                .expect("a shell");
            assert!(shell.status.success(), "{command}: {}", String::from_utf8_lossy(&shell.stderr));
        }
        scratch.prints(&format!("finish {variable}"), 0);
        assert!(contents(&scratch.path(variable)) == one, "{variable}");
    }
}
