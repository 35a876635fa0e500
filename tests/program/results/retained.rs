//! Retained runs: which they are follows from the rows, and their files are those of `simulate`.

use crate::prelude::*;

use spindrift::analysis::accumulator::of_files;
use spindrift::analysis::trajectories::{Retained, file_name};
use spindrift::storage::rows_reader::{RowsError, RowsReader};

use crate::small_campaign::table;

fn file(retain: &str) -> String {
    let few_steps = campaign().replace("tolerance = 1e-10", "tolerance = 1e-10\nmax_steps = 17");
    format!("{few_steps}{NEGATIVE_WALLS}\n[retain]\ntrajectories = \"{retain}\"\n")
}

fn plan(retain: &str) -> Plan {
    planned(&file(retain))
}

fn rows(scratch: &ScratchFolder) -> RowsReader {
    scratch.reader("r")
}

fn retained(plan: &Plan, rows: &RowsReader, threads: Option<NonZeroUsize>) -> Result<Vec<SampleId>, RowsError> {
    let retained = Retained::new(plan);
    Ok(retained.chosen(of_files(&retained, rows, threads)?))
}

#[test]
fn rules_choose_what_they_say() {
    let scratch = folder("retained");
    scratch.file("small.toml", &file("none"));
    scratch.small("--out r", 1);
    let reader = rows(&scratch);
    let table = scratch.rows("r");
    let all = ended(&table);
    let chosen = |retain: &str| -> Vec<u64> {
        let plan = plan(retain);
        let found = retained(&plan, &reader, None).unwrap();
        assert_eq!(found, retained(&plan, &reader, NonZeroUsize::new(1)).unwrap(), "{retain}");
        found.into_iter().map(|sample| sample.0).collect()
    };
    let those = |is_meant: &dyn Fn(&str) -> bool| -> Vec<u64> {
        all.iter().filter(|(_, status)| is_meant(status)).map(|(sample, _)| *sample).collect()
    };
    assert!(chosen("none").is_empty());
    assert_eq!(chosen("all"), those(&|status| status != "invalid_sample"));
    let failed = those(&|status| status == "step_limit");
    assert!(failed.len() > 3 && failed.len() < 300, "{} runs reach the limit", failed.len());
    assert_eq!(chosen("failed"), failed);
    for observable in ["energy_error_max", "energy_error_rate_per_s", "steps"] {
        let values = column(&table, observable).into_iter().zip(ended(&table));
        let with_value = values.filter(|(value, (sample, _))| *sample > 0 && !value.is_nan());
        let mut sizes: Vec<(f64, u64)> = with_value.map(|(value, (sample, _))| (value.abs(), sample)).collect();
        sizes.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        let mut worst: Vec<u64> = sizes[..20].iter().map(|(_, sample)| *sample).collect();
        worst.sort_unstable();
        assert_eq!(chosen(&format!("worst:20 by {observable}")), worst);
        assert_eq!(chosen(&format!("worst:100000 by {observable}")).len(), sizes.len());
    }
    let physical: BTreeSet<u64> = those(&|status| status != "invalid_sample").into_iter().collect();
    let some = chosen("sample:100");
    assert!(
        some.len() < 100 && some.len() > 40 && !some.contains(&0),
        "two thirds of 100 are physical: {}",
        some.len()
    );
    assert!(some.iter().all(|sample| physical.contains(sample)));
    assert!(some.iter().any(|sample| *sample > 400), "they are not the first");
    assert_eq!(chosen("sample:599").len(), physical.len() - 1);
}

