//! Manifests whose lines have the right checksums and say what is not so, or that have lost what the rows are.

use std::fs;

use spindrift::storage::identity::sha256;

use crate::small_campaign::folder;
use crate::support::scratch_folder::ScratchFolder;

/// A line of a manifest: `body` without its last brace, and the checksum of that.
fn line(body: &str) -> String {
    format!("{body},\"crc\":\"{:08x}\"}}", crc32fast::hash(body.as_bytes()))
}

fn lines(scratch: &ScratchFolder, result: &str) -> Vec<String> {
    let text = scratch.text(&format!("{result}/manifest.jsonl"));
    text.lines().map(str::to_owned).collect()
}

fn write(scratch: &ScratchFolder, result: &str, lines: &[String]) {
    scratch.file(&format!("{result}/manifest.jsonl"), &(lines.join("\n") + "\n"));
}

/// Law: a last line with another number of rows or parts than the lines before it, or one that says `false`, finishes
/// nothing: the result is not compared, and the campaign's command finishes it.
#[test]
fn a_false_last_line_finishes_nothing() {
    let scratch = folder("false-end");
    scratch.prints("campaign small.toml --samples 300 --no-report --out r", 0);
    let whole = lines(&scratch, "r");
    let last = whole.last().unwrap();
    let (body, _) = last.rsplit_once(",\"crc\"").unwrap();
    let counts = |text: &str| line(&body.replace("true,\"parts\":2,\"rows\":300", text));
    assert_eq!(*last, counts("true,\"parts\":2,\"rows\":300"));
    for (finished, parts, rows) in
        [("true", 2, 299), ("true", 2, 301), ("true", 1, 300), ("true", 3, 300), ("false", 2, 300)]
    {
        let mut changed = whole.clone();
        *changed.last_mut().unwrap() = counts(&format!("{finished},\"parts\":{parts},\"rows\":{rows}"));
        assert_ne!(changed, whole);
        write(&scratch, "r", &changed);
        scratch.prints("compare r r", 2);
        scratch.prints("campaign small.toml --samples 300 --no-report --out r", 0);
        assert_eq!(lines(&scratch, "r"), whole, "{finished} {parts} {rows}");
        scratch.prints("compare r r", 0);
    }
}

/// A result of 300 samples under seed 7, and one under seed 8.
fn two_seeds(name: &str) -> ScratchFolder {
    let scratch = folder(name);
    for (result, seed) in [("r", 7), ("other", 8)] {
        scratch.prints(&format!("campaign small.toml --samples 300 --seed {seed} --no-report --out {result}"), 0);
    }
    scratch
}

/// Law: a part of another seed under a line with the right checksums is found by every command that reads rows: by what
/// its file says of itself.
#[test]
fn a_part_of_another_seed_is_found() {
    let scratch = two_seeds("false-rows");
    let (mine, others) = (lines(&scratch, "r"), lines(&scratch, "other"));
    let damage = || {
        let mut mixed = mine.clone();
        mixed[3] = others[3].clone();
        write(&scratch, "r", &mixed);
        for file in ["runs/part-000001.parquet", "bands/part-000001.parquet"] {
            fs::copy(scratch.path("other").join(file), scratch.path("r").join(file)).unwrap();
        }
    };
    for (command, code) in [
        ("verify r --fraction 0", 4),
        ("report r", 4),
        ("compare r r", 4),
        ("campaign small.toml --only-failed-of r --out x", 4),
        ("finish r", 4),
        ("campaign small.toml --samples 300 --no-report --out r", 0),
    ] {
        damage();
        let said = scratch.prints(command, code);
        assert!(said.contains("rows of another plan (seed 8"), "{command}: {said}");
    }
    assert_eq!(lines(&scratch, "r"), mine);
}

