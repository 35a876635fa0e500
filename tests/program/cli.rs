//! The program from outside: commands, files, exit codes.

use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use arrow_array::cast::AsArray;
use arrow_array::types::{Float64Type, UInt64Type};
use arrow_array::{Array, RecordBatch};
use parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder;

/// Six hundred samples are three parts.
const CAMPAIGN: &str = r#"
[campaign]
name = "small"
samples = 600
seed = 7
duration_s = 1.0
[integrator]
method = "auto"
tolerance = 1e-10
[observe]
points = 11
[fuselage]
wall_thickness_m = 0.03
outer_radius_m = 1.0
length_m = 3.0
density_kg_m3 = 2700.0
thruster_offset_m = 0.5
[wheel1]
radius_m = 0.25
length_m = 0.1
station_m = 1.0
density_kg_m3 = 2700.0
[wheel2]
radius_m = 0.25
length_m = 0.1
station_m = 2.0
density_kg_m3 = 2700.0
[debris]
side_m = 0.2
density_kg_m3 = 2700.0
[initial]
position_m = [0, 0, 0]
velocity_m_s = [10, 0, 0]
attitude = [1, 0, 0, 0]
angular_velocity_rad_s = [0, 3.141592653589793, 31.41592653589793]
wheel_angles_rad = [0, 0]
wheel_rates_rad_s = [314.1592653589793, 157.07963267948966]
debris_position_m = [0, 0, 0]
debris_velocity_m_s = [10, 0, 0]
debris_attitude = [1, 0, 0, 0]
debris_relative_angular_velocity_rad_s = [100, 0, 0]
[[disperse]]
parameter = "initial.angular_velocity_rad_s"
distribution = "normal"
std = [0.5, 0.5, 1.5]
"#;

/// A third of these wall thicknesses is negative.
const NEGATIVE_WALLS: &str = r#"
[[disperse]]
parameter = "fuselage.wall_thickness_m"
distribution = "uniform"
min = -0.02
max = 0.04
"#;

/// A folder of its own for each test, removed at its end.
struct ScratchFolder(PathBuf);

