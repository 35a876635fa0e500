//! The table of accuracy claims: [`hold`] fails where the measured number exceeds the bound, and where
//! `docs/accuracy.md` states another one. With `SPINDRIFT_WRITE_ACCURACY=1` it writes the row instead.

use super::prelude::*;
use std::sync::PoisonError;

pub const WRITE: &str = "SPINDRIFT_WRITE_ACCURACY";

/// Tests of one program run in parallel; the document is one file.
static DOCUMENT: Mutex<()> = Mutex::new(());

const HEAD: [&str; 2] = ["| regime | bound | measured | margin |", "| --- | --- | --- | --- |"];

pub fn path() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/accuracy.md")
}

/// Largest factor between the number of the document and a fresh one: two digits are printed, and tests use elementary
/// functions of the platform.
const FRESH: f64 = 1.1;

fn is_outdated(row: &str, measured: f64) -> bool {
    let stated: f64 = row.split('|').nth(3).and_then(|cell| cell.trim().parse().ok()).unwrap_or(f64::NAN);
    let (low, high) = (stated.min(measured), stated.max(measured));
    stated.is_nan() || high > FRESH * low
}

fn stated(regime: &str, bound: f64) -> String {
    format!("| {regime} | {bound:.1e} |")
}

pub fn hold(section: &str, regime: &str, bound: f64, measured: f64) {
    let row = format!("{} {measured:.1e} | {:.1} |", stated(regime, bound), bound / measured);
    println!("{section}: {row}");
    assert!(measured <= bound, "{regime}: {measured:e} > {bound:e}");
    let _guard = DOCUMENT.lock().unwrap_or_else(PoisonError::into_inner);
    let text = std::fs::read_to_string(path()).unwrap();
    let (begin, end) = (format!("<!-- claims: {section} -->\n"), format!("<!-- end of {section} -->"));
    let from = text.find(&begin).unwrap_or_else(|| panic!("docs/accuracy.md has no {begin}")) + begin.len();
    let to = from + text[from..].find(&end).unwrap_or_else(|| panic!("docs/accuracy.md has no {end}"));
    let is_row = |line: &&str| line.starts_with('|') && !HEAD.contains(line);
    let rows: Vec<&str> = text[from..to].lines().filter(is_row).collect();
    if std::env::var_os(WRITE).is_none() {
        let known = rows.iter().find(|known| known.starts_with(&stated(regime, bound)));
        let Some(known) = known else {
            panic!("docs/accuracy.md does not state \"{}\": {WRITE}=1 and this test write it", stated(regime, bound));
        };
        assert!(
            !is_outdated(known, measured),
            "docs/accuracy.md states \"{known}\", and {measured:e} is measured: {WRITE}=1 and this test write it"
        );
        return;
    }
    let key = format!("| {regime} |");
    let mut written: Vec<&str> =
        rows.iter().map(|old| if old.starts_with(&key) { row.as_str() } else { old }).collect();
    if !rows.iter().any(|old| old.starts_with(&key)) {
        written.push(&row);
    }
    let text = format!("{}\n{}\n{}\n\n{}", &text[..from], HEAD.join("\n"), written.join("\n"), &text[to..]);
    std::fs::write(path(), text).unwrap();
}
