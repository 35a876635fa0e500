//! Campaigns that are killed, stopped, divided, damaged or extended have the bytes of one uninterrupted process.

use crate::prelude::*;

use crate::reliability::failing_store::whole_parts;

const KILLS: u32 = 100;
/// Samples of the campaign that is killed: about 0.1 s.
const SAMPLES: u64 = 5_000;
/// Latest kill after the start, ms.
const LATEST_MS: u64 = 90;
/// Kills after which a campaign may end: on a slow machine its last step alone takes longer than [`LATEST_MS`].
const OF_ONE: u32 = 12;

pub fn assert_same(scratch: &ScratchFolder, one: &str, other: &str) {
    let (one, other) = (contents(&scratch.path(one)), contents(&scratch.path(other)));
    assert_eq!(one.keys().collect::<Vec<_>>(), other.keys().collect::<Vec<_>>());
    for (name, bytes) in &one {
        assert!(*bytes == other[name], "{name} differs");
    }
}

pub fn start(scratch: &ScratchFolder, arguments: &str) -> Child {
    scratch.command(arguments).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap()
}

/// `kills` times in all, at instants that follow from `seed`; no part is lost.
fn kill_and_continue(kills: u32, seed: u64) {
    let scratch = folder(&format!("kill-{seed}"));
    let command = format!("campaign small.toml --samples {SAMPLES} --no-report");
    scratch.prints(&format!("{command} --out whole"), 0);
    let (mut killed, mut completed, mut state) = (0, 0, seed);
    while killed < kills || completed == 0 {
        let mut before = 0;
        for _ in 0..OF_ONE {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let mut child = start(&scratch, &format!("{command} --out half"));
            std::thread::sleep(Duration::from_millis((state >> 33) % LATEST_MS));
            let has_ended = child.try_wait().unwrap().is_some();
            child.kill().unwrap();
            let ended = child.wait().unwrap();
            if has_ended || ended.success() {
                assert!(ended.success(), "{ended}");
                break;
            }
            killed += 1;
            let now = whole_parts(&scratch.path("half"));
            assert!(now >= before, "{now} parts after {before}");
            before = now;
        }
        scratch.prints(&format!("{command} --out half"), 0);
        assert_same(&scratch, "half", "whole");
        fs::remove_dir_all(scratch.path("half")).unwrap();
        completed += 1;
    }
}

#[test]
fn a_killed_campaign_continues_to_the_same_bytes() {
    kill_and_continue(KILLS, 1);
}

#[test]
#[ignore = "minutes: cargo test --release --test program -- --ignored a_thousand_kills"]
fn a_thousand_kills() {
    kill_and_continue(10 * KILLS, 2);
}

/// Law: more samples keep the rows and add parts; the result is that of a campaign of as many samples.
#[test]
fn a_finished_campaign_is_extended() {
    let scratch = folder("extend");
    scratch.small("--samples 900 --out grown", 0);
    let before = scratch.parts("grown");
    scratch.small_shows("--samples 2000 --out grown", 0, "768 samples already there, 1232 to run");
    assert_eq!(scratch.parts("grown")[..3], before[..3], "whole parts stay");
    scratch.small("--samples 2000 --out whole", 0);
    assert_same(&scratch, "grown", "whole");
    scratch.shows("verify grown --fraction 1", 0, "files made of plan and rows again and compared: sound");
    scratch.small_shows("--samples 100 --out grown", 4, "2000 rows");
}

/// Law: a change that leaves the rows alone changes no part; verdicts and names are made again without a run.
#[test]
fn other_questions_of_the_same_rows_run_nothing() {
    let scratch = folder("questions");
    scratch.small("--out r", 0);
    let before = scratch.parts("r");
    let require = "\n[[require]]\nobservable = \"energy_error_max\"\nquantile = 0.9\nat_most = 1e-30\n";
    scratch.file("strict.toml", &format!("{}{require}", campaign().replace("\"small\"", "\"strict\"")));
    assert_says(scratch.prints("campaign strict.toml --out r", 3), ["600 samples already there, 0 to run", "FAIL"]);
    assert_eq!(scratch.parts("r"), before);
    assert!(scratch.text("r/plan.toml").contains("strict"));
    scratch.prints("campaign strict.toml --out r", 3);
}

