//! Files of other rows with right seals and checksums, and results that have lost the identity of their rows.

use crate::prelude::*;

use spindrift::storage::dataset::{FileRecord, Manifest};
use spindrift::storage::identity::{seal, sha256};

use crate::reliability::interrupted::assert_same;

/// Writes files of the result `r`, each with its checksum in the manifest, which is sealed again.
pub fn alter(scratch: &ScratchFolder, files: &[(&str, &[u8])]) {
    let root = scratch.path("r");
    let mut manifest = Manifest::of(&fs::read(root.join("manifest.json")).unwrap()).unwrap();
    let mut listed: BTreeMap<String, FileRecord> =
        manifest.files.into_iter().map(|file| (file.name.clone(), file)).collect();
    for (name, bytes) in files {
        fs::write(root.join(name), bytes).unwrap();
        listed.insert((*name).to_owned(), FileRecord::of(name, bytes)).unwrap();
    }
    manifest.files = listed.into_values().collect();
    fs::write(root.join("manifest.json"), manifest.bytes()).unwrap();
}

fn two_seeds(name: &str, samples: u64) -> ScratchFolder {
    let scratch = folder(name);
    for (result, seed) in [("r", 7), ("other", 8)] {
        scratch.small(&format!("--samples {samples} --seed {seed} --no-report --out {result}"), 0);
    }
    scratch
}

/// Law: every command that reads rows finds a whole part of another seed by the metadata of its file.
#[test]
fn a_part_of_another_seed_is_found() {
    let scratch = two_seeds("false-rows", 300);
    let (whole, other) = (contents(&scratch.path("r")), contents(&scratch.path("other")));
    for (command, code) in [
        ("verify r --fraction 0", 4),
        ("report r", 4),
        ("compare r r", 4),
        ("campaign small.toml --only-failed-of r --out x", 4),
        ("finish r", 4),
        ("campaign small.toml --samples 300 --no-report --out r", 0),
    ] {
        let names = ["runs/part-000001.parquet", "bands/part-000001.parquet"];
        if scratch.path("r/manifest.json").exists() {
            alter(&scratch, &names.map(|name| (name, &*other[name])));
        }
        names.iter().for_each(|name| fs::write(scratch.path("r").join(name), &other[*name]).unwrap());
        let said = scratch.prints(command, code);
        assert!(said.contains("rows of another plan (seed 8"), "{command}: {said}");
    }
    assert!(contents(&scratch.path("r")) == whole);
}

/// Law: `verify` with any fraction above zero computes a part again and finds bands of another seed under right
/// checksums.
#[test]
fn any_fraction_computes_a_part() {
    let scratch = two_seeds("false-bands", 20);
    let (whole, other) = (contents(&scratch.path("r")), contents(&scratch.path("other")));
    let [rows, bands] = ["runs", "bands"].map(|folder| format!("{folder}/part-000000.parquet"));
    let mut altered = whole[&rows].clone();
    let [mine, others] = [&whole, &other].map(|files| sha256(&files[&bands]));
    let at = altered.windows(mine.len()).position(|some| some == mine.as_bytes()).unwrap();
    altered[at..at + mine.len()].copy_from_slice(others.as_bytes());
    seal(&mut altered);
    alter(&scratch, &[(&rows, &altered), (&bands, &other[&bands])]);
    for fraction in ["0", "1e-9", "0.4", "1"] {
        let said = scratch.prints(&format!("verify r --fraction {fraction}"), 4);
        let found = if fraction == "0" { "bands.parquet: is not what" } else { "its rows are not those of the plan" };
        assert!(said.contains(found), "{fraction}: {said}");
    }
    scratch.prints("verify r --fraction 1 --repair", 0);
    assert!(contents(&scratch.path("r")) == whole);
}

