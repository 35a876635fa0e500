//! `spindrift columns` from outside: names, units and meanings, of all campaigns and of one.

use crate::prelude::*;
use spindrift::control::outcome::columns::OutcomeColumns;
use spindrift::observables::table;

#[test]
fn every_column_is_shown() {
    let scratch = folder("all-columns");
    let wide = |arguments: &str| scratch.prints_wide(arguments, 0);
    let both = wide("columns --verbose");
    let (all, of_loops) = both.split_once("\ncontrol loop\n").unwrap();
    assert_eq!(of_loops.lines().count(), OutcomeColumns::of_all_loops().len());
    let (mut group, mut shown) = ("", 0);
    for line in all.lines().filter(|line| !line.is_empty()) {
        let Some(entry) = line.strip_prefix("  ") else {
            group = line;
            continue;
        };
        let name = entry.split_whitespace().next().unwrap();
        let column = table::all().find(|column| column.quantity.name() == name).expect(name);
        assert_eq!(column.group.name(), group, "{name}");
        assert_says(entry, [column.quantity.meaning(), column.quantity.unit()]);
        shown += 1;
    }
    assert_eq!(shown, table::all().count());
    let exchange = wide("columns exchange");
    let of_group = table::all().filter(|column| column.group == Group::Exchange).count();
    assert_eq!(exchange.lines().count(), 1 + of_group);
    assert_says(scratch.prints("columns exchagne", 2), ["did you mean exchange?"]);
    let word = wide("columns TILTS");
    let has = |text: &str| text.to_lowercase().contains("tilts");
    let meant = table::all().map(|column| column.quantity.clone());
    let meant = meant.filter(|one| has(one.name()) || has(one.unit()) || has(one.meaning())).count();
    assert!(meant > 2 && word.lines().filter(|line| line.starts_with("  ")).count() == meant, "{word}");
}

#[test]
fn groups_are_listed_with_their_columns() {
    let scratch = folder("groups");
    for of in ["", " --campaign small.toml"] {
        let said = scratch.prints_at(&format!("columns{of}"), 0, 80);
        assert_fits(&said, 24, 80);
        let all = scratch.prints_wide(&format!("columns --verbose{of}"), 0);
        let mut titles = Vec::new();
        let mut counts = Vec::new();
        for line in all.lines().filter(|line| !line.is_empty()) {
            if line.starts_with("  ") {
                *counts.last_mut().unwrap() += 1;
            } else {
                titles.push(line);
                counts.push(0);
            }
        }
        for (title, count) in titles.iter().zip(&counts) {
            let line = said.lines().find(|line| line.trim_start().starts_with(&format!("{title}  "))).expect(title);
            let about = line.trim_start().strip_prefix(title).unwrap().trim_start();
            assert!(about.starts_with(&format!("{count}  ")) && about.len() > 10, "{line}");
        }
        let sum = format!("{} columns in all", counts.iter().sum::<usize>());
        assert!(titles.len() > 8 && said.contains(&sum), "{said}");
        for command in said.lines().filter_map(|line| line.trim_start().strip_prefix("spindrift ")) {
            let (command, _) = command.split_once("  ").unwrap_or((command, ""));
            if of.is_empty() || !command.contains("pointing") {
                assert!(scratch.prints(command, 0).lines().count() > 3, "{command}");
            }
        }
    }
}

#[test]
fn a_new_file_runs() {
    let scratch = ScratchFolder::new("new-file");
    scratch.prints("new mine.toml", 0);
    let text = scratch.text("mine.toml");
    assert_says(&text, ["name = \"mine\""]);
    scratch.shows("campaign mine.toml --out r", 0, "PASS");
    scratch.prints("new mine.toml", 4);
    assert_eq!(scratch.text("mine.toml"), text);
    assert_says(scratch.prints("campaign mine.toml --out r --junit v.xml", 0), ["PASS", "r/report.html"]);
    let verdicts = scratch.text("v.xml");
    assert!(verdicts.contains("testcase") && !verdicts.contains("<failure"), "{verdicts}");
    std::fs::remove_file(scratch.path("v.xml")).unwrap();
    scratch.prints("finish r --junit v.xml", 0);
    assert_eq!(scratch.text("v.xml"), verdicts);
}

