//! The bytes of Rust in each crate and in the tests stay below the numbers in ARCHITECTURE.md.

use crate::prelude::*;

/// By how much a folder may be lighter than its number says, as a share: more, and the number is lowered.
const SLACK: f64 = 0.05;

#[derive(Debug, PartialEq)]
struct Row {
    folder: String,
    most_kb: f64,
}

fn rows(document: &str) -> Vec<Row> {
    let (_, rest) = document.split_once("\n## Weight\n").unwrap();
    let section = rest.split("\n## ").next().unwrap_or_default();
    let cells = section.lines().filter(|line| line.starts_with("| `")).map(|line| line.split('|').map(str::trim));
    cells
        .map(|mut cells| {
            let folder = cells.nth(1).unwrap().trim_matches('`').to_owned();
            let most_kb = cells.next().unwrap().replace(',', "").parse().unwrap();
            Row { folder, most_kb }
        })
        .collect()
}

fn bytes(folder: &Path) -> u64 {
    let entries = std::fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let paths = entries.map(|entry| entry.unwrap().path());
    paths
        .map(|path| match path.extension() {
            _ if path.is_dir() => bytes(&path),
            Some(extension) if extension == "rs" => path.metadata().unwrap().len(),
            _ => 0,
        })
        .sum()
}

fn complaint(row: &Row, bytes: u64) -> Option<String> {
    let kb = bytes as f64 / 1e3;
    let Row { folder, most_kb } = row;
    if kb > *most_kb {
        Some(format!(
            "{folder} has {kb:.0} kB, more than {most_kb}: make it lighter, or raise the number and give the reason"
        ))
    } else if kb < most_kb * (1.0 - SLACK) {
        Some(format!("{folder} has {kb:.0} kB, its number is {most_kb}: lower the number to {:.0}", kb.ceil()))
    } else {
        None
    }
}

#[test]
fn no_crate_grows_unseen() {
    let root = root();
    let rows = rows(&std::fs::read_to_string(root.join("ARCHITECTURE.md")).unwrap());
    let mut expected: Vec<PathBuf> = vec!["src".into(), "tests".into()];
    let crates = std::fs::read_dir(root.join("crates")).unwrap().map(|entry| entry.unwrap());
    expected.extend(crates.map(|entry| Path::new("crates").join(entry.file_name()).join("src")));
    expected.sort();
    let mut listed: Vec<PathBuf> = rows.iter().map(|row| row.folder.clone().into()).collect();
    listed.sort();
    assert_eq!(listed, expected, "the table lists each crate and the tests");
    let complaint_about = |row: &Row| complaint(row, bytes(&root.join(&row.folder)));
    let complaints: Vec<String> = rows.iter().filter_map(complaint_about).collect();
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
}

#[test]
fn numbers_bound_the_weight_on_both_sides() {
    let row = Row { folder: "src".to_owned(), most_kb: 1000.0 };
    let document = "\n## Weight\n\n| folder | kB |\n| --- | --- |\n| `src` | 1,000 |\n\n## Next\n| `x` | 1 |\n";
    assert_eq!(rows(document), [row]);
    let row = Row { folder: "src".to_owned(), most_kb: 1000.0 };
    for (bytes, fits) in [(1_000_000, true), (1_000_001, false), (951_000, true), (949_000, false)] {
        assert_eq!(complaint(&row, bytes).is_none(), fits, "{bytes}");
    }
}
