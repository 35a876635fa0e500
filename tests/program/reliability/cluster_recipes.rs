//! The commands of docs/cluster.md that a cluster runs with an index, with other paths of program and result.

use crate::prelude::*;

use crate::reliability::interrupted::send;

const DOCUMENT: &str = include_str!("../../../docs/cluster.md");
const SHARDS: usize = 8;

fn between(before: &str, after: &str) -> String {
    let mut found = DOCUMENT.split(before).skip(1);
    let (first, more) = (found.next().unwrap_or_else(|| panic!("no {before}")), found.next());
    assert!(more.is_none(), "{before} is there twice");
    first.split_once(after).unwrap_or_else(|| panic!("no {after} after {before}")).0.to_owned()
}

/// Law: the shell commands of Kubernetes and AWS Batch, over all indices, make the result of one process to the byte.
#[test]
fn indexed_jobs_make_the_bytes_of_one_process() {
    let recipes = [
        ("JOB_COMPLETION_INDEX", between("command: [sh, -c, '", "']")),
        ("AWS_BATCH_JOB_ARRAY_INDEX", between("{\"command\": [\"sh\", \"-c\", \"", "\"]}")),
    ];
    let scratch = folder("cluster-recipes");
    scratch.small("--samples 9000 --out one", 0);
    let one = contents(&scratch.path("one"));
    let parts = one.keys().filter(|name| name.starts_with("runs/part-")).count();
    assert!(parts >= SHARDS, "{parts} parts: a shard has none");
    for (variable, recipe) in recipes {
        let mut command = recipe;
        for (written, here) in [
            ("exec spindrift ", concat!("exec '", env!("CARGO_BIN_EXE_spindrift"), "' ")),
            (" spin_sweep.toml ", " small.toml --samples 9000 "),
            ("/data/spin_sweep", variable),
        ] {
            assert_eq!(command.matches(written).count(), 1, "{written:?} in {command}");
            command = command.replace(written, here);
        }
        for index in 0..SHARDS {
            let shell = Command::new("sh")
                .args(["-c", &command])
                .env(variable, index.to_string())
                .current_dir(scratch.path(""))
                .output()
                .unwrap();
            assert!(shell.status.success(), "{command}: {}", String::from_utf8_lossy(&shell.stderr));
        }
        scratch.prints(&format!("finish {variable}"), 0);
        assert!(contents(&scratch.path(variable)) == one, "{variable}");
    }
}

fn slurm_script(scratch: &ScratchFolder, samples: u64) -> String {
    let mut script =
        format!("scontrol() {{ echo \"$@\" >>scontrol.log; }}\n{}", between("```text\n#!/bin/bash\n", "```"));
    for (written, here) in [
        ("spindrift campaign", concat!("'", env!("CARGO_BIN_EXE_spindrift"), "' campaign")),
        (" spin_sweep.toml ", &format!(" small.toml --samples {samples} ")),
        ("/scratch/spin_sweep", "sharded"),
    ] {
        assert_eq!(script.matches(written).count(), 1, "{written:?} in {script}");
        script = script.replace(written, here);
    }
    scratch.file("array.sh", &script);
    script
}

fn slurm_task(scratch: &ScratchFolder, task: u32, restarts: u32) -> Child {
    let numbers = [("SLURM_ARRAY_TASK_ID", task), ("SLURM_ARRAY_TASK_COUNT", 2), ("SLURM_CPUS_PER_TASK", 1)];
    let mut shell = Command::new("bash");
    shell.arg("array.sh").current_dir(scratch.path("")).stdout(Stdio::null()).stderr(Stdio::null());
    shell.envs(numbers.map(|(name, number)| (name, number.to_string())));
    shell.env("SLURM_JOB_ID", "101").env("SLURM_RESTART_COUNT", restarts.to_string()).spawn().unwrap()
}

/// Law: the tasks of the array make the rows of one process, and a task that ends by itself is not requeued.
#[test]
fn the_slurm_array_makes_the_bytes_of_one_process() {
    let scratch = folder("slurm-recipe");
    assert_says(slurm_script(&scratch, 9000), ["--signal=B:USR1@60 --requeue"]);
    scratch.small("--samples 9000 --out one", 0);
    for task in [2, 1, 1] {
        assert_eq!(slurm_task(&scratch, task, 0).wait().unwrap().code(), Some(0), "task {task}");
    }
    scratch.prints("finish sharded", 0);
    assert!(contents(&scratch.path("sharded")) == contents(&scratch.path("one")));
    assert!(!scratch.path("scontrol.log").exists());
}

/// Law: a task signalled before its time limit, or killed, requeues itself at most ten times.
#[cfg(target_os = "linux")]
#[test]
fn a_slurm_task_that_was_stopped_is_put_back() {
    let scratch = folder("slurm-requeue");
    slurm_script(&scratch, 400_000); // seconds, so that there is time to stop
    let parts = || fs::read_dir(scratch.path("sharded/runs")).map_or(0, Iterator::count);
    let wait = |mut what: Box<dyn FnMut() -> bool + '_>| {
        let begun = Instant::now();
        while !what() {
            assert!(begun.elapsed() < Duration::from_secs(60), "it does not happen");
            std::thread::sleep(Duration::from_millis(5));
        }
    };
    let mut requeued = 0;
    for (signal, restarts, code, is_back) in
        [("USR1", 0, 138, true), ("KILL", 9, 137, true), ("KILL", 10, 137, false), ("TERM", 0, 143, false)]
    {
        let before = parts();
        let mut task = slurm_task(&scratch, 1, restarts);
        let children = format!("/proc/{0}/task/{0}/children", task.id());
        let program = || fs::read_to_string(&children).ok()?.split_whitespace().next()?.parse().ok();
        wait(Box::new(|| parts() > before && program().is_some()));
        send(signal, if signal == "USR1" { task.id() } else { program().unwrap() });
        assert_eq!(task.wait().unwrap().code(), Some(code), "{signal}");
        requeued += usize::from(is_back);
        let asked = fs::read_to_string(scratch.path("scontrol.log")).unwrap_or_default();
        assert_eq!(asked, "requeue 101\n".repeat(requeued), "{signal}, {restarts} restarts");
    }
}
