//! `spindrift campaign` from outside: files, exit codes, what it never overwrites.

use std::fs::{self, File};
use std::process::Command;

use arrow_array::Array;
use arrow_array::cast::AsArray;
use arrow_array::types::Int64Type;

use super::small_campaign::{NEGATIVE_WALLS, campaign, folder};
use crate::support::scratch_folder::{batches, floats};

/// Law: a printed command is one that a shell takes, whatever the names of the folder and of the file.
#[test]
fn printed_commands_are_quoted() {
    let scratch = folder("quoted");
    scratch.file("it's small.toml", &campaign());
    let mut program = Command::new(env!("CARGO_BIN_EXE_spindrift"));
    program.args(["campaign", "it's small.toml", "--samples", "20", "--out", "r out", "--threads", "1"]);
    let said = scratch.outputs(&mut program, 0);
    let printed = said.lines().find_map(|line| Some(line.split_once("spindrift simulate ")?.1)).expect("a command");
    assert!(printed.starts_with("'r out/plan.toml' --sample "), "{said}");
    let mut program = Command::new(env!("CARGO_BIN_EXE_spindrift"));
    let shard = ["campaign", "it's small.toml", "--samples", "20", "--out", "s out", "--shard", "1/1"];
    let said = scratch.outputs(program.args(shard), 0);
    assert!(said.contains("spindrift finish 's out'\n"), "{said}");
}