/// Law: `verify` computes a part again where the fraction is above zero, however small: it finds bands of another seed
/// under right checksums.
#[test]
fn any_fraction_computes_a_part() {
    let scratch = folder("false-bands");
    for (result, seed) in [("r", 7), ("other", 8)] {
        scratch.prints(&format!("campaign small.toml --samples 20 --seed {seed} --no-report --out {result}"), 0);
    }
    let bands = |result: &str| fs::read(scratch.path(result).join("bands/part-000000.parquet")).unwrap();
    let of = |bytes: &[u8]| format!("\"bytes\":{},\"sha256\":\"{}\"", bytes.len(), sha256(bytes));
    let whole = lines(&scratch, "r");
    let mut changed = whole.clone();
    let (body, _) = whole[2].rsplit_once(",\"crc\"").unwrap();
    changed[2] = line(&body.replace(&of(&bands("r")), &of(&bands("other"))));
    assert_ne!(changed, whole);
    write(&scratch, "r", &changed);
    fs::write(scratch.path("r/bands/part-000000.parquet"), bands("other")).unwrap();
    for fraction in ["0", "1e-9", "0.4", "1"] {
        let said = scratch.prints(&format!("verify r --fraction {fraction}"), 4);
        // without runs it is found by what follows from all of them
        let found = if fraction == "0" { "bands.parquet: is not what" } else { "its rows are not those of the plan" };
        assert!(said.contains(found), "{fraction}: {said}");
    }
    // right checksums of other rows: another program made them, or somebody replaced them
    scratch.prints("verify r --fraction 1 --repair", 4);
    scratch.prints("campaign small.toml --samples 20 --no-report --overwrite --out r", 0);
    assert_eq!(lines(&scratch, "r"), whole);
}

/// Law: where any bit of the first line has changed, the rows are still known by their own metadata: another plan is
/// refused, and the same one heals the line.
#[test]
fn a_damaged_first_line_adopts_no_other_plan() {
    let scratch = two_seeds("false-first");
    let path = scratch.path("r/manifest.jsonl");
    let whole = fs::read(&path).unwrap();
    let length = whole.iter().position(|byte| *byte == b'\n').unwrap();
    for at in [3, length / 2, length - 3] {
        let mut changed = whole.clone();
        changed[at] ^= 4;
        fs::write(&path, changed).unwrap();
        let said = scratch.prints("campaign small.toml --samples 300 --seed 8 --no-report --out r", 4);
        assert!(said.contains("seed"), "{said}");
        fs::copy(scratch.path("other/plan.toml"), scratch.path("r/plan.toml")).unwrap();
        let said = scratch.prints("verify r", 4);
        assert!(said.contains("plan.toml") && said.contains("manifest.jsonl:1"), "{said}");
        let repair =
            if at == 3 { "verify r --repair" } else { "campaign small.toml --samples 300 --no-report --out r" };
        scratch.prints(repair, 0);
        assert!(fs::read(&path).unwrap() == whole, "byte {at}");
    }
}

/// Law: shards of different plans are never merged: `finish` says which manifest differs, in which keys, and so does
/// every other command.
#[test]
fn shards_of_two_plans_are_refused() {
    let scratch = folder("false-shards");
    for (result, seed, shard) in [("r", 7, "1/2"), ("other", 8, "2/2")] {
        scratch.prints(&format!("campaign small.toml --seed {seed} --shard {shard} --out {result}"), 0);
    }
    for folder in ["runs", "bands", "shards"] {
        for entry in fs::read_dir(scratch.path("other").join(folder)).unwrap() {
            let path = entry.unwrap().path();
            fs::copy(&path, scratch.path("r").join(folder).join(path.file_name().unwrap())).unwrap();
        }
    }
    for command in ["finish r", "verify r", "campaign small.toml --out r", "campaign small.toml --shard 1/2 --out r"] {
        let said = scratch.prints(command, 4);
        for part in ["shards/2-of-2.jsonl is of another plan than manifest.jsonl", "campaign.seed: 7", "8 in shards/2"]
        {
            assert!(said.contains(part), "{command}: {said}");
        }
    }
    fs::remove_file(scratch.path("r/shards/2-of-2.jsonl")).unwrap();
    scratch.prints("finish r", 4);
    scratch.prints("campaign small.toml --no-report --out r", 0);
    scratch.prints("campaign small.toml --no-report --out whole", 0);
    assert_eq!(lines(&scratch, "r"), lines(&scratch, "whole"));
}