impl ScratchFolder {
    fn new(name: &str) -> Self {
        let folder = std::env::temp_dir().join(format!("spindrift-cli-{}-{name}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(folder.join("campaigns")).unwrap();
        let scratch = ScratchFolder(folder);
        scratch.file("small.toml", CAMPAIGN);
        scratch
    }

    fn file(&self, name: &str, text: &str) {
        fs::write(self.0.join(name), text).unwrap();
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    fn spindrift(&self, arguments: &str) -> Output {
        Command::new(env!("CARGO_BIN_EXE_spindrift"))
            .args(arguments.split_whitespace())
            .current_dir(&self.0)
            .output()
            .unwrap()
    }

    /// Runs the program and checks the exit code; returns both output streams.
    fn says(&self, arguments: &str, code: i32) -> String {
        let output = self.spindrift(arguments);
        let said = format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
        assert_eq!(output.status.code(), Some(code), "spindrift {arguments}:\n{said}");
        said
    }

    /// Names and contents of the files of rows.
    fn parts(&self, result: &str) -> Vec<(String, Vec<u8>)> {
        let mut parts: Vec<_> = fs::read_dir(self.path(result).join("runs"))
            .unwrap()
            .map(|entry| entry.unwrap())
            .map(|entry| (entry.file_name().into_string().unwrap(), fs::read(entry.path()).unwrap()))
            .collect();
        parts.sort();
        parts
    }
}

impl Drop for ScratchFolder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn batches(path: &Path) -> Vec<RecordBatch> {
    let reader = ParquetRecordBatchReaderBuilder::try_new(File::open(path).unwrap()).unwrap().with_batch_size(1 << 20);
    reader.build().unwrap().map(Result::unwrap).collect()
}

fn floats(batch: &RecordBatch, name: &str) -> Vec<f64> {
    let column = batch.column_by_name(name).unwrap_or_else(|| panic!("no column {name}"));
    column.as_primitive::<Float64Type>().values().to_vec()
}

#[test]
fn a_campaign_runs_once_and_then_says_so() {
    let scratch = ScratchFolder::new("once");
    let said = scratch.says("campaign small.toml", 0);
    assert!(said.contains("small: 600 samples") && said.contains("energy_error_max"), "{said}");
    let parts = scratch.parts("results/small");
    let names: Vec<&str> = parts.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, ["part-000000.parquet", "part-000001.parquet", "part-000002.parquet"]);
    let summary = fs::read_to_string(scratch.path("results/small/summary.json")).unwrap();
    assert!(summary.contains(r#""ok": 600"#), "{summary}");

    let said = scratch.says("campaign small.toml", 0);
    assert!(said.contains("already complete"), "{said}");
    assert_eq!(scratch.parts("results/small"), parts, "nothing was touched");

    // every sample once, in order
    let ids: Vec<u64> = (0..3)
        .flat_map(|part| batches(&scratch.path(&format!("results/small/runs/part-{part:06}.parquet"))))
        .flat_map(|batch| batch.column(0).as_primitive::<UInt64Type>().values().to_vec())
        .collect();
    assert_eq!(ids, (0..600).collect::<Vec<u64>>());
}

/// Law: the plan in a results folder gives the same result again.
#[test]
fn the_kept_plan_reproduces_the_result() {
    let scratch = ScratchFolder::new("plan");
    scratch.says("campaign small.toml --samples 300 --seed 11", 0);
    scratch.says("campaign results/small/plan.toml --out again", 0);
    assert_eq!(scratch.parts("results/small"), scratch.parts("again"));
}

#[test]
fn another_plan_never_replaces_a_result_without_being_told() {
    let scratch = ScratchFolder::new("overwrite");
    scratch.says("campaign small.toml --samples 300", 0);
    let before = scratch.parts("results/small");
    let said = scratch.says("campaign small.toml --samples 300 --seed 8", 4);
    assert!(said.contains("another plan") && said.contains("--overwrite"), "{said}");
    assert_eq!(scratch.parts("results/small"), before);
    scratch.says("campaign small.toml --samples 20 --seed 8 --overwrite", 0);
    assert_eq!(scratch.parts("results/small").len(), 1, "parts of the old result are gone");
    scratch.says("campaign small.toml --samples 20 --seed 8", 0);
}

/// Law: rows, files and summary are the same bytes for any number of threads; another seed gives others.
#[test]
fn threads_do_not_change_a_byte() {
    let scratch = ScratchFolder::new("threads");
    for threads in [1, 2, 5] {
        scratch.says(&format!("campaign small.toml --threads {threads} --out t{threads}"), 0);
        assert_eq!(scratch.parts("t1"), scratch.parts(&format!("t{threads}")));
        let summary = |threads| fs::read(scratch.path(&format!("t{threads}/summary.json"))).unwrap();
        assert_eq!(summary(1), summary(threads));
    }
    scratch.says("campaign small.toml --seed 8 --out other", 0);
    assert_ne!(scratch.parts("t1"), scratch.parts("other"));
}

/// Law: an interrupted campaign is recognised, whichever file it was writing, and is never taken for a result.
#[test]
fn leftovers_are_recognised() {
    let scratch = ScratchFolder::new("leftovers");
    scratch.says("campaign small.toml --out whole", 0);
    scratch.says("campaign small.toml --out half", 0);
    fs::remove_file(scratch.path("half/summary.json")).unwrap();
    fs::remove_file(scratch.path("half/runs/part-000001.parquet")).unwrap();
    scratch.file("half/runs/part-000002.parquet.tmp", "half a file");
    scratch.file("half/summary.json.tmp", "{");
    let said = scratch.says("campaign small.toml --seed 9 --out half", 4);
    assert!(said.contains("unfinished result of another plan"), "{said}");
    let said = scratch.says("campaign small.toml --out half", 0);
    assert!(said.contains("starting again"), "{said}");
    assert_eq!(scratch.parts("half"), scratch.parts("whole"));

    fs::remove_file(scratch.path("whole/runs/part-000001.parquet")).unwrap();
    let said = scratch.says("campaign small.toml --out whole", 4);
    assert!(said.contains("damaged") && said.contains("part-000001.parquet"), "{said}");
}

#[test]
fn what_is_not_a_result_is_left_alone() {
    let scratch = ScratchFolder::new("foreign");
    fs::create_dir(scratch.path("thesis")).unwrap();
    scratch.file("thesis/chapter1.tex", "precious");
    for flags in ["", "--overwrite"] {
        let said = scratch.says(&format!("campaign small.toml --out thesis {flags}"), 4);
        assert!(said.contains("not a result of spindrift"), "{said}");
    }
    scratch.file("thesis/summary.json", r#"{"of": "chapter 1"}"#);
    scratch.says("campaign small.toml --out thesis --overwrite", 4);
    assert_eq!(fs::read_dir(scratch.path("thesis")).unwrap().count(), 2);
    // a file where the folder should be
    scratch.says("campaign small.toml --out small.toml", 4);
}

/// Law: two processes never write to one folder.
#[test]
#[cfg(unix)]
fn a_folder_in_use_is_refused() {
    let scratch = ScratchFolder::new("busy");
    fs::create_dir(scratch.path("out")).unwrap();
    let held = File::open(scratch.path("out")).unwrap();
    held.lock().unwrap();
    let said = scratch.says("campaign small.toml --samples 3 --out out", 4);
    assert!(said.contains("another process"), "{said}");
    drop(held);
    scratch.says("campaign small.toml --samples 3 --out out", 0);
}

/// Law: a failed run is a row with its status and nulls for missing values; other rows do not change.
#[test]
fn failed_runs_are_rows() {
    let scratch = ScratchFolder::new("failed");
    scratch.file("thin.toml", &format!("{CAMPAIGN}{NEGATIVE_WALLS}"));
    scratch.says("campaign thin.toml --samples 100", 1);
    let batch = &batches(&scratch.path("results/small/runs/part-000000.parquet"))[0];
    let statuses: Vec<&str> = batch.column_by_name("status").unwrap().as_string::<i32>().iter().flatten().collect();
    let walls = floats(batch, "fuselage_wall_thickness_m");
    let errors = batch.column_by_name("energy_error_max").unwrap();
    assert_eq!(statuses.len(), 100);
    for row in 0..100 {
        let physical = walls[row] > 0.0;
        assert_eq!(statuses[row], if physical { "ok" } else { "invalid_sample" }, "row {row}, wall {}", walls[row]);
        assert_eq!(errors.is_null(row), !physical);
    }
    let invalid = statuses.iter().filter(|status| **status == "invalid_sample").count();
    assert!((10..60).contains(&invalid), "{invalid} of 100");
    let summary = fs::read_to_string(scratch.path("results/small/summary.json")).unwrap();
    assert!(summary.contains(&format!(r#""invalid_sample": {invalid}"#)), "{summary}");

    let row = statuses.iter().position(|status| *status == "invalid_sample").unwrap();
    let said = scratch.says(&format!("simulate thin.toml --sample {row}"), 2);
    assert!(said.contains("invalid_sample") && said.contains("fuselage.wall_thickness_m"), "{said}");

    scratch.file("short.toml", &CAMPAIGN.replace("tolerance = 1e-10", "tolerance = 1e-10\nmax_steps = 1"));
    scratch.says("campaign short.toml --samples 5 --out short", 1);
    let batch = &batches(&scratch.path("short/runs/part-000000.parquet"))[0];
    assert!(
        batch.column_by_name("status").unwrap().as_string::<i32>().iter().all(|status| status == Some("step_limit"))
    );
    assert_eq!(batch.column_by_name("energy_error_max").unwrap().null_count(), 5);
    scratch.says("simulate short.toml", 1);
}

/// Law: `simulate --sample K` shows the run behind row K, bit for bit.
#[test]
fn simulate_shows_the_run_behind_the_row() {
    let scratch = ScratchFolder::new("sample");
    scratch.says("campaign small.toml", 0);
    for sample in [0, 1, 255, 256, 599] {
        scratch.says(&format!("simulate small.toml --sample {sample} --out s.parquet"), 0);
        let run = &batches(&scratch.path("s.parquet"))[0];
        let part = &batches(&scratch.path(&format!("results/small/runs/part-{:06}.parquet", sample / 256)))[0];
        let row = sample % 256;
        assert_eq!(run.num_rows(), 11);
        for (of_run, of_row) in [
            ("omega_se_s_x_rad_s", "omega_se_s_x_final_rad_s"),
            ("omega_se_s_z_rad_s", "omega_se_s_z_final_rad_s"),
            ("q_es_w", "q_es_w_final"),
            ("alpha_dot_rad_s", "alpha_dot_final_rad_s"),
            ("energy_wheel1_j", "energy_wheel1_final_j"),
        ] {
            let (last, value) = (floats(run, of_run)[10], floats(part, of_row)[row]);
            assert_eq!(last.to_bits(), value.to_bits(), "sample {sample}, {of_run}: {last:?} and {value:?}");
        }
        let largest = floats(run, "energy_error").iter().fold(0.0, |largest: f64, error| largest.max(error.abs()));
        assert_eq!(largest, floats(part, "energy_error_max")[row]);
    }
    scratch.says("simulate small.toml --sample 600", 2);
}

#[test]
fn simulate_writes_the_promised_columns() {
    let scratch = ScratchFolder::new("columns");
    scratch.says("simulate small.toml --out s.csv", 0);
    let text = fs::read_to_string(scratch.path("s.csv")).unwrap();
    let expected = "time_s,r_po_e_x_m,r_po_e_y_m,r_po_e_z_m,v_po_e_x_m_s,v_po_e_y_m_s,v_po_e_z_m_s,q_es_w,q_es_x,q_es_y,q_es_z,\
        omega_se_s_x_rad_s,omega_se_s_y_rad_s,omega_se_s_z_rad_s,alpha_rad,beta_rad,alpha_dot_rad_s,beta_dot_rad_s,\
        r_gdo_e_x_m,r_gdo_e_y_m,r_gdo_e_z_m,v_gdo_e_x_m_s,v_gdo_e_y_m_s,v_gdo_e_z_m_s,q_ed_w,q_ed_x,q_ed_y,q_ed_z,\
        omega_de_d_x_rad_s,omega_de_d_y_rad_s,omega_de_d_z_rad_s,\
        energy_fuselage_j,energy_wheel1_j,energy_wheel2_j,energy_debris_j,energy_error,";
    assert!(text.starts_with(expected), "{}", text.lines().next().unwrap());
    assert_eq!(text.lines().count(), 12);

    // the same numbers in both formats: CSV loses no bit
    scratch.says("simulate small.toml --out s.parquet", 0);
    let batch = &batches(&scratch.path("s.parquet"))[0];
    let names: Vec<&str> = text.lines().next().unwrap().split(',').collect();
    for (point, line) in text.lines().skip(1).enumerate() {
        for (name, cell) in names.iter().zip(line.split(',')) {
            assert_eq!(cell.parse::<f64>().unwrap().to_bits(), floats(batch, name)[point].to_bits(), "{name}");
        }
    }
    // the point p starts where the file says, although the states are those of the centre of mass
    let start = |name: &str| floats(batch, name)[0];
    assert_eq!([start("r_po_e_x_m"), start("r_po_e_y_m"), start("r_po_e_z_m")], [0.0; 3]);
    assert_eq!([start("v_po_e_x_m_s"), start("v_po_e_y_m_s"), start("v_po_e_z_m_s")], [10.0, 0.0, 0.0]);
}

/// Law: the velocity of p is the derivative of its position (central differences, error h^2/6 times the third derivative).
#[test]
fn the_velocity_of_p_is_the_derivative_of_its_position() {
    let scratch = ScratchFolder::new("derivative");
    const STEP: f64 = 1e-4;
    scratch.says("simulate small.toml --times 0.4999,0.5,0.5001 --out s.parquet", 0);
    let batch = &batches(&scratch.path("s.parquet"))[0];
    for axis in ["x", "y", "z"] {
        let r = floats(batch, &format!("r_po_e_{axis}_m"));
        let v = floats(batch, &format!("v_po_e_{axis}_m_s"))[1];
        // the third derivative of a point 1.5 m off c that turns at 32 rad/s is below 5e4 m/s^3
        let bound = STEP * STEP / 6.0 * 5e4 + 1e-11;
        assert!(((r[2] - r[0]) / (2.0 * STEP) - v).abs() < bound, "{axis}: {r:?} {v}");
    }
}

#[test]
fn times_may_come_in_any_order_and_lie_beyond_the_duration() {
    let scratch = ScratchFolder::new("times");
    scratch.says("simulate small.toml --times 2.5,0.5,0.5,1 --out a.csv", 0);
    scratch.says("simulate small.toml --times 0.5,1,2.5 --out b.csv", 0);
    let text = fs::read_to_string(scratch.path("a.csv")).unwrap();
    assert_eq!(text, fs::read_to_string(scratch.path("b.csv")).unwrap());
    let times: Vec<&str> = text.lines().skip(1).map(|line| line.split(',').next().unwrap()).collect();
    assert_eq!(times, ["0.5", "1.0", "2.5"]);
    scratch.says("simulate small.toml --times 0 --out zero.csv", 0);
    assert_eq!(fs::read_to_string(scratch.path("zero.csv")).unwrap().lines().count(), 2);
    scratch.says("simulate small.toml --times=-1", 2);
    scratch.says("simulate small.toml --times 1,x", 2);
}

#[test]
fn plots_and_tables_are_made() {
    let scratch = ScratchFolder::new("plots");
    scratch.says("simulate small.toml --plot p.svg", 0);
    let svg = fs::read_to_string(scratch.path("p.svg")).unwrap();
    for title in
        ["small, nominal", "wheel 1", "debris", "Angular velocity", "quaternion", "Relative errors of the balances"]
    {
        assert!(svg.contains(title), "{title}");
    }
    scratch.says("simulate small.toml --plot p.png --times 0,0.1,0.2", 0);
    assert!(fs::read(scratch.path("p.png")).unwrap().starts_with(b"\x89PNG"));
    scratch.says("simulate small.toml --plot p.pdf", 2);
    scratch.says("simulate small.toml --out s.xlsx", 2);
    scratch.says("simulate small.toml --out no/such/folder/s.csv", 4);
    let said = scratch.says("simulate small.toml", 0);
    assert!(said.lines().all(|line| line.len() <= 132), "the table fits a terminal: {said}");
    assert!(said.contains("omega_x") && said.contains("q_es_w") && said.lines().count() >= 12, "{said}");
}

/// Law: `sample` gives the samples of the campaign, in both formats, and says which of them are invalid.
#[test]
fn sample_draws_the_rows_of_the_campaign() {
    let scratch = ScratchFolder::new("drawn");
    scratch.file("thin.toml", &format!("{CAMPAIGN}{NEGATIVE_WALLS}"));
    let said = scratch.says("sample thin.toml --out s.csv --plot s.svg", 0);
    for expected in ["of 599 draws", "fuselage.wall_thickness_m", "uniform, -0.02", "initial.angular_velocity_rad_s.z"]
    {
        assert!(said.contains(expected), "{expected} in:\n{said}");
    }
    scratch.says("sample thin.toml --out s.parquet --plot s.png", 0);
    let text = fs::read_to_string(scratch.path("s.csv")).unwrap();
    let names: Vec<&str> = text.lines().next().unwrap().split(',').collect();
    assert_eq!(names[..3], ["sample_id", "status", "initial_angular_velocity_x_rad_s"]);
    assert_eq!(text.lines().count(), 601);
    let parquet = &batches(&scratch.path("s.parquet"))[0];
    scratch.says("campaign thin.toml --out r", 1);
    let rows: Vec<RecordBatch> =
        (0..3).flat_map(|part| batches(&scratch.path(&format!("r/runs/part-{part:06}.parquet")))).collect();
    for name in &names[2..] {
        let run: Vec<u64> = rows.iter().flat_map(|batch| floats(batch, name)).map(f64::to_bits).collect();
        let drawn: Vec<u64> = floats(parquet, name).into_iter().map(f64::to_bits).collect();
        let column = names.iter().position(|other| other == name).unwrap();
        let written =
            text.lines().skip(1).map(|line| line.split(',').nth(column).unwrap().parse::<f64>().unwrap().to_bits());
        assert_eq!(drawn, run, "{name}");
        assert!(written.eq(run), "{name}");
    }
    let invalid = text.lines().filter(|line| line.contains(",invalid_sample,")).count();
    assert!((100..300).contains(&invalid), "a third is thinner than nothing: {invalid}");
    assert!(fs::read_to_string(scratch.path("s.svg")).unwrap().contains("Rank correlation"));
    assert!(fs::read(scratch.path("s.png")).unwrap().starts_with(b"\x89PNG"));
    scratch.says("sample thin.toml --out s.txt", 2);
    scratch.says("sample thin.toml --samples 0", 2);
}

#[test]
fn check_shows_what_would_run() {
    let scratch = ScratchFolder::new("check");
    scratch.file("no_debris.toml", &{
        let (start, rest) = CAMPAIGN.split_once("[debris]").unwrap();
        let (_, rest) = rest.split_once("[initial]").unwrap();
        let (state, rest) = rest.split_once("debris_position_m").unwrap();
        let (_, rest) = rest.split_once("[[disperse]]").unwrap();
        format!("{start}[initial]{state}[[disperse]]{rest}")
    });
    let said = scratch.says("check small.toml", 0);
    for expected in [
        "samples = 600",
        "1982.77159269751",
        "3054.59097014534",
        "J_xy = -integral of x y dm",
        "initial.angular_velocity_rad_s.x",
        "needed because of",
        "not computed: there is no actuation",
        "== Estimate",
    ] {
        assert!(said.contains(expected), "{expected} in:\n{said}");
    }
    let said = scratch.says("check no_debris.toml", 0);
    assert!(said.contains("not computed: there is no debris"), "{said}");
    assert!(!scratch.path("results").exists(), "check writes nothing");
}

#[test]
fn bad_input_ends_with_code_2_and_says_everything() {
    let scratch = ScratchFolder::new("bad");
    let bad = CAMPAIGN.replace("outer_radius_m = 1.0", "outer_radius_m = -1.0").replace("seed = 7", "sead = 7");
    scratch.file("bad.toml", &bad);
    for command in ["campaign", "check", "simulate"] {
        let said = scratch.says(&format!("{command} bad.toml"), 2);
        assert!(said.contains("bad.toml:5") && said.contains("sead") && said.contains("outer_radius_m"), "{said}");
        let said = scratch.says(&format!("{command} missing"), 2);
        assert!(said.contains("campaigns/missing.toml"), "{said}");
    }
    scratch.says("campaign small.toml --samples 0", 2);
    scratch.says("campaign small.toml --threads 0", 2);
    scratch.says("campaign small.toml --samples many", 2);
    scratch.says("", 2);
    assert!(!scratch.path("results").exists(), "nothing is written for bad input");
    assert!(scratch.says("--help", 0).contains("Exit codes"));
}

#[test]
fn a_bare_name_is_looked_up_among_the_campaigns() {
    let scratch = ScratchFolder::new("bare");
    scratch.file("campaigns/shipped.toml", CAMPAIGN);
    scratch.says("campaign shipped --samples 2", 0);
    scratch.says("campaign shipped.toml --samples 2", 0);
}

/// Law: the choice of instruction set changes no byte, and an impossible choice is bad input.
#[test]
fn instruction_sets_do_not_change_a_byte() {
    let scratch = ScratchFolder::new("isa");
    let run = |isa: &str| {
        let arguments = ["campaign", "small.toml", "--samples", "20", "--out", isa];
        let mut command = Command::new(env!("CARGO_BIN_EXE_spindrift"));
        command.args(arguments).env("SPINDRIFT_ISA", isa).current_dir(&scratch.0).output().unwrap().status.code()
    };
    for isa in spindrift::math::Isa::available() {
        assert_eq!(run(isa.name()), Some(0));
    }
    for isa in spindrift::math::Isa::available() {
        assert_eq!(scratch.parts(isa.name()), scratch.parts("plain"), "{}", isa.name());
    }
    assert_eq!(run("abacus"), Some(2));
}

/// Law: a reader that closes the pipe early is no error and no panic.
#[test]
#[cfg(unix)]
fn a_closed_pipe_is_no_panic() {
    let scratch = ScratchFolder::new("pipe");
    for arguments in [vec!["simulate", "small.toml"], vec!["check", "small.toml"], vec!["--help"]] {
        let mut child = Command::new(env!("CARGO_BIN_EXE_spindrift"))
            .args(&arguments)
            .current_dir(&scratch.0)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        drop(child.stdout.take());
        let output = child.wait_with_output().unwrap();
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(!said.contains("panicked"), "{arguments:?}: {said}");
        assert_eq!(output.status.code(), Some(0), "{arguments:?}: {said}");
    }
}
