//! Manifests whose lines have the right checksums and say what is not so.

use std::fs;

use super::small_campaign::folder;
use crate::support::scratch_folder::ScratchFolder;

/// A line of a manifest: `body` without its last brace, and the checksum of that.
fn line(body: &str) -> String {
    format!("{body},\"crc\":\"{:08x}\"}}", crc32fast::hash(body.as_bytes()))
}

fn lines(scratch: &ScratchFolder, result: &str) -> Vec<String> {
    let text = fs::read_to_string(scratch.path(result).join("manifest.jsonl")).unwrap();
    text.lines().map(str::to_owned).collect()
}

fn write(scratch: &ScratchFolder, result: &str, lines: &[String]) {
    scratch.file(&format!("{result}/manifest.jsonl"), &(lines.join("\n") + "\n"));
}

/// Law: a last line with another number of rows or parts than the lines before it, or one that says `false`, finishes nothing: the result is
/// not compared, and the campaign's command finishes it.
#[test]
fn a_false_last_line_finishes_nothing() {
    let scratch = folder("false-end");
    scratch.prints("campaign small.toml --samples 300 --no-report --out r", 0);
    let whole = lines(&scratch, "r");
    let end = |finished: bool, parts: u64, rows: u64| {
        line(&format!("{{\"finished\":{finished},\"parts\":{parts},\"rows\":{rows}"))
    };
    assert_eq!(whole.last(), Some(&end(true, 2, 300)));
    for last in [end(true, 2, 299), end(true, 2, 301), end(true, 1, 300), end(true, 3, 300), end(false, 2, 300)] {
        let mut changed = whole.clone();
        *changed.last_mut().unwrap() = last.clone();
        write(&scratch, "r", &changed);
        scratch.prints("compare r r", 2);
        scratch.prints("campaign small.toml --samples 300 --no-report --out r", 0);
        assert_eq!(lines(&scratch, "r"), whole, "{last}");
        scratch.prints("compare r r", 0);
    }
}

/// Law: `verify` computes a part again where the fraction is above zero, however small: it finds rows of another seed under right checksums.
#[test]
fn any_fraction_computes_a_part() {
    let scratch = folder("false-rows");
    for (result, seed) in [("r", 7), ("other", 8)] {
        scratch.prints(&format!("campaign small.toml --samples 20 --seed {seed} --no-report --out {result}"), 0);
    }
    let (mine, others) = (lines(&scratch, "r"), lines(&scratch, "other"));
    write(&scratch, "r", &[mine[0].clone(), others[1].clone()]);
    fs::remove_file(scratch.path("r/_SUCCESS")).unwrap();
    for file in ["runs/part-000000.parquet", "bands/part-000000.bands"] {
        fs::copy(scratch.path("other").join(file), scratch.path("r").join(file)).unwrap();
    }
    for (fraction, code) in [("0", 0), ("1e-9", 4), ("0.4", 4), ("1", 4)] {
        scratch.prints(&format!("verify r --fraction {fraction}"), code);
    }
}
