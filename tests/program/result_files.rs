//! What the files of a result say: statistics, units, parts, compression, and the identity of the plan, each against a source of
//! its own.

use std::collections::BTreeMap;
use std::fs::{self, File};

use arrow_array::cast::AsArray;
use arrow_array::types::{Float64Type, Int64Type};
use arrow_array::{Array, RecordBatch};
use parquet::basic::{Compression, ZstdLevel};
use parquet::file::reader::{FileReader, SerializedFileReader};
use serde_json::Value;
use sha2::{Digest, Sha256};
use spindrift::campaign::{Overrides, Plan};
use spindrift::ensemble::Ensemble;
use spindrift::math::Isa;

use crate::support::campaigns::{FUSELAGE, SPACECRAFT_STATE, SPIN_DISPERSION, WHEEL1, WHEEL2};
use crate::support::parquet_tables::schema;
use crate::support::scratch_folder::{ScratchFolder, batches};

/// Spins differ from sample to sample, and some 7% of the runs need more steps than they may take.
const HEAD: &str = r#"
[campaign]
name = "limited"
samples = 1500
seed = 7
duration_s = 1.0
[integrator]
method = "dop853"
tolerance = 1e-9
max_steps = 40
[observe]
points = 11
"#;

/// The text of the campaign.
fn campaign() -> String {
    [HEAD, FUSELAGE, WHEEL1, WHEEL2, SPACECRAFT_STATE, SPIN_DISPERSION].concat()
}

fn run(folder: &ScratchFolder, text: &str, arguments: &str, code: i32) -> String {
    let file = folder.0.join("own.toml");
    fs::write(&file, text).unwrap();
    folder.says("campaign", file.to_str().unwrap(), arguments, code)
}

/// Number, status and the column `name` of every row; counts as numbers, null as `None`.
fn rows(batch: &RecordBatch, name: &str) -> Vec<(i64, String, Option<f64>)> {
    let ids = batch.column_by_name("sample_id").unwrap().as_primitive::<Int64Type>().clone();
    let statuses = batch.column_by_name("status").unwrap().as_string::<i32>().clone();
    let column = batch.column_by_name(name).unwrap();
    let value = |row: usize| match column.as_primitive_opt::<Float64Type>() {
        Some(values) => (!values.is_null(row)).then(|| values.value(row)),
        None => {
            let values = column.as_primitive::<Int64Type>();
            (!values.is_null(row)).then(|| values.value(row) as f64)
        }
    };
    (0..batch.num_rows()).map(|row| (ids.value(row), statuses.value(row).to_owned(), value(row))).collect()
}

/// Law: each quantile of the summary is that of the column in the files (type 7), over the dispersed samples that are ok; the worst runs and the first failed ones are those of the files.
#[test]
fn the_summary_is_that_of_the_files() {
    let folder = ScratchFolder::new("statistics");
    let said = run(&folder, &campaign(), "--out r", 1);
    assert!(said.contains("1499 dispersed + nominal"), "{said}");
    let summary: Value = serde_json::from_str(&fs::read_to_string(folder.0.join("r/summary.json")).unwrap()).unwrap();
    let tables: Vec<RecordBatch> = folder.part_files("r").iter().flat_map(|file| batches(file)).collect();
    let column =
        |name: &str| -> Vec<(i64, String, Option<f64>)> { tables.iter().flat_map(|t| rows(t, name)).collect() };

    let all = column("steps");
    let failed: Vec<i64> = all.iter().filter(|(_, status, _)| status == "step_limit").map(|(id, ..)| *id).collect();
    assert!(failed.len() > 20 && failed.len() < 750, "{} runs hit the limit", failed.len());
    assert_eq!(summary["statuses"]["step_limit"], failed.len());
    assert_eq!(summary["first_failed"]["step_limit"], Value::from(failed[..3].to_vec()));
    assert!(said.contains(&format!("--sample {}", failed[0])), "{said}");

    let lines = summary["observables"].as_array().unwrap();
    assert!(lines.len() > 5);
    for line in lines {
        let name = line["name"].as_str().unwrap();
        let counted = column(name).into_iter().filter(|(id, status, _)| *id > 0 && status == "ok");
        let mut values: Vec<f64> = counted.filter_map(|(.., value)| value).filter(|value| !value.is_nan()).collect();
        values.sort_by(f64::total_cmp);
        let count = values.len();
        assert_eq!(line["count"], count, "{name}");
        assert!(count > 700, "{name}: {count}");
        let quantiles = line["quantiles"].as_array().unwrap();
        assert_eq!(quantiles.len(), 9, "{name}");
        for quantile in quantiles {
            let p = quantile["p"].as_f64().unwrap();
            // type 7: linear between the order statistics at (n - 1) p, from the nearer end
            let place = (count - 1) as f64 * p;
            let (low, part) = (values[place as usize], place.fract());
            let high = values[(place as usize + 1).min(count - 1)];
            let exact = if part < 0.5 { low + part * (high - low) } else { high - (1.0 - part) * (high - low) };
            assert_eq!(quantile["value"].as_f64(), Some(exact), "{name} {p}");
        }
        assert_eq!(line["min"].as_f64(), values.first().copied(), "{name}");
        assert_eq!(line["max"].as_f64(), values.last().copied(), "{name}");
    }

    let errors = ["energy_error_max", "angular_momentum_error_max"].map(column);
    let mut worst: Vec<(f64, u64)> = (1..1500)
        .filter(|row| errors[0][*row].1 == "ok")
        .map(|row| (errors.iter().filter_map(|column| column[row].2).fold(0.0, f64::max), row as u64))
        .collect();
    worst.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    let listed = summary["worst_runs"]["conservation_error"].as_array().unwrap();
    let listed: Vec<(f64, u64)> =
        listed.iter().map(|run| (run["error"].as_f64().unwrap(), run["sample"].as_u64().unwrap())).collect();
    assert_eq!(listed, worst[..3]);
}

