//! Whatever happens to a file that follows from the rows is found, and the file is made again.

use crate::prelude::*;

use crate::reliability::{
    altered_results::everything,
    failing_store::contents,
    interrupted::{is_ignored, send, start},
};

/// Law: any changed file is named by `verify` and refused by readers; each repair makes the same bytes.
#[test]
fn every_damage_is_found_and_made_again() {
    let scratch = folder("derived");
    everything(&scratch, "r", 7);
    let root = scratch.path("r");
    let whole = contents(&root);
    let names: Vec<&String> =
        whole.keys().filter(|name| !["manifest.json", "_SUCCESS"].contains(&name.as_str())).collect();
    for kind in ["summary.json", "statistics", "sensitivity", "bands.parquet", "report.html", "plan.toml"] {
        assert!(names.iter().any(|name| name.contains(kind)), "{kind} in {names:?}");
    }
    for folder in ["runs/", "bands/", "trajectories/", "data/"] {
        assert!(names.iter().any(|name| name.starts_with(folder)), "{folder} in {names:?}");
    }
    let damages: [fn(&mut Vec<u8>); 4] = [
        |bytes| {
            let middle = bytes.len() / 2;
            bytes[middle] ^= 1;
        },
        |bytes| bytes.truncate(bytes.len() - 1),
        Vec::clear,
        |bytes| *bytes = b"other".to_vec(),
    ];
    let repairs = [("verify r --repair", 0), ("campaign all.toml --out r", 3), ("finish r", 3)];
    for (index, name) in names.into_iter().enumerate() {
        let path = root.join(name.as_str());
        for way in 0..=damages.len() {
            match damages.get(way) {
                Some(damage) => {
                    let mut bytes = whole[name].clone();
                    damage(&mut bytes);
                    fs::write(&path, bytes).unwrap();
                }
                None => fs::remove_file(&path).unwrap(),
            }
            let said = scratch.prints("verify r --fraction 0", 4);
            assert!(said.contains(name.as_str()), "{name}: {said}");
            scratch.prints("compare r r", 4);
            let is_of_rows = ["runs/", "bands/"].iter().any(|folder| name.starts_with(folder));
            let repair = match name.split('/').next() {
                Some("data") => 1,
                _ if is_of_rows => (index + way) % 2,
                _ => (index + way) % repairs.len(),
            };
            if is_of_rows || name.starts_with("data/") {
                scratch.prints("finish r", 4);
            }
            let (repair, code) = repairs[repair];
            scratch.prints(repair, code);
            assert!(contents(&root) == whole, "{name}, way {way}: {repair}");
        }
    }
    scratch.prints("verify r --fraction 1", 0);
}

/// Law: a page made again is listed with its checksum, provided that nothing else is damaged.
#[test]
fn a_page_that_is_made_again_is_listed() {
    let scratch = folder("derived-page");
    everything(&scratch, "r", 7);
    let root = scratch.path("r");
    let whole = contents(&root);
    fs::write(root.join("report.html"), "other").unwrap();
    scratch.prints("report r", 0);
    assert!(contents(&root) == whole);
    scratch.prints("campaign all.toml --no-report --overwrite --out bare", 3);
    scratch.prints("report bare", 0);
    scratch.prints("verify bare", 0);
    assert!(contents(&scratch.path("bare")) == whole);
    fs::write(root.join("statistics.parquet"), "other").unwrap();
    scratch.prints("report r", 4);
}

/// Law: a flipped bit at any byte of a file of rows ends `report` and `compare`, and nothing is written.
#[test]
fn rows_with_a_flipped_bit_are_not_read() {
    let scratch = folder("derived-flips");
    scratch.small("--samples 300 --out r", 0);
    let path = scratch.path("r/runs/part-000001.parquet");
    let whole = fs::read(&path).unwrap();
    let page = fs::read(scratch.path("r/report.html")).unwrap();
    for part in 0..20 {
        let mut bytes = whole.clone();
        bytes[part * whole.len() / 20] ^= 1 << (part % 8);
        fs::write(&path, bytes).unwrap();
        for command in ["report r", "compare r r"] {
            assert!(scratch.prints(command, 4).contains("runs/part-000001.parquet"), "byte {part}/20");
        }
    }
    assert!(fs::read(scratch.path("r/report.html")).unwrap() == page);
}

/// Law: an unfinished extension has no summary, since that of the rows before would be false.
#[test]
fn an_unfinished_extension_has_no_summary() {
    let scratch = folder("derived-summary");
    scratch.small("--samples 300 --no-report --out r", 0);
    scratch.small("--samples 900 --no-report --shard 1/2 --out r", 0);
    assert!(!scratch.path("r/summary.json").exists());
    scratch.small("--samples 900 --no-report --out r", 0);
    assert_eq!((&scratch.summary("r")["finished"], &scratch.summary("r")["samples"]), (&true.into(), &900.into()));
}

