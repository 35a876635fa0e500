//! What the files of a result say, against a source of its own.

use crate::prelude::*;

use parquet::basic::{Compression, ZstdLevel};

use crate::{results::failed_again::limited, support::parquet_tables::schema};

fn run(folder: &ScratchFolder, text: &str, arguments: &str, code: i32) -> String {
    folder.file("own.toml", text);
    folder.prints(&format!("campaign own.toml {arguments}"), code)
}

#[test]
fn the_summary_is_that_of_the_files() {
    let folder = ScratchFolder::new("statistics");
    let said = run(&folder, &limited(40), "--samples 1500 --out r --verbose", 1);
    assert_says(&said, [" of 1500 runs (1 nominal) computed in "]);
    let (summary, rows) = (folder.summary("r"), folder.rows("r"));
    let ended = ended(&rows);
    let failed: Vec<u64> = ended.iter().filter(|(_, status)| status == "step_limit").map(|(id, _)| *id).collect();
    assert!(failed.len() > 20 && failed.len() < 750, "{} runs hit the limit", failed.len());
    assert_eq!(summary["statuses"]["step_limit"], failed.len());
    assert_eq!(summary["first_failed"]["step_limit"], Value::from(failed[..3].to_vec()));
    assert_says(&said, [&format!("--sample {}", failed[0])]);

    let table = folder.table("r/statistics.parquet");
    let names = texts(&table, "observable");
    let lines = summary["observables"].as_array().unwrap();
    assert!(lines.len() > 5);
    for line in lines {
        let row = names.iter().position(|name| name == line["name"].as_str()).unwrap();
        let of = |name: &str| Some(column(std::slice::from_ref(&table), name)[row]).filter(|value| !value.is_nan());
        assert_eq!(line["count"].as_f64(), of("count"), "{line}");
        let quantiles = line["quantiles"].as_array().unwrap();
        assert_eq!(quantiles.len(), 9, "{line}");
        for quantile in quantiles {
            let name = format!("p{}", 100.0 * quantile["p"].as_f64().unwrap()).replace('.', "_");
            assert_eq!(quantile["value"].as_f64(), of(&name), "{name} of {line}");
        }
        assert_eq!((line["min"].as_f64(), line["max"].as_f64()), (of("min"), of("max")), "{line}");
    }

    let errors = ["energy_error_max", "angular_momentum_error_max"].map(|name| column(&rows, name));
    let mut worst: Vec<(f64, u64)> = (1..1500)
        .filter(|row| ended[*row].1 == "ok")
        .map(|row| (errors[0][row].max(errors[1][row]), row as u64))
        .collect();
    worst.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    let listed = summary["worst_runs"]["conservation_error"].as_array().unwrap();
    let listed: Vec<(f64, u64)> =
        listed.iter().map(|run| (run["error"].as_f64().unwrap(), run["sample"].as_u64().unwrap())).collect();
    assert_eq!(listed, worst[..3]);
}

#[test]
fn files_say_what_they_contain() {
    let zstd = Compression::ZSTD(ZstdLevel::default());
    for (name, codec) in [("lz4", Compression::LZ4_RAW), ("zstd", zstd), ("none", Compression::UNCOMPRESSED)] {
        let folder = ScratchFolder::new(&format!("codec-{name}"));
        let text = format!("{}[output]\ncompression = \"{name}\"\n", limited(40));
        run(&folder, &text, "--out r", 1);
        let mut next = 0.0;
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
            let plan = planned(&text);
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
            let ids = column(&batches(file), "sample_id");
            assert_eq!(ids[0], next);
            assert_eq!(says("spindrift.samples"), ids.len().to_string());
            next += ids.len() as f64;
        }
        assert_eq!(next, 600.0);
    }
}