/// Law: every column of a file has the unit and the meaning of the table of columns; a part says which samples it has; the
/// codec is the plan's.
#[test]
fn files_say_what_they_contain() {
    let zstd = Compression::ZSTD(ZstdLevel::default());
    for (name, codec) in [("lz4", Compression::LZ4_RAW), ("zstd", zstd), ("none", Compression::UNCOMPRESSED)] {
        let folder = ScratchFolder::new(&format!("codec-{name}"));
        let text = format!("{}[output]\ncompression = \"{name}\"\n", campaign());
        run(&folder, &text, "--samples 600 --out r", 1);
        let mut next = 0;
        for (part, file) in folder.part_files("r").iter().enumerate() {
            let reader = SerializedFileReader::new(File::open(file).unwrap()).unwrap();
            let pairs = reader.metadata().file_metadata().key_value_metadata().cloned().unwrap_or_default();
            let pairs: BTreeMap<String, Option<String>> =
                pairs.into_iter().map(|pair| (pair.key, pair.value)).collect();
            let says = |key: &str| pairs.get(key).cloned().flatten().unwrap_or_default();
            assert_eq!(says("spindrift.part"), part.to_string());
            assert_eq!(says("spindrift.first_sample"), next.to_string());
            for column in reader.metadata().row_group(0).columns() {
                assert_eq!(column.compression(), codec, "{}", column.column_path());
            }
            let plan = Plan::from_text("r", &text, Overrides::default()).unwrap();
            assert_eq!((says("spindrift.row_plan"), says("spindrift.row_hash")), (plan.row_text(), plan.row_hash()));
            let digest = Sha256::digest(plan.text().as_bytes());
            assert_eq!(plan.hash(), digest.iter().map(|byte| format!("{byte:02x}")).collect::<String>());
            let ensemble = Ensemble::new(&plan, Isa::best());
            let columns = ensemble.request().columns();
            for field in schema(&reader).fields() {
                let written = |key: &str| field.metadata().get(key).cloned().unwrap_or_default();
                assert!(!written("meaning").is_empty(), "{}", field.name());
                if let Some(column) = columns.iter().find(|column| column.quantity.name() == field.name()) {
                    assert_eq!(
                        (written("unit"), written("meaning")),
                        (column.quantity.unit().to_owned(), column.quantity.meaning().to_owned())
                    );
                }
            }
            let table = &batches(file)[0];
            let ids = table.column_by_name("sample_id").unwrap().as_primitive::<Int64Type>();
            assert_eq!(ids.value(0), next);
            assert_eq!(says("spindrift.samples"), table.num_rows().to_string());
            next += table.num_rows() as i64;
        }
        assert_eq!(next, 600);
    }
}
