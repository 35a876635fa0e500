//! `spindrift precision` from outside: errors follow tolerances and steps, times are times, files are whole.

use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::Command;

use arrow_array::RecordBatch;
use arrow_array::cast::AsArray;
use arrow_array::types::Float64Type;
use parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder;

/// A folder of its own for each test, removed at its end.
struct Room(PathBuf);

impl Room {
    fn new(name: &str) -> Self {
        let folder = std::env::temp_dir().join(format!("spindrift-precision-{}-{name}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).unwrap();
        Room(folder)
    }

    /// Runs `precision` on a shipped campaign, insists on the exit code; what was said, both streams.
    fn says(&self, campaign: &str, arguments: &str, code: i32) -> String {
        let output = Command::new(env!("CARGO_BIN_EXE_spindrift"))
            .arg("precision")
            .arg(Path::new(env!("CARGO_MANIFEST_DIR")).join("campaigns").join(campaign))
            .args(arguments.split_whitespace())
            .current_dir(&self.0)
            .output()
            .unwrap();
        let said = format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
        assert_eq!(output.status.code(), Some(code), "precision {campaign} {arguments}:\n{said}");
        said
    }

    fn table(&self, file: &str) -> RecordBatch {
        let file = File::open(self.0.join(file)).unwrap();
        ParquetRecordBatchReaderBuilder::try_new(file).unwrap().build().unwrap().next().unwrap().unwrap()
    }
}

impl Drop for Room {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn floats(batch: &RecordBatch, name: &str) -> Vec<Option<f64>> {
    let column = batch.column_by_name(name).unwrap_or_else(|| panic!("no column {name}"));
    column.as_primitive::<Float64Type>().iter().collect()
}

/// A tolerance 1e4 smaller, or a step four times smaller at order four, lessens the error at least so much.
const LESS: f64 = 0.01;

/// Law: every method that is asked for is measured at every setting, and smaller settings have smaller errors against the truth.
#[test]
fn errors_follow_the_settings() {
    let room = Room::new("settings");
    let arguments = "--samples 3 --methods auto,dop853,runge_kutta_4 --tolerances 1e-4,1e-6,1e-8 --repeats 1 --out p";
    let said = room.says("spin_sweep.toml", arguments, 0);
    assert!(said.contains("3 samples") && said.contains("us/run"), "{said}");
    let table = room.table("p/precision.parquet");
    let methods: Vec<&str> = table.column(0).as_string::<i32>().iter().flatten().collect();
    assert_eq!(methods[..4], ["auto", "auto", "auto", "dop853"]);
    assert_eq!(methods.len(), 9);
    for name in ["rate_error_max", "attitude_error_max_rad"] {
        let errors = floats(&table, name);
        for first in [0, 3, 6] {
            let (coarse, fine) = (errors[first].unwrap(), errors[first + 2].unwrap());
            assert!(fine < LESS * coarse, "{name} of {}: {coarse:e} {fine:e}", methods[first]);
        }
    }
    assert!(floats(&table, "cpu_s").iter().all(|cpu| cpu.is_some_and(|cpu| cpu > 0.0 && cpu < 10.0)));
    let (tolerances, steps) = (floats(&table, "tolerance"), floats(&table, "step_s"));
    assert_eq!((tolerances[3], steps[3]), (Some(1e-4), None));
    assert_eq!(tolerances[8], None);
    assert_eq!(steps[8].unwrap() * 4.0, steps[6].unwrap());
    assert!(fs::read_to_string(room.0.join("p/precision.svg")).unwrap().contains("Angular velocity"));
    assert!(fs::read(room.0.join("p/precision.png")).unwrap().starts_with(b"\x89PNG"));
}

/// Law: with thrust and motors the energy balance holds against the truth's motion too, and what takes too long is named.
#[test]
fn balances_are_measured_and_omissions_named() {
    let room = Room::new("limit");
    let arguments = "--samples 2 --methods taylor,reference --tolerances 1e-6,1e-12 --repeats 1 --limit-s 0.02 --out p";
    let said = room.says("burn.toml", arguments, 0);
    assert!(said.contains("skipped: reference") && said.contains("--limit-s"), "{said}");
    let table = room.table("p/precision.parquet");
    let energy = floats(&table, "energy_error_max");
    assert!(energy[1].unwrap() < 1e-11 && energy[0].unwrap() > energy[1].unwrap(), "{energy:?}");
    assert!(floats(&table, "rate_error_max")[1].unwrap() < 1e-11);
}

#[test]
fn wrong_arguments_end_with_code_2() {
    let room = Room::new("wrong");
    for (arguments, word) in [
        ("--methods euler", "gauss_legendre_6"),
        ("--tolerances 1e-20", "1e-16 to 0.1"),
        ("--samples 0", "0"),
        ("--limit-s -1", "-1"),
    ] {
        let said = room.says("spin_sweep.toml", arguments, 2);
        assert!(said.contains(word), "{arguments}: {said}");
    }
}
