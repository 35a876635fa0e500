//! `spindrift slurm`: the scripts, run as Slurm runs them, with programs in the place of `sbatch` and `scontrol`. `.ci/cluster` does it
//! with the real ones.

#![cfg(unix)]

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use crate::reliability::interrupted::send;
use crate::small_campaign::{campaign, folder};
use crate::support::scratch_folder::ScratchFolder;

/// Where the programs are that stand for Slurm's.
const SLURM: &str = "slurm bin";
/// How long a task may take until it has done what is waited for.
const PATIENCE: Duration = Duration::from_secs(60);

/// Adds a program that writes its arguments to `<name>.log`, and says `answer`.
fn program(scratch: &ScratchFolder, name: &str, answer: &str) {
    let path = scratch.path(SLURM).join(name);
    fs::create_dir_all(scratch.path(SLURM)).unwrap();
    fs::write(
        &path,
        format!("#!/bin/sh\necho \"$@\" >>'{}'\n{answer}\n", scratch.path(&format!("{name}.log")).display()),
    )
    .unwrap();
    fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).unwrap();
}

fn path(scratch: &ScratchFolder) -> String {
    format!("{}:{}", scratch.path(SLURM).display(), std::env::var("PATH").unwrap_or_default())
}

/// Starts a script as a task of an array.
fn start(scratch: &ScratchFolder, script: &str, task: u32, restarts: u32) -> Child {
    let mut shell = Command::new("bash");
    shell.arg(script).current_dir(&scratch.0).env("PATH", path(scratch)).env_remove("SLURM_CPUS_PER_TASK");
    shell.env("SLURM_JOB_ID", (100 + task).to_string()).env("SLURM_ARRAY_TASK_ID", task.to_string());
    shell.env("SLURM_RESTART_COUNT", restarts.to_string()).stdout(Stdio::null()).stderr(Stdio::null());
    shell.spawn().unwrap()
}

fn ends(scratch: &ScratchFolder, script: &str, task: u32) -> Option<i32> {
    start(scratch, script, task, 0).wait().unwrap().code()
}

/// Waits until `what` is there.
fn wait_for<T>(mut what: impl FnMut() -> Option<T>) -> T {
    let begun = Instant::now();
    loop {
        if let Some(found) = what() {
            return found;
        }
        assert!(begun.elapsed() < PATIENCE, "it does not happen");
        std::thread::sleep(Duration::from_millis(5));
    }
}

/// The program that a script has started.
fn child_of(process: u32) -> Option<u32> {
    let text = fs::read_to_string(format!("/proc/{process}/task/{process}/children")).ok()?;
    text.split_whitespace().next()?.parse().ok()
}

/// Whether the shard has committed a part.
fn has_parts(scratch: &ScratchFolder, manifest: &str) -> Option<()> {
    fs::read_to_string(scratch.path(manifest)).is_ok_and(|text| text.contains("\"part\":")).then_some(())
}

/// Law: the tasks of the array and the last job make the result of one process; each task is asked to stop before its limit.
#[test]
fn the_scripts_make_the_campaign() {
    let scratch = folder("slurm");
    program(&scratch, "scontrol", "");
    scratch.prints("campaign small.toml --out whole", 0);
    let said =
        scratch.prints("slurm small.toml --nodes 5 --cpus 2 --time 1:00:00 --out sharded --sbatch=--partition=long", 0);
    assert!(said.contains("3 parts to make: 3 of 5 tasks busy"), "{said}");
    assert!(said.contains("sbatch --dependency=afterany:\"$job\" small-finish.sh"), "{said}");
    let array = scratch.text("small-array.sh");
    let own = ["--array=1-3", "--signal=B:USR1@60", "--requeue"];
    for line in
        [&own[..], &["--cpus-per-task=2", "--time=1:00:00", "--output=small-%a.log", "--partition=long"]].concat()
    {
        assert!(array.contains(&format!("#SBATCH {line}\n")), "{line} in:\n{array}");
    }
    let finish = scratch.text("small-finish.sh");
    assert!(finish.contains("#SBATCH --partition=long\n") && !own.iter().any(|line| finish.contains(line)), "{finish}");
    assert_eq!(ends(&scratch, "small-finish.sh", 1), Some(2), "nothing is there");
    // what is asked of the scripts is asked of the campaign
    scratch.prints("slurm small.toml --nodes 2 --cpus 1 --time 10 --samples 300 --seed 11 --out seeded", 0);
    let whole = "campaign small.toml --samples 300 --seed 11 --out seeded_whole";
    scratch.prints(whole, 0);
    for (script, task) in [("small-array.sh", 1), ("small-array.sh", 2), ("small-finish.sh", 1)] {
        assert_eq!(ends(&scratch, script, task), Some(0));
    }
    assert_eq!(scratch.parts("seeded"), scratch.parts("seeded_whole"));
    scratch.prints("slurm small.toml --nodes 5 --cpus 2 --time 1:00:00 --out sharded --sbatch=--partition=long", 0);
    for task in [3, 1] {
        assert_eq!(ends(&scratch, "small-array.sh", task), Some(0));
    }
    assert_eq!(ends(&scratch, "small-finish.sh", 1), Some(4), "a part is missing");
    for task in [2, 2] {
        assert_eq!(ends(&scratch, "small-array.sh", task), Some(0), "a shard that is complete ends with 0 too");
    }
    assert_eq!(ends(&scratch, "small-finish.sh", 1), Some(0));
    assert!(!scratch.path("scontrol.log").exists(), "no task was put back into the queue");
    assert_eq!(scratch.parts("sharded"), scratch.parts("whole"));
    for name in ["plan.toml", "manifest.jsonl", "summary.json", "report.html"] {
        let bytes = |folder: &str| fs::read(scratch.path(folder).join(name)).unwrap();
        assert!(bytes("sharded") == bytes("whole"), "{name}");
    }
}