#[test]
fn a_campaign_runs_once_and_then_says_so() {
    let scratch = folder("once");
    let said = scratch.prints("campaign small.toml", 0);
    assert!(said.contains("small: 600 samples") && said.contains("energy_error_max"), "{said}");
    let parts = scratch.parts("results/small");
    let names: Vec<&str> = parts.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, ["part-000000.parquet", "part-000001.parquet", "part-000002.parquet"]);
    let summary = fs::read_to_string(scratch.path("results/small/summary.json")).unwrap();
    assert!(summary.contains(r#""ok": 600"#), "{summary}");

    let said = scratch.prints("campaign small.toml", 0);
    assert!(said.contains("already complete"), "{said}");
    assert_eq!(scratch.parts("results/small"), parts, "nothing was touched");

    // every sample once, in order
    let ids: Vec<i64> = (0..3)
        .flat_map(|part| batches(&scratch.path(&format!("results/small/runs/part-{part:06}.parquet"))))
        .flat_map(|batch| batch.column(0).as_primitive::<Int64Type>().values().to_vec())
        .collect();
    assert_eq!(ids, (0..600).collect::<Vec<i64>>());
}

/// Law: the plan in a results folder gives the same result again.
#[test]
fn the_kept_plan_reproduces_the_result() {
    let scratch = folder("plan");
    scratch.prints("campaign small.toml --samples 300 --seed 11", 0);
    scratch.prints("campaign results/small/plan.toml --out again", 0);
    assert_eq!(scratch.parts("results/small"), scratch.parts("again"));
}

#[test]
fn another_plan_never_replaces_a_result_without_being_told() {
    let scratch = folder("overwrite");
    scratch.prints("campaign small.toml --samples 300", 0);
    let before = scratch.parts("results/small");
    let said = scratch.prints("campaign small.toml --samples 300 --seed 8", 4);
    assert!(said.contains("another plan") && said.contains("--overwrite"), "{said}");
    assert_eq!(scratch.parts("results/small"), before);
    scratch.prints("campaign small.toml --samples 20 --seed 8 --overwrite", 0);
    assert_eq!(scratch.parts("results/small").len(), 1, "parts of the old result are gone");
    scratch.prints("campaign small.toml --samples 20 --seed 8", 0);
}

/// Law: rows, files and summary are the same bytes for any number of threads; another seed gives others.
#[test]
fn threads_do_not_change_a_byte() {
    let scratch = folder("threads");
    for threads in [1, 2, 5] {
        scratch.prints(&format!("campaign small.toml --threads {threads} --out t{threads}"), 0);
        assert_eq!(scratch.parts("t1"), scratch.parts(&format!("t{threads}")));
        let summary = |threads| fs::read(scratch.path(&format!("t{threads}/summary.json"))).unwrap();
        assert_eq!(summary(1), summary(threads));
    }
    scratch.prints("campaign small.toml --seed 8 --out other", 0);
    assert_ne!(scratch.parts("t1"), scratch.parts("other"));
}

/// Law: an interrupted campaign is recognised, whichever file it was writing, and is never taken for a result.
#[test]
fn leftovers_are_recognised() {
    let scratch = folder("leftovers");
    scratch.prints("campaign small.toml --out whole", 0);
    scratch.prints("campaign small.toml --out half", 0);
    for file in ["_SUCCESS", "summary.json", "runs/part-000001.parquet"] {
        fs::remove_file(scratch.path("half").join(file)).unwrap();
    }
    scratch.file("half/runs/part-000002.parquet.tmp", "half a file");
    scratch.file("half/summary.json.tmp", "{");
    let said = scratch.prints("campaign small.toml --seed 9 --out half", 4);
    assert!(said.contains("unfinished result of another plan"), "{said}");
    let said = scratch.prints("campaign small.toml --out half", 0);
    assert!(said.contains("344 samples are there already, 256 to run"), "{said}");
    assert_eq!(scratch.parts("half"), scratch.parts("whole"));
    assert!(!scratch.path("half/summary.json.tmp").exists(), "no temporary file is left");

    let before = scratch.parts("whole");
    fs::remove_file(scratch.path("whole/runs/part-000001.parquet")).unwrap();
    let said = scratch.prints("campaign small.toml --out whole", 0);
    assert!(said.contains("damaged") && said.contains("part-000001.parquet"), "{said}");
    assert_eq!(scratch.parts("whole"), before);
}

#[test]
fn what_is_not_a_result_is_left_alone() {
    let scratch = folder("foreign");
    fs::create_dir(scratch.path("thesis")).unwrap();
    scratch.file("thesis/chapter1.tex", "precious");
    for flags in ["", "--overwrite"] {
        let said = scratch.prints(&format!("campaign small.toml --out thesis {flags}"), 4);
        assert!(said.contains("not part of a result of spindrift"), "{said}");
    }
    scratch.file("thesis/summary.json", r#"{"of": "chapter 1"}"#);
    scratch.prints("campaign small.toml --out thesis --overwrite", 4);
    assert_eq!(fs::read_dir(scratch.path("thesis")).unwrap().count(), 2);
    // a file where the folder should be
    scratch.file("notes", "precious");
    scratch.prints("campaign small.toml --out notes", 4);
    assert_eq!(fs::read_to_string(scratch.path("notes")).unwrap(), "precious");
}

/// Law: two processes never write to one folder.
#[test]
#[cfg(unix)]
fn a_folder_in_use_is_refused() {
    let scratch = folder("busy");
    fs::create_dir(scratch.path("out")).unwrap();
    let held = File::open(scratch.path("out")).unwrap();
    held.lock().unwrap();
    let said = scratch.prints("campaign small.toml --samples 3 --out out", 4);
    assert!(said.contains("another process"), "{said}");
    drop(held);
    scratch.prints("campaign small.toml --samples 3 --out out", 0);
}

/// Law: a failed run is a row with its status and nulls for missing values; other rows do not change.
#[test]
fn failed_runs_are_rows() {
    let scratch = folder("failed");
    scratch.file("thin.toml", &(campaign() + NEGATIVE_WALLS));
    scratch.prints("campaign thin.toml --samples 100", 1);
    let batch = &batches(&scratch.path("results/small/runs/part-000000.parquet"))[0];
    let statuses: Vec<&str> = batch.column_by_name("status").unwrap().as_string::<i32>().iter().flatten().collect();
    let walls = floats(batch, "body_parts_fuselage_wall_thickness_m");
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
    let said = scratch.prints(&format!("simulate thin.toml --sample {row}"), 2);
    assert!(said.contains("invalid_sample") && said.contains("body.parts.fuselage.wall_thickness_m"), "{said}");
    // and `sample` says the same reason
    let reason = said.lines().find(|line| line.starts_with("  ")).unwrap();
    let said = scratch.prints(&format!("sample thin.toml --sample {row}"), 0);
    assert!(said.contains(&format!("(its status would be invalid_sample):\n{reason}")), "{said}");

    scratch.file("short.toml", &campaign().replace("tolerance = 1e-10", "tolerance = 1e-10\nmax_steps = 1"));
    scratch.prints("campaign short.toml --samples 5 --out short", 1);
    let batch = &batches(&scratch.path("short/runs/part-000000.parquet"))[0];
    for (row, status) in batch.column_by_name("status").unwrap().as_string::<i32>().iter().enumerate() {
        assert_eq!(status, Some("step_limit"), "row {row}");
    }
    assert_eq!(batch.column_by_name("energy_error_max").unwrap().null_count(), 5);
    scratch.prints("simulate short.toml", 1);
}

#[test]
fn a_bare_name_is_looked_up_among_the_campaigns() {
    let scratch = folder("bare");
    scratch.file("campaigns/shipped.toml", &campaign());
    scratch.prints("campaign shipped --samples 2", 0);
    scratch.prints("campaign shipped.toml --samples 2", 0);
}

/// Law: the choice of instruction set changes no byte, and an impossible choice is bad input.
#[test]
fn instruction_sets_do_not_change_a_byte() {
    let scratch = folder("isa");
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
