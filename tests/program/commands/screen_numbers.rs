//! Every number in a sentence of the screen, counted again.

use crate::prelude::*;

use crate::page::numbers::failing;
use crate::reliability::failing_store::contents;

pub(crate) fn template(line: &str) -> (String, Vec<f64>) {
    let (mut text, mut numbers) = (String::new(), Vec::new());
    let mut rest = line;
    while let Some(first) = rest.chars().next() {
        let is_within = text.ends_with(|last: char| last.is_alphanumeric() || "_.".contains(last));
        let digits = rest.strip_prefix('-').unwrap_or(rest);
        let mut end = 0;
        if !is_within && digits.starts_with(|digit: char| digit.is_ascii_digit()) {
            let all = rest.find(|c: char| !(c.is_ascii_digit() || "-.e".contains(c))).unwrap_or(rest.len());
            end = (1..=all).rev().find(|end| rest[..*end].parse::<f64>().is_ok()).unwrap_or(0);
        }
        if end > 0 {
            numbers.push(rest[..end].parse().unwrap());
            text.push('#');
            rest = &rest[end..];
        } else {
            text.push(if first == '#' { '@' } else { first });
            rest = &rest[first.len_utf8()..];
        }
    }
    (text, numbers)
}

pub(crate) fn numbers(said: &str, pattern: &str) -> Vec<f64> {
    let of = |line: &str| {
        let (text, numbers) = template(line);
        let before = text[..text.find(pattern)?].matches('#').count();
        Some(numbers[before..before + pattern.matches('#').count()].to_vec())
    };
    said.lines().find_map(of).unwrap_or_else(|| panic!("no `{pattern}` in:\n{said}"))
}

pub(crate) fn says(said: &str, pattern: &str, expected: &[f64]) {
    let found = numbers(said, pattern);
    let digits = if pattern.contains("[#") {
        1.01e-2
    } else if pattern.contains('%') {
        5.1e-3
    } else {
        6e-4
    };
    let is_same = |(found, expected): (&f64, &f64)| {
        let digits = if expected.fract() == 0.0 { 6e-4 } else { digits };
        (found - expected).abs() <= digits * expected.abs()
    };
    let ends = pattern.find("[#, #]").map(|at| pattern[..at].matches('#').count());
    let half = ends.map_or(0.0, |at| 0.05 * (expected[at + 1] - expected[at]).abs());
    let of_interval = |place: usize| ends.is_some_and(|at| (at.saturating_sub(1)..at + 2).contains(&place));
    let is_right = |(place, pair): (usize, (&f64, &f64))| {
        is_same(pair) || of_interval(place) && (pair.0 - pair.1).abs() <= half * 1.0001
    };
    assert!(
        found.len() == expected.len() && found.iter().zip(expected).enumerate().all(is_right),
        "{pattern}: {found:?}, {expected:?}"
    );
}

pub(crate) fn junit_counts(junit: &str) -> [usize; 3] {
    let counts = ["<testcase ", "<failure ", "<error "].map(|element| junit.matches(element).count());
    let heads = format!("tests=\"{}\" failures=\"{}\" errors=\"{}\"", counts[0], counts[1], counts[2]);
    assert_eq!(junit.matches(&heads).count(), 2, "{heads}: {junit}");
    counts
}

#[test]
fn a_check_estimates_what_is_made() {
    let scratch = ScratchFolder::new("screen-check");
    scratch.file("c.toml", &failing());
    let said = scratch.prints_wide("check c.toml", 0);
    scratch.prints("campaign c.toml --out r", 3);
    let columns = scratch.rows("r")[0].num_columns() as f64;
    let found = numbers(&said, "# columns; # files of rows, page and tables: about # MB; memory: at most # MB");
    assert_eq!(found[..2], [columns, scratch.parts("r").len() as f64]);
    let written = contents(&scratch.path("r")).values().map(Vec::len).sum::<usize>() as f64 / 1e6;
    assert!((0.67..1.5).contains(&(found[2] / written)), "{} MB for {written}", found[2]);
    assert!((30.0..300.0).contains(&found[3]), "{said}");
    let [milliseconds, samples, cores, seconds] =
        numbers(&said, "# ms per run on one core; # samples on # cores: about # s")[..]
    else {
        panic!("{said}")
    };
    assert_eq!(samples, 600.0);
    assert!((seconds * cores * 1e3 / samples - milliseconds).abs() < 1.1e-2 * milliseconds, "{said}");
    let found =
        numbers(&said, "audit of # of the samples, from # audits: # ms each; about # audits on # cores: # s more");
    let [fraction, _, milliseconds, audits, cores, seconds] = found[..] else { panic!("{said}") };
    assert_eq!([fraction, audits], [0.2, 120.0]);
    assert!((seconds * cores * 1e3 / audits - milliseconds).abs() < 6e-4 * milliseconds + 0.05, "{said}");
}

#[test]
fn other_commands_count_what_is_there() {
    let scratch = ScratchFolder::new("screen-others");
    scratch.file("c.toml", &mixed_failures());
    scratch.prints("campaign c.toml --out r", 1);
    let failed = ended(&scratch.rows("r")).iter().filter(|(_, status)| status != "ok").count() as f64;
    let of_300 = ended(&scratch.rows("r"))[..300].iter().filter(|(_, status)| status != "ok").count() as f64;
    let parts = scratch.part_files("r");
    let rows = |file: &PathBuf| batches(file).iter().map(|batch| batch.num_rows()).sum::<usize>() as f64;
    assert!(parts.len() > 1 && failed > 100.0);
    let (count, all) = (parts.len() as f64, parts.iter().map(rows).sum::<f64>());
    let size = std::fs::metadata(scratch.path("r/report.html")).unwrap().len() as f64;
    let compared = "# parts, # rows: checksums compared; # parts with # rows";
    for (command, code, pattern, known) in [
        ("verify r --fraction 1", 0, compared, vec![count, all, count, all]),
        ("verify r --fraction 0", 0, compared, vec![count, all, 0.0, 0.0]),
        ("campaign c.toml --out r", 1, "already complete in r (# samples, # of them failed)", vec![all, failed]),
        ("campaign c.toml --samples 300 --out u", 1, "small: # of # runs", vec![300.0 - of_300, 300.0]),
        ("campaign c.toml --out u", 1, "small: # samples already there, # to run", vec![256.0, all - 256.0]),
        ("campaign c.toml --out s --shard 1/2", 0, "shard #/# is complete", vec![1.0, 2.0]),
        ("campaign c.toml --out s --shard 2/2", 0, "shard #/# is complete", vec![2.0, 2.0]),
        ("finish s", 1, "small: # of # runs (# nominal) computed", vec![all - failed, all, 1.0]),
    ] {
        says(&scratch.prints(command, code), pattern, &known);
    }
    let shown = numbers(&scratch.prints("report r", 0), "r/report.html (# kB)")[0];
    assert!((shown - size / 1e3).abs() < 0.051, "{shown} kB of {size} bytes");
    scratch.prints("campaign c.toml --out t --shard 1/2", 0);
    let first: f64 = scratch.part_files("t").iter().map(rows).sum();
    let said = scratch.prints("campaign c.toml --out t --shard 2/2", 0);
    let second = scratch.part_files("t").iter().map(rows).sum::<f64>() - first;
    assert_eq!(numbers(&said, "is complete (# samples in # s)")[0], second, "{said}");
    assert!(first > 0.0 && second > 0.0 && first + second == all);
}