/// Law: a task that is asked to stop, or killed, puts itself back into the queue; after some kills, or after another signal, it does not.
#[cfg(target_os = "linux")]
#[test]
fn a_task_that_was_stopped_is_put_back() {
    let scratch = folder("slurm-requeue");
    program(&scratch, "scontrol", "");
    let samples = 400_000; // some 100 parts: seconds, so that there is time to stop
    scratch.prints(&format!("slurm small.toml --nodes 2 --cpus 1 --time 10 --out it's --samples {samples}"), 0);
    let requeued = || fs::read_to_string(scratch.path("scontrol.log")).unwrap_or_default();
    let manifest = "it's/shards/1-of-2.jsonl";
    // USR1 to the shell, which passes it on
    let mut task = start(&scratch, "small-array.sh", 1, 0);
    wait_for(|| has_parts(&scratch, manifest));
    send("USR1", task.id());
    assert_eq!(task.wait().unwrap().code(), Some(138));
    assert_eq!(requeued(), "requeue 101\n");
    // SIGKILL and SIGTERM to the program
    for (name, restarts, code, expected) in [
        ("KILL", 2, 137, "requeue 101\nrequeue 101\n"),
        ("KILL", 3, 137, "requeue 101\nrequeue 101\n"),
        ("TERM", 0, 143, "requeue 101\nrequeue 101\n"),
    ] {
        let before = fs::metadata(scratch.path(manifest)).unwrap().len();
        let mut task = start(&scratch, "small-array.sh", 1, restarts);
        wait_for(|| (fs::metadata(scratch.path(manifest)).unwrap().len() > before).then_some(()));
        send(name, wait_for(|| child_of(task.id())));
        assert_eq!(task.wait().unwrap().code(), Some(code), "{name}");
        assert_eq!(requeued(), expected, "{name}, {restarts} restarts");
    }
}

/// Law: a task that needs longer than its time limit for a part is put back into the queue once, and then says what to do; one that has made a part is
/// put back again, however often it was before.
#[test]
fn a_task_that_makes_no_part_is_not_put_back_for_ever() {
    let scratch = folder("slurm-no-part");
    program(&scratch, "scontrol", "");
    scratch.prints("slurm small.toml --nodes 2 --cpus 1 --time 10 --out small", 0);
    let text = scratch.text("small-array.sh");
    // in the place of the program: one that is stopped before its limit, and has made a part where `grows` is there
    let manifest = scratch.path("small").join(spindrift::storage::names::manifest_of(1, 2));
    fs::create_dir_all(manifest.parent().unwrap()).unwrap();
    program(
        &scratch,
        "stopped",
        &format!("[ -e grows ] && echo '{{\"part\":0}}' >>'{}'\nexit 138", manifest.display()),
    );
    assert!(text.contains(env!("CARGO_BIN_EXE_spindrift")));
    scratch.file("task.sh", &text.replace(env!("CARGO_BIN_EXE_spindrift"), "stopped"));
    let ends = |restarts: u32| {
        let mut shell = Command::new("bash");
        shell.arg("task.sh").current_dir(&scratch.0).env("PATH", path(&scratch)).env("SLURM_JOB_ID", "101");
        shell.env("SLURM_ARRAY_TASK_ID", "1").env("SLURM_RESTART_COUNT", restarts.to_string());
        let output = shell.output().unwrap();
        assert_eq!(output.status.code(), Some(138));
        String::from_utf8(output.stderr).unwrap()
    };
    let requeued = || fs::read_to_string(scratch.path("scontrol.log")).unwrap_or_default().lines().count();
    for (restarts, grows, expected) in [(0, false, 1), (1, false, 1), (1, true, 2), (2, true, 3), (3, false, 3)] {
        let _ = fs::remove_file(scratch.path("grows"));
        if grows {
            scratch.file("grows", "");
        }
        let before = requeued();
        let said = ends(restarts);
        assert_eq!(requeued(), expected, "{restarts} restarts: {said}");
        let has_ended = said.contains("made no part between two time limits (10)") && said.contains("longer --time");
        assert_eq!(has_ended, requeued() == before, "{restarts} restarts: {said}");
    }
}

