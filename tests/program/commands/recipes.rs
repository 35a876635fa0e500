//! The Python recipes of `docs/results.md`, run as they stand there.
//!
//! `SPINDRIFT_PYTHON` names the interpreter (default: `python3`); a recipe without its packages is skipped.

use crate::prelude::*;

use spindrift::storage::bands_file;

const PYTHON: &str = "SPINDRIFT_PYTHON";

fn recipes() -> Vec<String> {
    let path = root().join("docs/results.md");
    let text = std::fs::read_to_string(path).unwrap();
    let section = text.split("\n## ").find(|section| section.starts_with("Recipes")).unwrap();
    let blocks = section.split("```python\n").skip(1);
    blocks.map(|block| block.split("```").next().unwrap_or_default().to_owned()).collect()
}

fn packages(block: &str) -> Vec<String> {
    let imports = block.lines().filter_map(|line| line.strip_prefix("import "));
    let names = imports.flat_map(|line| line.split(','));
    let package = |name: &str| name.trim().split([' ', '.']).next().unwrap_or_default().to_owned();
    names.map(package).collect()
}

fn after(printed: &str, word: &str) -> f64 {
    let mut words = printed.split_whitespace();
    words.find(|other| *other == word).unwrap_or_else(|| panic!("no {word} in:\n{printed}"));
    words.next().and_then(|number| number.parse().ok()).unwrap_or_else(|| panic!("no number after {word}:\n{printed}"))
}

#[test]
fn recipes_give_the_numbers_of_the_rows() {
    let scratch = ScratchFolder::new("recipes");
    scratch.says("campaign", "spin_sweep.toml", "--samples 300", 0);
    let reader = scratch.reader("results/spin_sweep");
    let mut errors = Vec::new();
    for part in (0..).map_while(|index| reader.part(index)) {
        let part = part.unwrap();
        let rows = part.statuses().unwrap().into_iter().zip(part.numbers("energy_error_max").unwrap());
        errors.extend(rows.filter(|(status, _)| *status == Status::Done).map(|(_, error)| error));
    }
    errors.sort_by(f64::total_cmp);

    let bands = bands_file::read(reader.store(), reader.bands(), None).unwrap().unwrap();
    let wheel = bands.find("exchange_w1_j").unwrap();
    let p95 = (0..bands.times().len()).filter_map(|point| bands.quantile(wheel, point, 0.95)).fold(0.0, f64::max);

    let python = std::env::var(PYTHON).unwrap_or_else(|_| "python3".to_owned());
    let recipes = recipes();
    assert_eq!(recipes.len(), 3, "polars, DuckDB, pandas");
    for recipe in recipes {
        assert!(recipe.lines().count() <= 10, "a recipe of ten lines:\n{recipe}");
        let packages = packages(&recipe);
        let check = format!("import {}", packages.join(", "));
        let is_there = Command::new(&python).args(["-c", &check]).output().is_ok_and(|output| output.status.success());
        if !is_there {
            println!("skipped: {python} does not have {}", packages.join(", "));
            continue;
        }
        let output = Command::new(&python).args(["-c", &recipe]).current_dir(&scratch.0).output().unwrap();
        let printed = String::from_utf8_lossy(&output.stdout);
        assert!(output.status.success(), "{recipe}\n{printed}\n{}", String::from_utf8_lossy(&output.stderr));
        assert_eq!(after(&printed, "runs"), errors.len() as f64, "{recipe}");
        assert_eq!(Some(after(&printed, "median")), quantile(&errors, 0.5), "{recipe}");
        assert_eq!(after(&printed, "p95"), p95, "{recipe}");
        println!("ran the recipe with {}", packages.join(", "));
    }
}

#[test]
fn the_summary_has_the_keys_of_its_document() {
    let scratch = ScratchFolder::new("summary-keys");
    scratch.says("campaign", "spin_sweep.toml", "--samples 300 --audit 0.02", 0);
    let written = std::fs::read_to_string(scratch.path("results/spin_sweep/summary.json")).unwrap();
    let summary: serde_json::Value = serde_json::from_str(&written).unwrap();
    let path = root().join("docs/results.md");
    let document = std::fs::read_to_string(path).unwrap();
    let section = document.split("\n### ").find(|section| section.starts_with("summary.json")).unwrap();
    let section = section.split("\n## ").next().unwrap_or_default();
    let cells = section.lines().filter_map(|line| line.strip_prefix("| `")?.split(" | ").next());
    let keys: Vec<&str> = cells.flat_map(|cell| cell.split(", ")).map(|key| key.trim_matches('`')).collect();
    assert!(keys.len() > 10 && keys.contains(&"missions"), "{keys:?}");
    let has = |key: &str| summary.pointer(&format!("/{}", key.replace('.', "/"))).is_some();
    let absent: Vec<&&str> = keys.iter().filter(|key| **key != "missions" && !has(key)).collect();
    assert!(absent.is_empty(), "{absent:?}");
    assert!(!has("requirements.verdicts") && !has("missions"), "it can fail");
}
