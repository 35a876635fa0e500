//! `campaign --only-failed-of`: the samples that failed, under another plan.

use crate::prelude::*;

use crate::small_campaign::table;

pub(crate) fn limited(max_steps: u64) -> String {
    let from = "method = \"auto\"\ntolerance = 1e-10";
    let to = format!("method = \"dop853\"\ntolerance = 1e-9\nmax_steps = {max_steps}");
    let text = campaign_without_debris();
    assert!(text.contains(from));
    text.replace(from, &to)
}

fn rows(scratch: &ScratchFolder, result: &str) -> BTreeMap<u64, (String, RecordBatch)> {
    let batches = scratch.rows(result);
    let rows = batches.iter().flat_map(|batch| (0..batch.num_rows()).map(|row| batch.slice(row, 1)));
    ended(&batches).into_iter().zip(rows).map(|((sample, status), row)| (sample, (status, row))).collect()
}

fn results(name: &str) -> ScratchFolder {
    let scratch = folder(name);
    scratch.file("tight.toml", &limited(40));
    scratch.file("enough.toml", &limited(10_000));
    scratch.prints("campaign tight.toml --samples 1500 --seed 9 --out tight", 1);
    scratch.prints("campaign enough.toml --samples 1500 --seed 9 --out all", 0);
    scratch
}

#[test]
fn failed_samples_run_under_another_plan() {
    let scratch = results("failed-again");
    let failed: Vec<u64> = rows(&scratch, "tight").iter().filter(|(_, row)| row.0 != "ok").map(|(id, _)| *id).collect();
    assert!((20..750).contains(&failed.len()), "{} failed", failed.len());
    scratch.shows(
        "campaign enough.toml --only-failed-of tight --out again",
        0,
        &format!("{} runs computed", failed.len()),
    );
    let (again, all) = (rows(&scratch, "again"), rows(&scratch, "all"));
    assert_eq!(again.keys().copied().collect::<Vec<_>>(), failed);
    for (sample, row) in &again {
        assert_eq!(row, &all[sample], "sample {sample}");
    }
    scratch.prints("verify again --fraction 1", 0);
    scratch.prints("finish again", 0);
    scratch.prints("report again", 0);
    scratch.prints(&format!("simulate again/plan.toml --sample {}", failed[1]), 0);
    scratch.prints("campaign enough.toml --only-failed-of tight --out again", 0);
    scratch.prints("campaign again/plan.toml --out again", 0);
    for shard in [2, 1] {
        scratch.prints(
            &format!("campaign enough.toml --only-failed-of tight --out shards --threads 3 --shard {shard}/2"),
            0,
        );
    }
    scratch.prints("finish shards", 0);
    assert!(contents(&scratch.path("shards")) == contents(&scratch.path("again")));
    fs::remove_file(scratch.path("shards/runs/part-000000.parquet")).unwrap();
    scratch.prints("verify shards --repair", 0);
    assert!(contents(&scratch.path("shards")) == contents(&scratch.path("again")));
    let require = "\n[[require]]\nobservable = \"energy_error_max\"\nfraction = 0.5\nat_most = 1e-30\n";
    scratch.file("required.toml", &(limited(10_000) + require));
    scratch.prints("campaign required.toml --samples 1500 --seed 9 --out required", 3);
    scratch.shows("campaign required.toml --only-failed-of tight --out chosen", 5, "campaign.only");
}

#[test]
fn the_same_plan_fails_the_same_way() {
    let scratch = results("failed-same");
    scratch.prints("campaign tight.toml --only-failed-of tight --out same", 1);
    let (same, before) = (rows(&scratch, "same"), rows(&scratch, "tight"));
    assert!(same.iter().all(|(sample, row)| row.0 != "ok" && row == &before[sample]));
    scratch.file("tighter.toml", &limited(38));
    scratch.prints("campaign tighter.toml --samples 1500 --seed 9 --out tighter", 1);
    scratch.shows("campaign tight.toml --only-failed-of tighter --out same", 4, "campaign.only");
    let said = scratch.prints("campaign enough.toml --only-failed-of all --out none", 0);
    assert!(said.contains("no run failed") && !scratch.path("none").exists(), "{said}");
    for (arguments, code) in [
        ("--only-failed-of tight", 2),
        ("--only-failed-of tight --out x --seed 3", 2),
        ("--only-failed-of nothing --out x", 2),
    ] {
        scratch.prints(&format!("campaign enough.toml {arguments}"), code);
    }
    let damaged = scratch.path("tight/runs/part-000001.parquet");
    fs::write(&damaged, b"x").unwrap();
    scratch.shows("campaign enough.toml --only-failed-of tight --out x", 4, "part-000001");
}

