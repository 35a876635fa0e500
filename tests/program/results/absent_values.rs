//! What is no finite number is absent in every file of a result: null, never NaN.

use crate::prelude::*;

use arrow_schema::DataType;

fn tables(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let of = |path: PathBuf| if path.is_dir() { tables(&path) } else { vec![path] };
    let is_table = |path: &PathBuf| path.extension().is_some_and(|extension| extension == "parquet");
    entries.flat_map(of).filter(is_table).collect()
}

fn without_maximum(path: &Path) -> (Vec<String>, usize) {
    let (mut wrong, mut columns) = (Vec::new(), 0);
    for batch in batches(path) {
        for (field, column) in batch.schema().fields().iter().zip(batch.columns()) {
            if *field.data_type() != DataType::Float64 {
                continue;
            }
            columns += 1;
            let values: Vec<f64> = column.as_primitive::<Float64Type>().iter().flatten().collect();
            // engines order NaN above all numbers
            let max = values.iter().copied().max_by(f64::total_cmp).unwrap_or(0.0);
            let mean = values.iter().map(|value| value / values.len() as f64).sum::<f64>();
            if !(max.is_finite() && mean.is_finite()) {
                wrong.push(format!("{}: {}", path.display(), field.name()));
            }
        }
    }
    (wrong, columns)
}

/// Law: in every table of a campaign with failures maximum and mean of every column are finite.
#[test]
fn every_column_has_a_maximum_and_a_mean() {
    let scratch = folder("absent");
    let text = sized(40).replace("points = 11", "points = 5");
    let rest = "[retain]\ntrajectories = \"all\"\n[audit]\nfraction = 0.2\n";
    scratch.file("small.toml", &format!("{text}{NEGATIVE_WALLS}{rest}"));
    scratch.small("--out r", 1);
    scratch.prints("sample small.toml --out s.parquet", 0);
    let files = [tables(&scratch.path("r")), vec![scratch.path("s.parquet")]].concat();
    assert!(files.len() > 20, "{} files", files.len());
    let (mut wrong, mut columns) = (Vec::new(), 0);
    for file in &files {
        let (found, count) = without_maximum(file);
        wrong.extend(found);
        columns += count;
    }
    assert!(wrong.is_empty() && columns > 500, "{} of {columns} columns:\n{}", wrong.len(), wrong.join("\n"));
    let rows = scratch.table("r/runs/part-000000.parquet");
    let statuses = texts(&rows, "status");
    let frequency = rows.column_by_name("exchange_frequency_hz").unwrap();
    let ok: Vec<usize> = (0..rows.num_rows()).filter(|row| statuses.value(*row) == "ok").collect();
    assert!(ok.len() > 10 && ok.iter().all(|row| frequency.is_null(*row)));
    let mass = scratch.table("s.parquet");
    let mass = mass.column_by_name("mass_kg").unwrap();
    assert!(mass.null_count() > 5 && mass.null_count() < 40, "{}", mass.null_count());
    scratch.prints("sample small.toml --out s.csv", 0);
    let text = scratch.text("s.csv");
    let unphysical = text.lines().filter(|line| line.contains("invalid_sample")).collect::<Vec<_>>();
    assert!(unphysical.len() > 5 && unphysical.iter().all(|line| line.ends_with(",,,,,,,")), "{text}");
    assert!(!text.contains("NaN") && !text.contains("inf"), "{text}");
}

/// Law: sensitivities of an observable that some runs have no value of are of those that have one.
#[test]
fn sensitivities_are_of_the_runs_with_a_value() {
    let scratch = folder("absent-half");
    let half = "[[observable]]\nname = \"half\"\nexpression = \"sqrt(initial.angular_velocity_rad_s.x)\"\n";
    scratch.file("half.toml", &(campaign_without_debris() + half));
    scratch.prints("campaign half.toml --out r --no-report", 0);
    let drawn = column(&scratch.rows("r"), "initial_angular_velocity_x_rad_s").split_off(1);
    let count = drawn.iter().filter(|x| **x >= 0.0).count();
    let table = scratch.table("r/sensitivity.parquet");
    let (names, rows) = (texts(&table, "observable"), column(std::slice::from_ref(&table), "rows"));
    let of_half: Vec<usize> = (0..table.num_rows()).filter(|row| names.value(*row) == "half").collect();
    assert!(of_half.len() == 3 && (200..400).contains(&count), "{of_half:?}, {count}");
    of_half.iter().for_each(|row| assert_eq!(rows[*row], count as f64));
    assert!((floats(&table, "pearson")[of_half[0]] - 0.97).abs() < 0.015, "{:?}", floats(&table, "pearson"));
}