/// Law: without a sound `dataset.json` rows are known by their metadata; the same plan heals it.
#[test]
fn a_damaged_head_adopts_no_other_plan() {
    let scratch = two_seeds("false-head", 300);
    let whole = contents(&scratch.path("r"));
    let head = scratch.path("r/dataset.json");
    let length = whole["dataset.json"].len();
    for (index, at) in [3, length / 2, length - 9, length].into_iter().enumerate() {
        let mut changed = whole["dataset.json"].clone();
        match changed.get_mut(at) {
            Some(byte) => {
                *byte ^= 4;
                fs::write(&head, changed).unwrap();
            }
            None => fs::remove_file(&head).unwrap(),
        }
        if index % 2 == 1 {
            ["r/manifest.json", "r/_SUCCESS"].into_iter().for_each(|name| fs::remove_file(scratch.path(name)).unwrap());
        }
        scratch.small_shows("--samples 300 --seed 8 --no-report --out r", 4, "seed");
        assert!(scratch.prints("verify r", 4).contains("dataset.json"));
        let repairs =
            ["verify r --repair", "campaign small.toml --samples 300 --no-report --out r", "finish r --no-report"];
        scratch.prints(repairs[index % 3], 0);
        assert!(contents(&scratch.path("r")) == whole, "byte {at}");
    }
}

/// Law: the seal of a file is that of its end, even where the name of the campaign reads as one.
#[test]
fn a_campaign_may_have_the_name_of_a_seal() {
    let scratch = folder("false-seal");
    scratch.file("small.toml", &sized(20).replace("\"small\"", "\"spindrift.seal.0123456789abcdef\""));
    scratch.small("--no-report --out r", 0);
    scratch.shows("verify r", 0, "sound");
}

/// Law: parts of different plans are never merged: `finish` names the odd one, and the campaign's command makes it
/// again.
#[test]
fn shards_of_two_plans_are_not_merged() {
    let scratch = folder("false-shards");
    for (result, seed, shard) in [("r", 7, "1/2"), ("other", 8, "2/2")] {
        scratch.small(&format!("--seed {seed} --shard {shard} --out {result}"), 0);
    }
    scratch.small_shows("--seed 8 --shard 2/2 --out r", 4, "campaign.seed: 7 there, 8 here");
    // without its plan: by hashes
    let longer = "--set campaign.duration_s=2 --shard 2/2 --out";
    scratch.small(&format!("{longer} longer"), 0);
    fs::rename(scratch.path("r/plan.toml"), scratch.path("plan.toml")).unwrap();
    let [there, here] = ["r", "longer"].map(|result| {
        let head: serde_json::Value = serde_json::from_str(&scratch.text(&format!("{result}/dataset.json"))).unwrap();
        head["row_hash"].as_str().unwrap().to_owned()
    });
    let words = format!("hash of the rows: {there} there, {here} here");
    scratch.small_shows(&format!("{longer} r"), 4, &words);
    fs::rename(scratch.path("plan.toml"), scratch.path("r/plan.toml")).unwrap();
    for folder in ["runs", "bands"] {
        let name = format!("{folder}/part-000001.parquet");
        fs::copy(scratch.path("other").join(&name), scratch.path("r").join(&name)).unwrap();
    }
    for command in ["verify r", "finish r"] {
        let said = scratch.prints(command, 4);
        assert!(said.contains("runs/part-000001.parquet: has the rows of another plan (seed 8"), "{command}: {said}");
    }
    scratch.small("--no-report --out r", 0);
    scratch.small("--no-report --out whole", 0);
    assert_same(&scratch, "r", "whole");
}

/// Law: a result of an earlier format is refused by name, by every command and with `--overwrite`, and stays.
#[test]
fn an_earlier_format_is_refused_by_name() {
    let scratch = folder("false-format");
    fs::create_dir_all(scratch.path("r/runs")).unwrap();
    scratch.file("r/manifest.jsonl", "{\"spindrift\":\"dataset\",\"format\":5}\n");
    scratch.file("r/runs/part-000000.parquet", "PAR1");
    let before = contents(&scratch.path("r"));
    for command in ["campaign small.toml --out r", "campaign small.toml --overwrite --out r", "verify r", "report r"] {
        let said = scratch.prints(command, 4);
        assert!(said.contains("a result of format 5"), "{command}: {said}");
    }
    assert!(contents(&scratch.path("r")) == before);
}
