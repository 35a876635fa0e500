//! `docs/accuracy.md`: every table is that of a test, every row holds, and nothing in it is without a measurement.

use crate::support::claims::path;

fn rows(text: &str) -> Vec<(&str, [f64; 3])> {
    text.lines()
        .filter(|line| line.starts_with("| ") && !line.starts_with("| regime") && !line.starts_with("| ---"))
        .map(|line| {
            let cells: Vec<&str> = line.trim_matches('|').split('|').map(str::trim).collect();
            assert_eq!(cells.len(), 4, "{line}");
            (cells[0], [1, 2, 3].map(|i| cells[i].parse().unwrap_or_else(|_| panic!("not a number: {}", cells[i]))))
        })
        .collect()
}

fn sections(text: &str) -> Vec<(&str, &str)> {
    let starts = text.match_indices("<!-- claims: ");
    starts
        .map(|(at, mark)| {
            let rest = &text[at + mark.len()..];
            let name = rest.split(" -->").next().unwrap_or_default();
            let end = rest.find(&format!("<!-- end of {name} -->")).unwrap_or_else(|| panic!("no end of {name}"));
            (name, &rest[..end])
        })
        .collect()
}

#[test]
fn every_table_is_that_of_a_test_and_holds() {
    let text = std::fs::read_to_string(path()).unwrap();
    let sections = sections(&text);
    assert!(sections.len() >= 6, "{} sections", sections.len());
    for (name, table) in sections {
        let test = format!("{}/tests/accuracy/{name}.rs", env!("CARGO_MANIFEST_DIR"));
        let source = std::fs::read_to_string(&test).unwrap_or_else(|error| panic!("{test}: {error}"));
        assert!(source.contains(&format!("const SECTION: &str = \"{name}\";")), "{test} does not write {name}");
        assert!(text.contains("--test accuracy"), "the command at the head does not run {name}");
        let rows = rows(table);
        assert!(!rows.is_empty(), "{name} has no rows");
        for (regime, [bound, measured, margin]) in rows {
            assert!(measured <= bound && margin >= 1.0, "{name}: {regime}: {measured:e} > {bound:e}");
        }
    }
}
