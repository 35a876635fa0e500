//! One SHA-256 for a dataset, whatever the number of threads and of shards that made it.

use std::fs;

use spindrift::storage::identity::sha256;

use crate::results::statistics::MORE;
use crate::small_campaign::{NEGATIVE_WALLS, campaign, folder};
use crate::support::scratch_folder::ScratchFolder;

const THREADS: [u32; 4] = [1, 2, 3, 7];
const SHARDS: [u32; 3] = [1, 4, 13];

/// SHA-256 of the names and contents of all files of a result below the given ones.
fn hash(scratch: &ScratchFolder, result: &str, below: &[&str]) -> String {
    let mut paths: Vec<_> = below.iter().map(|name| scratch.path(result).join(name)).collect();
    let mut all = Vec::new();
    while let Some(path) = paths.pop() {
        if path.is_dir() {
            paths.extend(fs::read_dir(&path).unwrap().map(|entry| entry.unwrap().path()));
        } else {
            let name = path.strip_prefix(scratch.path(result)).unwrap().display().to_string();
            all.push(format!("{name} {}\n", sha256(&fs::read(&path).unwrap())));
        }
    }
    all.sort();
    assert!(!all.is_empty());
    sha256(all.concat().as_bytes())
}

/// Law: rows, statistics and everything else are the same bytes for 1, 2, 3 and 7 threads in 1, 4 and 13 shards; those
/// of another seed are not.
#[test]
fn threads_and_shards_change_no_byte() {
    let scratch = folder("threads-shards");
    // some samples are not physical, and some runs are audited and kept
    // beside the columns there are expressions
    let rest = "\n[audit]\nfraction = 0.001\n[retain]\ntrajectories = \"worst:3 by energy_error_max\"\n";
    scratch.file(
        "all.toml",
        &[&campaign().replace("samples = 600", "samples = 3600"), NEGATIVE_WALLS, MORE, rest].concat(),
    );
    let rows = ["runs", "statistics.parquet"];
    let hashes = |result: &str| [hash(&scratch, result, &rows), hash(&scratch, result, &[""])];
    let mut first: Option<[String; 2]> = None;
    for shards in SHARDS {
        for threads in THREADS {
            if shards == 1 {
                scratch.prints(&format!("campaign all.toml --threads {threads} --out r"), 1);
            } else {
                // in any order: the first comes last, and until then `finish` says what is missing
                for shard in (1..=shards).rev() {
                    if shard == 1 {
                        let said = scratch.prints("finish r", 4);
                        assert!(said.contains("missing") && said.contains("spindrift campaign"), "{said}");
                    }
                    scratch
                        .prints(&format!("campaign all.toml --threads {threads} --shard {shard}/{shards} --out r"), 0);
                }
                scratch.prints(&format!("finish r --threads {threads}"), 1);
            }
            let found = hashes("r");
            let first = first.get_or_insert_with(|| found.clone());
            assert_eq!(&found, first, "{threads} threads, {shards} shards");
            fs::remove_dir_all(scratch.path("r")).unwrap();
        }
    }
    scratch.prints("campaign all.toml --seed 8 --out r", 1);
    let (other, first) = (hashes("r"), first.unwrap());
    assert!(other[0] != first[0] && other[1] != first[1]);
}

/// Law: a shard checks and counts its own parts, and not those of others, which may be many; `finish` checks all of
/// them.
#[test]
fn a_shard_reads_its_own_parts() {
    let scratch = folder("shards-own");
    let shard = |k: u32| format!("campaign small.toml --samples 2000 --shard {k}/3 --out r");
    for k in 1..=3 {
        scratch.prints(&shard(k), 0);
    }
    let part = |number: u32| scratch.path(&format!("r/runs/part-{number:06}.parquet"));
    let whole = fs::read(part(1)).unwrap();
    fs::write(part(1), b"x").unwrap();
    let said = scratch.prints(&shard(1), 0);
    // parts 0, 3 and 6 of 256
    assert!(!said.contains("damaged") && said.contains("768 samples already there, 0 to run"), "{said}");
    let said = scratch.prints("finish r", 4);
    assert!(said.contains("part-000001") && said.contains("missing"), "{said}");
    // parts 1, 4 and 7, which has 208
    let said = scratch.prints(&shard(2), 0);
    assert!(said.contains("464 samples already there, 256 to run"), "{said}");
    assert!(fs::read(part(1)).unwrap() == whole);
    scratch.prints("finish r", 0);
}