#[test]
fn the_columns_of_a_campaign_are_those_of_its_rows() {
    let scratch = folder("own-columns");
    scratch.small("--samples 10 --audit 1 --out r", 0);
    let rows = &scratch.table("r/runs/part-000000.parquet");
    let names: Vec<String> = rows.schema().fields().iter().map(|field| field.name().clone()).collect();
    let text = scratch.prints_wide("columns --campaign small.toml --verbose", 0);
    let shown: Vec<&str> = text.lines().filter_map(|line| line.strip_prefix("  ")?.split_whitespace().next()).collect();
    let without_audits: Vec<&String> = names.iter().filter(|name| !name.starts_with("audit_")).collect();
    assert_eq!(shown, without_audits);
    assert_says(scratch.prints("columns motion --campaign small.toml", 2), ["motion: must be a group"]);
    assert!(scratch.prints("columns exchange --campaign small.toml", 0).contains("exchange_w1_peak_to_peak_j"));
}

#[test]
fn columns_of_loops_are_found() {
    let scratch = ScratchFolder::new("loop-columns");
    let said = scratch.prints_at("columns pointing", 0, 80);
    assert_fits(&said, usize::MAX, 80);
    let words = said.split_whitespace().collect::<Vec<_>>().join(" ");
    for (name, need) in [
        ("pointing_error_final_rad", "(needs a phase with a target)"),
        ("pointing_error_launch_rad", "(needs debris, and a phase with next = \"launch\")"),
    ] {
        let (_, after) = words.split_once(name).expect(name);
        assert!(after[..after.find(')').unwrap() + 1].ends_with(need), "{name}: {said}");
    }
    let known = OutcomeColumns::of_all_loops();
    let mut seen = std::collections::BTreeSet::new();
    for name in ["net_launch", "slew_closed", "detumble", "no_debris", "detumble_magnetic"] {
        let file = format!("{}/campaigns/{name}.toml", env!("CARGO_MANIFEST_DIR"));
        let plan = Plan::load(file.as_ref(), Overrides::default()).unwrap();
        let Some(spec) = plan.law.as_ref().and_then(|law| law.spec()) else { continue };
        let names =
            |list: &[spindrift::scene::Name]| list.iter().map(|name| name.as_str().to_owned()).collect::<Vec<_>>();
        let phases = spec.phases.iter().map(|phase| phase.name.as_str().to_owned()).collect();
        let places =
            [("<phase>", phases), ("<wheel>", names(&spec.wheel_names)), ("<thruster>", names(&spec.thruster_names))];
        let mut expected = std::collections::BTreeSet::new();
        for (quantity, _) in &known {
            let place = places.iter().find(|(place, _)| quantity.name().contains(place));
            match place {
                None => drop(expected.insert((quantity.name().to_owned(), quantity.name()))),
                Some((place, names)) => {
                    expected.extend(names.iter().map(|name| (quantity.name().replace(place, name), quantity.name())));
                }
            }
        }
        let columns = OutcomeColumns::of(spec).columns();
        for column in columns.list.iter() {
            let found = expected.iter().find(|(own, _)| own == column.quantity.name());
            seen.insert(found.unwrap_or_else(|| panic!("{name}: {}", column.quantity.name())).1.to_owned());
        }
        for (quantity, need) in known.iter().filter(|(_, need)| need.is_empty()) {
            let is_there =
                quantity.name().contains('<') || columns.list.iter().any(|one| one.quantity.name() == quantity.name());
            assert!(is_there, "{name}: {} needs {need:?}", quantity.name());
        }
    }
    let of_modules = known.iter().filter(|(quantity, _)| quantity.name().contains("<telemetry>")).count();
    assert_eq!(seen.len() + of_modules, known.len(), "net_launch has all of them but those of rods: {seen:?}");
}
