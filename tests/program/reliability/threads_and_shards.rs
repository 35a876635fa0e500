//! A dataset has the same bytes whatever the number of threads and shards.

use crate::prelude::*;

use crate::results::statistics::MORE;

const THREADS: [u32; 4] = [1, 2, 3, 7];
const SHARDS: [u32; 3] = [1, 4, 13];

/// Law: all files are the same for 1, 2, 3 and 7 threads in 1, 4 and 13 shards; those of another seed are not.
#[test]
fn threads_and_shards_change_no_byte() {
    let scratch = folder("threads-shards");
    let rest = "\n[audit]\nfraction = 0.001\n[retain]\ntrajectories = \"worst:3 by energy_error_max\"\n";
    let text = [&sized(3600), NEGATIVE_WALLS, MORE, rest].concat();
    scratch.file("all.toml", &text);
    let mut first = None;
    for shards in SHARDS {
        for threads in THREADS {
            if shards == 1 {
                scratch.prints(&format!("campaign all.toml --threads {threads} --out r"), 1);
            } else {
                for shard in (1..=shards).rev() {
                    if shard == 1 {
                        assert_says(scratch.prints("finish r", 4), ["missing", "spindrift campaign"]);
                    }
                    scratch
                        .prints(&format!("campaign all.toml --threads {threads} --shard {shard}/{shards} --out r"), 0);
                }
                scratch.prints(&format!("finish r --threads {threads}"), 1);
            }
            let found = contents(&scratch.path("r"));
            assert!(*first.get_or_insert_with(|| found.clone()) == found, "{threads} threads, {shards} shards");
            fs::remove_dir_all(scratch.path("r")).unwrap();
        }
    }
    scratch.prints("campaign all.toml --seed 8 --out r", 1);
    let (other, first) = (contents(&scratch.path("r")), first.unwrap());
    assert!(["runs/part-000000.parquet", "statistics.parquet"].iter().all(|name| other[*name] != first[*name]));
}

/// Law: a shard checks and counts its own parts only; `finish` checks all of them.
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
    assert!(!said.contains("damaged") && said.contains("768 samples already there, 0 to run"), "{said}");
    assert_says(scratch.prints("finish r", 4), ["part-000001", "missing"]);
    scratch.shows(&shard(2), 0, "464 samples already there, 256 to run");
    assert!(fs::read(part(1)).unwrap() == whole);
    scratch.prints("finish r", 0);
}