/// Law: a repair stopped by a signal finishes nothing and ends with its code; the same command continues.
#[test]
#[cfg(unix)]
fn a_repair_that_is_stopped_continues() {
    if is_ignored(2) {
        return;
    }
    let scratch = folder("derived-stopped");
    let samples = "campaign small.toml --samples 20000 --no-report --threads 1 --out r";
    scratch.prints(samples, 0);
    let whole = contents(&scratch.path("r"));
    let mut stopped = 0;
    for tenths in [1, 2, 4, 8, 16] {
        let parts = scratch.part_files("r");
        for path in &parts {
            fs::write(path, "damaged").unwrap();
        }
        let mut child = start(&scratch, "verify r --repair --fraction 0 --threads 1");
        let is_made_again = |path| fs::read(path).is_ok_and(|bytes| bytes != b"damaged");
        let begun = Instant::now();
        while !parts.iter().any(is_made_again) && begun.elapsed() < Duration::from_secs(20) {
            std::thread::sleep(Duration::from_millis(1));
        }
        std::thread::sleep(Duration::from_millis(tenths));
        send("INT", child.id());
        let code = child.wait().unwrap().code();
        if code == Some(130) {
            stopped += 1;
            assert!(!scratch.path("r/_SUCCESS").exists(), "a part of the rows is no result");
            scratch.prints("report r", 2);
            scratch.prints("finish r", 4);
        } else {
            assert_eq!(code, Some(0), "either stopped or done");
        }
        scratch.prints("verify r --repair", 0);
        assert!(contents(&scratch.path("r")) == whole);
    }
    assert!(stopped > 0, "no repair was stopped in time");
}

/// Law: a result without a manifest keeps its sound parts, and without its plan nothing is made.
#[test]
fn a_lost_manifest_is_made_again() {
    let scratch = folder("derived-manifest");
    scratch.small("--out r", 0);
    let root = scratch.path("r");
    let whole = contents(&root);
    for damaged in [None, Some("runs/part-000001.parquet"), Some("bands/part-000002.parquet")] {
        fs::remove_file(root.join("manifest.json")).unwrap();
        if let Some(name) = damaged {
            let mut bytes = whole[name].clone();
            let middle = bytes.len() / 2;
            bytes[middle] ^= 1;
            fs::write(root.join(name), bytes).unwrap();
        }
        let said = scratch.prints("verify r", 4);
        assert!(said.contains("manifest.json: missing") && damaged.is_none_or(|name| said.contains(name)), "{said}");
        assert!(scratch.prints("report r", 4).contains("manifest.json: missing"));
        scratch.prints("verify r --repair", 0);
        assert!(contents(&root) == whole, "{damaged:?}");
    }
    fs::remove_file(root.join("manifest.json")).unwrap();
    scratch.file("r/plan.toml", &scratch.text("r/plan.toml").replace("seed = 7", "seed = 8"));
    assert!(scratch.prints("verify r --repair", 4).contains("plan.toml is not the plan of the rows"));
    assert!(!root.join("manifest.json").exists());
}

/// Law: a page that nothing lists is named and left alone.
#[test]
fn unlisted_files_are_left_alone() {
    let scratch = folder("derived-foreign");
    scratch.small("--no-report --out r", 0);
    scratch.file("r/report.html", "another page");
    scratch.shows("verify r", 0, "report.html: not part of the result");
    assert_eq!(scratch.text("r/report.html"), "another page");
}

/// Law: a shard on a finished result changes nothing; other requirements are refused with their keys.
#[test]
fn shards_change_no_finished_result() {
    let scratch = folder("derived-shards");
    let require = |limit: &str| {
        let gate = format!("\n[[require]]\nobservable = \"energy_error_max\"\nquantile = 0.5\nat_most = {limit}\n");
        campaign() + &gate
    };
    scratch.file("strict.toml", &require("1e-30"));
    scratch.file("loose.toml", &require("1.0"));
    scratch.prints("campaign strict.toml --no-report --shard 1/2 --out r", 0);
    assert_says(scratch.prints("campaign loose.toml --no-report --shard 2/2 --out r", 4), ["require", "1e-30", "1.0"]);
    scratch.prints("campaign strict.toml --no-report --out r", 3);
    let whole = contents(&scratch.path("r"));
    scratch.prints("campaign strict.toml --no-report --shard 1/2 --out r", 0);
    assert!(contents(&scratch.path("r")) == whole);
    scratch.prints("campaign loose.toml --no-report --shard 1/2 --out r", 4);
    assert!(contents(&scratch.path("r")) == whole);
    scratch.prints("campaign strict.toml --no-report --out r", 3);
}