/// Law: `--submit` gives both scripts to sbatch, the second to start after the first; what sbatch refuses is said.
#[test]
fn submission() {
    let scratch = folder("slurm-submit");
    let run = |code: i32| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_spindrift"));
        command.args("slurm small.toml --nodes 2 --cpus 1 --time 10 --submit".split(' ')).current_dir(&scratch.0);
        let output = command.env("PATH", path(&scratch)).output().unwrap();
        let said = [output.stdout, output.stderr].map(|text| String::from_utf8(text).unwrap()).concat();
        assert_eq!(output.status.code(), Some(code), "{said}");
        said
    };
    program(&scratch, "sbatch", "echo '71;far'");
    let said = run(0);
    assert!(said.contains("array 71 of 2 tasks"), "{said}");
    let script = |name: &str| scratch.path(name).canonicalize().unwrap().display().to_string();
    let expected = format!(
        "--parsable {}\n--parsable --dependency=afterany:71 {}\n",
        script("small-array.sh"),
        script("small-finish.sh")
    );
    let asked = scratch.text("sbatch.log");
    assert_eq!(asked.replace(&scratch.0.display().to_string(), &script(".")), expected);
    program(&scratch, "sbatch", "echo 'invalid partition' >&2; exit 1");
    let said = run(4);
    assert!(said.contains("invalid partition"), "{said}");
    fs::remove_file(Path::new(&scratch.path(SLURM)).join("sbatch")).unwrap();
    let has_slurm = Command::new("sbatch").arg("--version").output().is_ok();
    assert!(has_slurm || run(4).contains("without --submit"));
}

/// Law: what cannot run is refused, and a file that is no script of this program is not replaced.
#[test]
fn refusals() {
    let scratch = folder("slurm-refusals");
    let all = "--nodes 2 --cpus 1 --time 10";
    for (arguments, code, said) in [
        ("slurm small.toml --nodes 0 --cpus 1 --time 10", 2, "1 to 1000000"),
        ("slurm small.toml --nodes 2 --cpus 0 --time 10", 2, "--cpus"),
        ("slurm small.toml --nodes 2 --cpus 1 --time 2h", 2, "2:00:00"),
        (&format!("slurm small.toml {all} --sbatch long"), 2, "--partition=long"),
        (&format!("slurm other.toml {all}"), 2, "there is no campaign file"),
    ] {
        let text = scratch.prints(arguments, code);
        assert!(text.contains(said), "{arguments}: {text}");
    }
    // a path is one word of the scripts, whatever it has
    for out in ["a\nrm -rf b", "a\u{1b}[31m"] {
        let mut command = Command::new(env!("CARGO_BIN_EXE_spindrift"));
        command.args(format!("slurm small.toml {all} --out").split(' ')).arg(out);
        let text = scratch.outputs(&mut command, 2);
        assert!(text.contains("must be a path in UTF-8 without line ends"), "{text}");
    }
    scratch.file("option.toml", &campaign().replace("name = \"small\"", "name = \"-rf\""));
    let text = scratch.prints(&format!("slurm option.toml {all}"), 2);
    assert!(text.contains("campaign.name = \"-rf\""), "{text}");
    let stop = "\n[stop]\nobservable = \"energy_error_max\"\nquantile = 0.5\nhalf_width = 1e-12\nmax_samples = 2400\n";
    scratch.file("stop.toml", &format!("{}{stop}", campaign()));
    let text = scratch.prints(&format!("slurm stop.toml {all}"), 2);
    assert!(text.contains("[stop]"), "{text}");
    scratch.file("small-finish.sh", "#!/bin/sh\nprecious\n");
    let text = scratch.prints(&format!("slurm small.toml {all}"), 4);
    assert!(text.contains("small-finish.sh: exists"), "{text}");
    assert_eq!(scratch.text("small-finish.sh"), "#!/bin/sh\nprecious\n");
}