/// Law: with `--fail-fast` no part starts after a run that failed; without it the campaign continues.
#[test]
fn the_first_failure_ends_the_campaign() {
    let scratch = results("fail-fast");
    let first = *rows(&scratch, "tight").iter().find(|(_, row)| row.0 != "ok").unwrap().0;
    let command = "campaign tight.toml --samples 1500 --seed 9 --out r --threads 1";
    for _ in 0..2 {
        let said = scratch.prints(&format!("{command} --fail-fast"), 1);
        assert!(said.contains(&format!("sample {first} failed (step_limit: ")), "{said}");
        assert_says(&said, [&format!("spindrift simulate r/plan.toml --sample {first}")]);
        assert_eq!(scratch.part_files("r").len(), 1, "the first part has a run that failed");
        assert!(!scratch.path("r/_SUCCESS").exists());
    }
    scratch.prints("simulate r/plan.toml --sample 0", 0);
    scratch.prints(&format!("simulate r/plan.toml --sample {first}"), 1);
    scratch.prints(command, 1);
    assert!(contents(&scratch.path("r")) == contents(&scratch.path("tight")));
    scratch.prints("campaign enough.toml --samples 1500 --seed 9 --out whole --fail-fast", 0);
    assert!(contents(&scratch.path("whole")) == contents(&scratch.path("all")));
}

#[test]
fn every_failure_is_run_again() {
    let scratch = folder("failed-all");
    let mut seen = BTreeSet::new();
    for text in [limited(40) + NEGATIVE_WALLS, mixed_failures()] {
        scratch.file("mixed.toml", &text);
        scratch.prints("campaign mixed.toml --samples 300 --out r --overwrite --no-report", 1);
        scratch.prints("campaign mixed.toml --only-failed-of r --out again --overwrite --no-report", 1);
        let mut failed = ended(&scratch.rows("r"));
        assert!(failed.iter().any(|(_, status)| status == "ok"));
        failed.retain(|(_, status)| status != "ok");
        assert_eq!(ended(&scratch.rows("again")), failed);
        seen.extend(failed.into_iter().map(|(_, status)| status));
    }
    let seen: Vec<&str> = seen.iter().map(String::as_str).collect();
    assert_eq!(seen, ["inaccurate", "invalid_sample", "step_limit"]);
}

/// Law: of several parts at the same time `--fail-fast` names the first run that failed, each time.
#[test]
fn the_first_failure_is_that_of_the_first_sample() {
    let scratch = folder("fail-fast-threads");
    let samples = (1..=1000).map(|sample| ([200, 300, 600].contains(&sample), if sample < 256 { 400.0 } else { 31.0 }));
    let (rows, text) = table(samples);
    scratch.file("table.csv", &rows);
    scratch.file("table.toml", &text);
    for _ in 0..2 {
        let said = scratch.prints("campaign table.toml --threads 2 --fail-fast --out r", 1);
        let failed = ended(&scratch.rows("r")).into_iter().filter(|(_, status)| status != "ok");
        let failed: Vec<u64> = failed.map(|(sample, _)| sample).collect();
        assert!(failed.len() > 1 && failed[0] == 200, "both threads had a part: {failed:?}");
        assert_says(&said, ["simulate r/plan.toml --sample 200\n"]);
    }
}

/// Law: every command that a campaign prints for a run gives the run of that row.
#[test]
fn printed_commands_give_the_rows() {
    let scratch = folder("printed");
    let few = |max_steps: u64| limited(max_steps).replace("samples = 600", "samples = 20");
    scratch.file("tight.toml", &few(40));
    scratch.file("small.toml", &few(10_000));
    scratch.prints("campaign tight.toml --samples 400 --seed 9 --out tight", 1);
    let axes = ["x", "y", "z"];
    for options in
        ["", "--samples 300", "--seed 11", "--samples 300 --seed 11", "--audit 0.1", "--only-failed-of tight"]
    {
        let said = scratch.small(&format!("{options} --out r --overwrite --no-report --verbose"), 0);
        let rows = scratch.rows("r");
        let samples: Vec<u64> = ended(&rows).into_iter().map(|(sample, _)| sample).collect();
        let drawn = axes.map(|axis| column(&rows, &format!("initial_angular_velocity_{axis}_rad_s")));
        let printed: BTreeSet<&str> =
            said.lines().filter_map(|line| Some(line.split_once("spindrift simulate ")?.1)).collect();
        assert!(!printed.is_empty(), "{options}: {said}");
        for command in printed {
            let run = scratch.prints(&format!("simulate {command}"), 0);
            let sample: u64 = command.split_whitespace().last().unwrap().parse().unwrap();
            let row = samples.iter().position(|known| *known == sample).unwrap();
            for (axis, drawn) in axes.iter().zip(&drawn) {
                let line =
                    run.lines().find(|line| line.starts_with(&format!("initial.angular_velocity_rad_s.{axis} ")));
                let value = line.and_then(|line| line.split_whitespace().nth(1)).map(|value| value.parse());
                let value: f64 = value.unwrap().unwrap();
                assert!((value - drawn[row]).abs() <= 5e-6 * drawn[row].abs(), "{options}: {command}: {value}");
            }
        }
    }
}