/// Law: a manifest with a damaged line, or none, is reported once, and the result is made whole.
#[test]
fn a_damaged_manifest_is_recovered() {
    let scratch = folder("manifest");
    scratch.small("--out whole", 0);
    scratch.small("--out r", 0);
    let text = scratch.text("whole/manifest.json");
    let lines = text.lines().count();
    for line in 0..=lines {
        let mut changed: Vec<String> = text.lines().map(str::to_owned).collect();
        match changed.get_mut(line) {
            Some(line) => *line += " ",
            None => changed.clear(),
        }
        scratch.file("r/manifest.json", &format!("{}\n", changed.join("\n")));
        if line == lines {
            fs::remove_file(scratch.path("r/manifest.json")).unwrap();
        }
        let said = scratch.small("--out r", 0);
        assert_eq!(said.matches("manifest.json:").count(), 1, "{said}");
        assert_same(&scratch, "r", "whole");
    }
}

/// Law: parts beyond the samples of the command are not given up, but for what a killed process has left of a part.
#[test]
fn fewer_samples_than_before() {
    let scratch = folder("fewer");
    scratch.small("--out whole", 0);
    let without = |result: &str, part: u32| {
        fs::remove_file(scratch.path(&format!("{result}/runs/part-{part:06}.parquet"))).unwrap();
    };
    let longer = |result: &str| scratch.small(&format!("--samples 1100 --shard 1/1 --out {result}"), 0);
    longer("r");
    [1, 2, 4].into_iter().for_each(|part| without("r", part));
    scratch.small_shows("--out r", 4, "1024 rows of this plan, more than its 600 samples");
    without("r", 3);
    scratch.small("--out r", 0);
    assert_same(&scratch, "r", "whole");
}

/// Law: `--overwrite` keeps the old result until the new one is complete.
#[test]
fn the_old_result_stays_until_the_new_one_is_complete() {
    let scratch = folder("replace");
    scratch.small("--out r", 0);
    scratch.small("--out whole --seed 9", 0);
    let old = contents(&scratch.path("r"));
    let mut child = start(&scratch, &format!("campaign small.toml --seed 9 --overwrite --out r --samples {SAMPLES}"));
    let staged = |entry: fs::DirEntry| {
        let name = entry.file_name().into_string().unwrap();
        name.starts_with('.') && fs::read_dir(entry.path().join("runs")).is_ok_and(|mut parts| parts.next().is_some())
    };
    while !fs::read_dir(&scratch.0).unwrap().any(|entry| staged(entry.unwrap())) {
        assert!(child.try_wait().unwrap().is_none(), "ended before its first part was seen");
        std::thread::sleep(Duration::from_millis(1));
    }
    child.kill().unwrap();
    if !child.wait().unwrap().success() {
        assert!(contents(&scratch.path("r")) == old, "the old result is as it was");
    }
    scratch.small("--seed 9 --overwrite --out r", 0);
    assert_same(&scratch, "r", "whole");
    let beside = fs::read_dir(&scratch.0).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
    assert_eq!(beside.filter(|name| name.starts_with('.')).collect::<Vec<_>>(), [""; 0]);
}

/// Sends a signal by the shell's own command: the program `kill` is not on every machine.
#[cfg(unix)]
pub fn send(signal: &str, process: u32) {
    let command = format!("kill -s {signal} {process}");
    assert!(Command::new("sh").args(["-c", &command]).status().unwrap().success());
}

/// True if this process ignores a signal.
#[cfg(unix)]
pub fn is_ignored(signal: i32) -> bool {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.is_some_and(|mask| u64::from_str_radix(mask.trim(), 16).unwrap() >> (signal - 1) & 1 == 1)
}

/// Law: a signal ends a campaign with its code and keeps its parts, and the same command continues.
#[cfg(unix)]
#[test]
fn signals_stop_and_the_command_continues() {
    let scratch = folder("signals");
    let command = format!("campaign small.toml --samples {} --no-report --threads 1", 5 * SAMPLES);
    for (signal, number) in [("HUP", 1), ("INT", 2), ("USR1", 10), ("TERM", 15)] {
        if is_ignored(number) {
            continue;
        }
        let code = 128 + number;
        let before = whole_parts(&scratch.path("r"));
        let mut child = start(&scratch, &format!("{command} --out r"));
        while whole_parts(&scratch.path("r")) == before && child.try_wait().unwrap().is_none() {
            std::thread::sleep(Duration::from_millis(5));
        }
        send(signal, child.id());
        let ended = child.wait().unwrap();
        assert_eq!(ended.code(), Some(code), "SIG{signal}");
        assert!(whole_parts(&scratch.path("r")) > before);
    }
    scratch.prints(&format!("{command} --out r"), 0);
    scratch.prints(&format!("{command} --out whole"), 0);
    assert_same(&scratch, "r", "whole");
}
