//! `spindrift sample`, `check`, and what all commands share: bad input, a closed pipe.

use std::fs;
use std::process::{Command, Stdio};

use arrow_array::RecordBatch;

use super::small_campaign::{NEGATIVE_WALLS, campaign, campaign_without_debris, folder};
use crate::support::scratch_folder::{batches, floats};

/// Law: `sample` gives the samples of the campaign, in both formats, and says which of them are invalid.
#[test]
fn sample_draws_the_rows_of_the_campaign() {
    let scratch = folder("drawn");
    scratch.file("thin.toml", &(campaign() + NEGATIVE_WALLS));
    let said = scratch.prints("sample thin.toml --out s.csv --plot s.svg", 0);
    for expected in
        ["of 599 draws", "body.parts.fuselage.wall_thickness_m", "uniform, -0.02", "initial.angular_velocity_rad_s.z"]
    {
        assert!(said.contains(expected), "{expected} in:\n{said}");
    }
    scratch.prints("sample thin.toml --out s.parquet --plot s.png", 0);
    let text = fs::read_to_string(scratch.path("s.csv")).unwrap();
    let names: Vec<&str> = text.lines().next().unwrap().split(',').collect();
    assert_eq!(names[..3], ["sample_id", "status", "initial_angular_velocity_x_rad_s"]);
    assert_eq!(text.lines().count(), 601);
    let parquet = &batches(&scratch.path("s.parquet"))[0];
    scratch.prints("campaign thin.toml --out r", 1);
    let rows: Vec<RecordBatch> =
        (0..3).flat_map(|part| batches(&scratch.path(&format!("r/runs/part-{part:06}.parquet")))).collect();
    // the last columns are the mass properties of what was drawn
    assert_eq!(names[names.len() - 7..][..2], ["mass_kg", "center_of_mass_x_m"]);
    for name in &names[2..names.len() - 7] {
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
    let statuses: Vec<&str> = text.lines().skip(1).map(|line| line.split(',').nth(1).unwrap()).collect();
    let [mass, a, b, c] =
        ["mass_kg", "principal_moment_1_kg_m2", "principal_moment_2_kg_m2", "principal_moment_3_kg_m2"]
            .map(|column| floats(parquet, column));
    for row in 0..600 {
        assert_eq!(a[row].is_nan(), statuses[row] == "invalid_sample");
        let is_physical = a[row] <= b[row] && b[row] <= c[row] && c[row] <= a[row] + b[row] && mass[row] > 0.0;
        assert!(is_physical || a[row].is_nan(), "{row}");
    }
    // the nominal one is that of `check`
    let check = scratch.prints("check thin.toml", 0);
    assert!(check.contains(&format!("{:?} kg", mass[0])), "{check}");
    // one sample, in all digits, here and in `simulate`
    let sample = (1..600).find(|row| statuses[*row] != "invalid_sample").unwrap();
    let line = text.lines().nth(sample + 1).unwrap().split(',').nth(2).unwrap();
    for command in ["sample", "simulate"] {
        let said = scratch.prints(&format!("{command} thin.toml --sample {sample}"), 0);
        assert!(said.contains("initial.angular_velocity_rad_s.x") && said.contains(line), "{line} in:\n{said}");
    }
    assert!(scratch.prints(&format!("sample thin.toml --sample {sample}"), 0).contains("principal_moment_3_kg_m2"));
    scratch.prints("sample thin.toml --sample 600", 2);
    scratch.prints("sample thin.toml --out s.txt", 2);
    scratch.prints("sample thin.toml --samples 0", 2);
}

#[test]
fn check_shows_what_would_run() {
    let scratch = folder("check");
    scratch.file("no_debris.toml", &campaign_without_debris());
    let said = scratch.prints("check small.toml", 0);
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
    let said = scratch.prints("check no_debris.toml", 0);
    assert!(said.contains("not computed: there is no debris"), "{said}");
    assert!(!scratch.path("results").exists(), "check writes nothing");
}

#[test]
fn bad_input_ends_with_code_2_and_says_everything() {
    let scratch = folder("bad");
    let bad = campaign().replace("outer_radius_m = 1.0", "outer_radius_m = -1.0").replace("seed = 7", "sead = 7");
    scratch.file("bad.toml", &bad);
    for command in ["campaign", "check", "simulate"] {
        let said = scratch.prints(&format!("{command} bad.toml"), 2);
        assert!(said.contains("bad.toml:5") && said.contains("sead") && said.contains("outer_radius_m"), "{said}");
        let said = scratch.prints(&format!("{command} missing"), 2);
        assert!(said.contains("campaigns/missing.toml"), "{said}");
    }
    scratch.prints("campaign small.toml --samples 0", 2);
    scratch.prints("campaign small.toml --threads 0", 2);
    scratch.prints("campaign small.toml --samples many", 2);
    scratch.prints("", 2);
    assert!(!scratch.path("results").exists(), "nothing is written for bad input");
    assert!(scratch.prints("--help", 0).contains("Exit codes"));
}

/// Law: a reader that closes the pipe early is no error and no panic.
#[test]
#[cfg(unix)]
fn a_closed_pipe_is_no_panic() {
    let scratch = folder("pipe");
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
