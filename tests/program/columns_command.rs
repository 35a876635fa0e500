//! `spindrift columns` from outside: names, units and meanings, of all campaigns and of one.

use spindrift::observables::{Group, table};

use super::small_campaign::folder;

/// Law: without a campaign every column of the table is there once, with unit and meaning, under its group; with a group, those alone.
#[test]
fn every_column_is_shown() {
    let scratch = folder("all-columns");
    let all = scratch.prints("columns", 0);
    let mut group = "";
    let mut shown = 0;
    for line in all.lines().filter(|line| !line.is_empty()) {
        match line.strip_prefix("  ") {
            None => group = line,
            Some(entry) => {
                let name = entry.split_whitespace().next().unwrap();
                let column = table::all().find(|column| column.quantity.name() == name).expect(name);
                assert_eq!(column.group.name(), group, "{name}");
                let is_explained = entry.contains(column.quantity.meaning()) && entry.contains(column.quantity.unit());
                assert!(is_explained, "{entry}");
                shown += 1;
            }
        }
    }
    assert_eq!(shown, table::all().count());
    let exchange = scratch.prints("columns exchange", 0);
    let of_group = table::all().filter(|column| column.group == Group::Exchange).count();
    assert_eq!(exchange.lines().count(), 1 + of_group);
    let refused = scratch.prints("columns exchang", 2);
    assert!(refused.contains("did you mean \"exchange\"?"), "{refused}");
}

/// Law: with a campaign the columns are those of its files of rows, in their order; a group that it does not observe is refused.
#[test]
fn the_columns_of_a_campaign_are_those_of_its_rows() {
    let scratch = folder("own-columns");
    scratch.prints("campaign small.toml --samples 10 --audit 1 --out r", 0);
    let rows = &scratch.table("r/runs/part-000000.parquet");
    let names: Vec<String> = rows.schema().fields().iter().map(|field| field.name().clone()).collect();
    let text = scratch.prints("columns --campaign small.toml", 0);
    let shown: Vec<&str> = text.lines().filter_map(|line| line.strip_prefix("  ")?.split_whitespace().next()).collect();
    let without_audits: Vec<&String> = names.iter().filter(|name| !name.starts_with("audit_")).collect();
    assert_eq!(shown, without_audits);
    let refused = scratch.prints("columns motion --campaign small.toml", 2);
    assert!(refused.contains("motion: the rows of this campaign have"), "{refused}");
    assert!(scratch.prints("columns exchange --campaign small.toml", 0).contains("exchange_w1_peak_to_peak_j"));
}