#[test]
fn a_campaign_keeps_what_its_file_asks_for() {
    let scratch = folder("retain");
    let kept = |retain: &str, code: i32| -> BTreeSet<String> {
        scratch.file("small.toml", &file(retain));
        scratch.small("--out r", code);
        let entries = fs::read_dir(scratch.path("r/trajectories")).into_iter().flatten();
        entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect()
    };
    let expected = |retain: &str| -> BTreeSet<String> {
        retained(&plan(retain), &rows(&scratch), None).unwrap().into_iter().map(file_name).collect()
    };
    let worst = "worst:3 by energy_error_max";
    let found = kept(worst, 1);
    assert_eq!((found.len(), &found), (3, &expected(worst)));
    let rows = scratch.parts("r");
    for name in &found {
        let sample = name.trim_start_matches("sample-").trim_end_matches(".parquet");
        scratch.prints(&format!("simulate small.toml --sample {sample} --out s.parquet"), 0);
        let simulated = fs::read(scratch.path("s.parquet")).unwrap();
        assert!(fs::read(scratch.path("r/trajectories").join(name)).unwrap() == simulated, "{name}");
    }
    let other = kept("sample:4", 1);
    assert_eq!(other, expected("sample:4"));
    assert!(found != other && rows == scratch.parts("r"));
    assert!(kept("none", 1).is_empty());
}

#[test]
fn a_campaign_ends_with_bands() {
    let scratch = folder("bands");
    scratch.file("small.toml", &(campaign() + NEGATIVE_WALLS));
    let files = [1, 2].map(|threads| {
        scratch.small(&format!("--threads {threads} --out r{threads}"), 1);
        fs::read(scratch.path(&format!("r{threads}/bands.parquet"))).unwrap()
    });
    assert!(files[0] == files[1]);
    let bands = &scratch.table("r1/bands.parquet");
    assert_eq!(bands.num_rows(), 10 * 11, "ten quantities at the eleven points of the grid");
    let file = SerializedFileReader::new(fs::File::open(scratch.path("r1/bands.parquet")).unwrap()).unwrap();
    let metadata = file.metadata().file_metadata().key_value_metadata().unwrap();
    let error = metadata.iter().find(|pair| pair.key == "spindrift.bands.relative_error").unwrap();
    assert_eq!(error.value.as_deref(), Some("0.015625"));
    let ascending = ["min", "p01", "p05", "p25", "p50", "p75", "p95", "p99", "max"].map(|name| floats(bands, name));
    for row in 0..bands.num_rows() {
        let numbers = ascending.each_ref().map(|values| values[row]);
        assert!(numbers.is_sorted(), "row {row}: {numbers:?}");
    }
    let ended = ended(&scratch.rows("r1"));
    let ok = ended.iter().filter(|(sample, status)| *sample > 0 && status == "ok");
    let counts = bands.column_by_name("count").unwrap();
    let counts = counts.as_primitive::<Int64Type>().values();
    let ok = ok.count() as i64;
    assert!(ok < 599 && counts.iter().all(|count| *count == ok), "{ok} runs are ok: {counts:?}");
    scratch.file("small.toml", &(campaign() + "[bands]\npoints = 0\n"));
    scratch.small("--out none", 0);
    assert!(
        !scratch.path("none/bands.parquet").exists()
            && !scratch.path("none/bands").join("part-000000.parquet").exists()
    );
}

#[test]
fn failed_parts_change_no_band() {
    let scratch = folder("bands-failed-parts");
    let bands = |name: &str, parts: &[(bool, usize)]| {
        let mut spins = (0..).map(|index| 31.0 + 0.01 * f64::from(index));
        let fails = parts.iter().flat_map(|(fails, count)| std::iter::repeat_n(*fails, *count));
        let (rows, text) = table(fails.map(|fails| (fails, if fails { 31.0 } else { spins.next().unwrap() })));
        scratch.file("table.csv", &rows);
        scratch.file("table.toml", &text);
        let code = i32::from(parts.iter().any(|(fails, _)| *fails));
        scratch.prints(&format!("campaign table.toml --out {name} --no-report"), code);
        assert_eq!(scratch.rows(name)[0].num_rows(), 256);
        scratch.table(&format!("{name}/bands.parquet"))
    };
    let whole = bands("whole", &[(false, 300)]);
    for (name, parts) in [
        ("first", vec![(true, 255), (false, 256), (false, 44)]),
        ("middle", vec![(false, 255), (true, 256), (false, 45)]),
        ("last", vec![(false, 300), (true, 300)]),
    ] {
        assert!(bands(name, &parts) == whole, "{name}");
    }
}
