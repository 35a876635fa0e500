//! `spindrift campaign` from outside: files, exit codes, what it never overwrites.

use crate::prelude::*;

#[test]
fn printed_commands_are_quoted() {
    let scratch = folder("quoted");
    scratch.file("it's small.toml", &campaign());
    let run = |options: &[&str]| {
        let all = [&["campaign", "it's small.toml", "--samples", "20", "--out"], options].concat();
        scratch.outputs(scratch.command("").args(all), 0)
    };
    let said = run(&["r out", "--threads", "1", "--verbose"]);
    let printed = said.lines().find_map(|line| Some(line.split_once("spindrift simulate ")?.1)).unwrap();
    assert!(printed.starts_with("'r out/plan.toml' --sample "), "{said}");
    let said = run(&["s out", "--shard", "1/1"]);
    assert!(said.contains("spindrift finish 's out'\n"), "{said}");
}

#[test]
fn a_campaign_runs_once_and_then_says_so() {
    let scratch = folder("once");
    let said = scratch.small("", 0);
    let is_said = said.contains("small: 600 runs (1 nominal) computed in ") && said.contains("maximum energy error");
    assert!(is_said, "{said}");
    let parts = scratch.parts("results/small");
    let names: Vec<&str> = parts.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, ["part-000000.parquet", "part-000001.parquet", "part-000002.parquet"]);
    assert_eq!(scratch.summary("results/small")["statuses"]["ok"], 600);

    scratch.small_shows("", 0, "already complete");
    assert_eq!(scratch.parts("results/small"), parts, "nothing was touched");

    let ids = column(&scratch.rows("results/small"), "sample_id");
    assert_eq!(ids, (0..600).map(f64::from).collect::<Vec<f64>>());
}

#[test]
fn the_kept_plan_reproduces_the_result() {
    let scratch = folder("plan");
    scratch.small("--samples 300 --seed 11", 0);
    scratch.prints("campaign results/small/plan.toml --out again", 0);
    assert_eq!(scratch.parts("results/small"), scratch.parts("again"));
}

#[test]
fn another_plan_never_replaces_a_result_without_being_told() {
    let scratch = folder("overwrite");
    scratch.small("--samples 300 --shard 1/2 --out half", 0);
    scratch.small_shows("--samples 300 --seed 9 --out half", 4, "unfinished result of another plan");
    scratch.small("--samples 300", 0);
    let before = scratch.parts("results/small");
    assert_says(scratch.small("--samples 300 --seed 8", 4), ["another plan", "--overwrite"]);
    assert_eq!(scratch.parts("results/small"), before);
    scratch.small("--samples 20 --seed 8 --overwrite", 0);
    assert_eq!(scratch.parts("results/small").len(), 1, "parts of the old result are gone");
    scratch.small("--samples 20 --seed 8", 0);
}

#[test]
fn what_is_not_a_result_is_left_alone() {
    let scratch = folder("foreign");
    fs::create_dir(scratch.path("thesis")).unwrap();
    scratch.file("thesis/chapter1.tex", "precious");
    for flags in ["", "--overwrite"] {
        scratch.small_shows(&format!("--out thesis {flags}"), 4, "not part of a result of spindrift");
    }
    scratch.file("thesis/summary.json", r#"{"of": "chapter 1"}"#);
    scratch.small("--out thesis --overwrite", 4);
    assert_eq!(fs::read_dir(scratch.path("thesis")).unwrap().count(), 2);
    scratch.file("notes", "precious");
    scratch.small("--out notes", 4);
    assert_eq!(scratch.text("notes"), "precious");
}

#[test]
#[cfg(unix)]
fn a_folder_in_use_is_refused() {
    let scratch = folder("busy");
    fs::create_dir(scratch.path("out")).unwrap();
    let held = File::open(scratch.path("out")).unwrap();
    held.lock().unwrap();
    scratch.small_shows("--samples 3 --out out", 4, "another process");
    drop(held);
    scratch.small("--samples 3 --out out", 0);
}

#[test]
fn instruction_sets_do_not_change_a_byte() {
    let scratch = folder("isa");
    let loops = NET_LAUNCH.replace("duration_s = 2400.0", "duration_s = 60.0");
    std::fs::write(scratch.path("loop.toml"), loops).unwrap();
    let run = |file: &str, isa: &str, code: i32| {
        let arguments = format!("campaign {file}.toml --samples 20 --out {file}-{isa}");
        scratch.outputs(scratch.command(&arguments).env("SPINDRIFT_ISA", isa), code)
    };
    for file in ["small", "loop"] {
        let code = if file == "loop" { 3 } else { 0 };
        for isa in spindrift::math::Isa::available() {
            run(file, isa.name(), code);
        }
        for isa in spindrift::math::Isa::available() {
            let [one, plain] = [isa.name(), "plain"].map(|isa| scratch.parts(&format!("{file}-{isa}")));
            assert_eq!(one, plain, "{file} on {}", isa.name());
        }
    }
    run("small", "abacus", 2);
}

/// Law: a build without object stores refuses an address, with the command that builds one that has them.
#[cfg(not(feature = "cloud"))]
#[test]
fn addresses_need_a_build_with_stores() {
    let scratch = folder("addresses");
    let before = scratch.0.read_dir().unwrap().count();
    for command in ["campaign small.toml --out", "campaign small.toml --only-failed-of", "finish", "report", "verify"] {
        let out = if command.contains("failed") { "--out r" } else { "" };
        let said = scratch.prints(&format!("{command} s3://bucket/x {out}"), 2);
        assert_says(&said, ["s3://bucket/x: this build", "--features cloud"]);
    }
    assert!(scratch.small("--out gs://bucket/x", 2).contains("gs://bucket/x: must be a folder"));
    assert_eq!(scratch.0.read_dir().unwrap().count(), before);
}
