//! `simulate --out X.csv` writes the numbers of the run to the last bit.

use std::process::Command;

use crate::support::plans::shipped;
use spindrift::ensemble::SingleRun;
use spindrift::math::Isa;
use spindrift::sampling::SampleId;
use spindrift::storage::timeseries::TimeSeries;

/// Law: every decimal number in the file reads back as the f64 that the run holds: seventeen digits where they are needed.
#[test]
fn decimals_read_back_to_the_bit() {
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("csv_digits");
    std::fs::create_dir_all(&folder).expect("a folder for the test");
    let file = folder.join("run.csv");
    let ended = Command::new(env!("CARGO_BIN_EXE_spindrift"))
        .args(["simulate", "spin_sweep", "--sample", "7", "--out"])
        .arg(&file)
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .expect("the program runs");
    assert!(ended.status.success(), "{}", String::from_utf8_lossy(&ended.stderr));

    let plan = shipped("spin_sweep", None);
    let run = SingleRun::new(&plan, SampleId(7), plan.grid.clone(), Isa::best()).expect("a physical sample");
    let series = TimeSeries::new(&plan, SampleId(7), &run, |_| true);
    let text = std::fs::read_to_string(&file).expect("the file was written");
    let mut lines = text.lines();
    let names: Vec<&str> = lines.next().expect("a heading").split(',').collect();
    assert!(names.len() >= 25, "{names:?}");
    let rows: Vec<Vec<f64>> =
        lines.map(|line| line.split(',').map(|cell| cell.parse().expect("a number")).collect()).collect();
    assert_eq!(rows.len(), plan.grid.points());
    let mut long = 0;
    for (place, name) in names.iter().enumerate() {
        let column = series.columns().find(|(quantity, _)| quantity.name() == *name);
        let (_, column) = column.unwrap_or_else(|| panic!("no column {name}"));
        for (row, value) in rows.iter().zip(column) {
            assert_eq!(row[place].to_bits(), value.to_bits(), "{name}: {} for {value:?}", row[place]);
            // counter-test: sixteen digits are not enough
            let short: f64 = format!("{value:.15e}").parse().expect("a number");
            long += usize::from(short.to_bits() != value.to_bits());
        }
    }
    assert!(long > 100, "some numbers need all seventeen digits: {long}");
}
