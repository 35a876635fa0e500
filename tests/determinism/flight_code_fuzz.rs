//! Modules of flight code at random, each loaded and flown as campaigns are, in processes of their own: an error or
//! rows, never a panic, a crash or a hang, within bounds of time and memory.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::io::{BufRead, BufReader, Write as _};
use std::process::{Command, Stdio};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::{Duration, Instant};

use super::random_modules::{KINDS, module};
use crate::support::scratch_folder::ScratchFolder;
use rustix::time::{ClockId, clock_gettime};
use spindrift::campaign::{Overrides, Plan};
use spindrift::control::failure::Failure;
use spindrift::ensemble::{Ensemble, Part, PartId, Supervision};
use spindrift::math::Isa;
use spindrift::run::Status;
use spindrift::sampling::SampleId;

/// Modules of a child process. A process keeps what it has compiled.
const OF_A_CHILD: u64 = 500;
/// Runs of each module, of nine ticks.
const RUNS: usize = 3;
/// Most time on the processor that a module may take, to be compiled and to fly twice, s: several times the slowest
/// that was found.
const MOST_CPU: f64 = 30.0;
/// Most time that passes without news of a child, on a machine that has other work.
const PATIENCE: Duration = Duration::from_secs(600);
/// Most memory of a child, MiB.
const MOST_MEMORY: u64 = 2048;
/// What a child is told: seed, first module, and the one behind the last.
const TOLD: &str = "SPINDRIFT_FUZZ_MODULES";

/// The campaign of the examples, short; with the parameters of its module where that is one of the examples, damaged.
fn campaign(kind: &str) -> String {
    let text = include_str!("../../examples/flight_code/flight_code.toml");
    let text = text.replace("mrp_feedback_c.wasm", "random.wasm").replace("\"3 min\"", "\"2 s\"");
    let text = text.replace("points = 181", "points = 3");
    let text = &text[..text.find("[[require]]").unwrap()];
    if kind == "damaged" {
        return text.to_owned();
    }
    let own = ["stiffness_n_m", "damping_n_m_s", "integral_"];
    let lines = text.lines().filter(|line| !own.iter().any(|key| line.starts_with(key)));
    let text: String = lines.map(|line| format!("{line}\n")).collect();
    text[..text.find("[[disperse]]                # a parameter").unwrap()].to_owned()
}

/// The campaign of a module of the kind `kind` with these bytes: the two examples have parameters of their own.
fn campaign_of<'a>(kind: &'a str, bytes: &[u8]) -> &'a str {
    let is_gyro = bytes.windows(10).any(|part| part == b"patience_s");
    if kind == "damaged" && is_gyro { "gyro" } else { kind }
}

/// What comes of the module with these bytes: in one word each, first of all whether it was refused.
fn outcome(folder: &ScratchFolder, kind: &str, bytes: &[u8]) -> String {
    std::fs::write(folder.path("random.wasm"), bytes).unwrap();
    let file = format!("{}.toml", campaign_of(kind, bytes));
    let plan = match Plan::load(&folder.path(&file), Overrides::default()) {
        Ok(plan) => plan,
        Err(error) => {
            let text = error.to_string();
            assert!(text.contains("control.module") || text.contains("guidance"), "of something else: {text}");
            return format!("refused {}", word_of(&text));
        }
    };
    let place = plan.request().columns().iter().position(|column| column.quantity.name() == "failure").unwrap();
    let flown = || {
        let ensemble = Ensemble::new(&plan, Isa::best());
        let mut rows = ensemble.rows(RUNS);
        let part = Part { id: PartId(0), first: SampleId(0), count: RUNS };
        ensemble.worker().run(part, &mut rows, Supervision::progress(&|_| {}));
        let columns = 0..plan.request().columns().len();
        let bits: Vec<u64> =
            columns.flat_map(|column| rows.observable(column).iter().map(|value| value.to_bits())).collect();
        (rows.statuses().to_vec(), bits, rows.observable(place).to_vec())
    };
    let (statuses, bits, failures) = flown();
    if statuses.contains(&Status::InternalError) {
        return "PANIC in a run".to_owned();
    }
    if flown().1 != bits {
        return "OTHER rows".to_owned();
    }
    let known = [Failure::ModuleTrap, Failure::ModuleFuel, Failure::Diverged];
    let word = known.iter().zip(["trap", "fuel", "not-finite"]).find(|(failure, _)| failures.contains(&failure.code()));
    format!("flown {}", word.map_or("to-the-end", |(_, word)| word))
}

/// The reason of a refusal, in short.
fn word_of(error: &str) -> &'static str {
    let reasons = [
        ("does not begin", "no-module"),
        ("core module", "no-module"),
        ("imports", "imports"),
        ("is not a function", "wrong-type"),
        ("does not export", "exports"),
        ("belong together", "exports"),
        ("its interface is", "interface"),
        ("beyond its memory", "addresses"),
        ("_table:", "tables"),
        ("which interface 2 has", "interface"),
        ("it wants", "sensors"),
        ("a parameter whose", "parameters"),
        ("are more than", "too-large"),
        ("more than 1000", "too-large"),
        ("has more than", "too-large"),
        ("at most 4194304", "too-large"),
        ("fuel", "fuel-at-start"),
        ("offset 0x", "invalid"),
        ("wasm trap", "trap-at-start"),
        ("guidance.", "keys"),
    ];
    reasons.iter().find(|(part, _)| error.contains(part)).map_or("otherwise", |(_, word)| word)
}

/// Time of this thread on the processor, s.
fn cpu() -> f64 {
    let time = clock_gettime(ClockId::ThreadCPUTime);
    time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
}

/// Modules that fly.
fn shipped() -> Vec<Vec<u8>> {
    let folder = format!("{}/examples/flight_code", env!("CARGO_MANIFEST_DIR"));
    let mut files: Vec<_> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    files.retain(|file| file.extension().is_some_and(|end| end == "wasm"));
    files.iter().map(|file| std::fs::read(file).unwrap()).collect()
}

/// The work of a child process: says of each module when it begins and what has come of it.
#[test]
#[ignore = "the child process of the tests below"]
fn modules_of_a_child() {
    let Ok(told) = std::env::var(TOLD) else { return };
    let numbers: Vec<u64> = told.split(' ').map(|number| number.parse().unwrap()).collect();
    let (folder, shipped) = (ScratchFolder::new("flight-code-fuzz-child"), shipped());
    KINDS.iter().for_each(|kind| folder.file(&format!("{kind}.toml"), &campaign(kind)));
    let of_gyro: Vec<String> =
        campaign("damaged").lines().filter(|line| !line.starts_with("integral_")).map(str::to_owned).collect();
    folder.file("gyro.toml", &of_gyro.join("\n"));
    let say = |line: String| {
        let mut out = std::io::stdout().lock();
        out.write_all(format!("\nfuzz {line}\n").as_bytes()).and_then(|()| out.flush()).unwrap();
    };
    for number in numbers[1]..numbers[2] {
        let (kind, bytes) = module(numbers[0], number, &shipped);
        say(format!("begins {number}"));
        let before = cpu();
        let outcome = outcome(&folder, kind, &bytes);
        say(format!("done {number} {} {kind} {outcome}", cpu() - before));
    }
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let peak = status.lines().find_map(|line| line.strip_prefix("VmHWM:")?.trim().split(' ').next());
    say(format!("memory {}", peak.unwrap_or("0")));
}

/// What has come of modules.
#[derive(Default)]
struct Report {
    modules: u64,
    cpu: f64,
    outcomes: BTreeMap<String, u64>,
    slowest: (f64, u64),
    memory: u64,
    failures: Vec<String>,
}

impl Report {
    fn text(&self) -> String {
        let Report { modules, cpu, slowest, memory, .. } = self;
        let mut text = format!(
            "{modules} modules in {cpu:.0} s of the processor; slowest: {:.2} s, module {}; memory: {} MiB\n",
            slowest.0,
            slowest.1,
            memory >> 10
        );
        self.outcomes.iter().for_each(|(outcome, count)| writeln!(text, "{count:9}  {outcome}").unwrap());
        self.failures.iter().for_each(|failure| writeln!(text, "FAILURE  {failure}").unwrap());
        text
    }

    /// Tries the modules from `first` to `end` in a child process; the first that is not tried: `end`, unless one has
    /// ended the process.
    fn try_modules(&mut self, seed: u64, first: u64, end: u64) -> u64 {
        let mut child = Command::new(std::env::current_exe().unwrap());
        child.args(["--exact", "flight_code_fuzz::modules_of_a_child", "--ignored", "--nocapture"]);
        child.env(TOLD, format!("{seed} {first} {end}")).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = child.spawn().unwrap();
        let (sender, news) = channel();
        let out = BufReader::new(child.stdout.take().unwrap());
        std::thread::spawn(move || out.lines().map_while(Result::ok).try_for_each(|line| sender.send(line)));
        let errors = BufReader::new(child.stderr.take().unwrap());
        let errors = std::thread::spawn(move || errors.lines().map_while(Result::ok).collect::<Vec<_>>().join(" / "));
        let (mut next, mut begun) = (first, None);
        loop {
            let line = match news.recv_timeout(PATIENCE) {
                Ok(line) => line,
                Err(RecvTimeoutError::Timeout) => {
                    child.kill().unwrap();
                    self.failures.push(format!("module {begun:?} of seed {seed} hangs"));
                    break;
                }
                Err(RecvTimeoutError::Disconnected) => break,
            };
            let words: Vec<&str> = line.split(' ').collect();
            match words[..] {
                ["fuzz", "begins", number] => begun = number.parse::<u64>().ok(),
                ["fuzz", "done", number, cpu, kind, ref outcome @ ..] => {
                    let (number, cpu): (u64, f64) = (number.parse().unwrap(), cpu.parse().unwrap());
                    (next, begun) = (number + 1, None);
                    (self.modules, self.cpu) = (self.modules + 1, self.cpu + cpu);
                    self.slowest = if cpu > self.slowest.0 { (cpu, number) } else { self.slowest };
                    *self.outcomes.entry(format!("{kind}: {}", outcome.join(" "))).or_default() += 1;
                    if cpu > MOST_CPU || ["PANIC", "OTHER"].contains(&outcome[0]) {
                        self.failures
                            .push(format!("module {number} of seed {seed}, {kind}: {} in {cpu} s", outcome.join(" ")));
                    }
                }
                ["fuzz", "memory", kib] => self.memory = self.memory.max(kib.parse().unwrap()),
                _ => {}
            }
        }
        let status = child.wait().unwrap();
        let errors = errors.join().unwrap();
        if let Some(number) = begun {
            self.failures.push(format!("module {number} of seed {seed} has ended the process, {status}: {errors}"));
            return number + 1;
        }
        if self.memory >> 10 > MOST_MEMORY {
            self.failures.push(format!("modules {first} to {end} of seed {seed} take {} MiB", self.memory >> 10));
        }
        if next < end {
            self.failures.push(format!("modules from {next} on of seed {seed} were not tried, {status}: {errors}"));
        }
        end
    }
}

/// Law: an error or a row: of modules of every kind some are refused and some fly, and none ends its process, panics in
/// a run, or gives other rows the second time.
#[test]
fn some_modules_at_random_are_refused_or_fly() {
    let mut report = Report::default();
    let mut next = 0;
    while next < 250 {
        next = report.try_modules(20_261_126, next, 250);
    }
    assert!(report.failures.is_empty(), "{}", report.text());
    let count = |part: &str| {
        report.outcomes.iter().filter(|(name, _)| name.contains(part)).map(|(_, count)| count).sum::<u64>()
    };
    let found = [
        "flown to-the-end",
        "flown trap",
        "flown fuel",
        "refused invalid",
        "bytes:",
        "damaged: flown",
        "valid: refused",
        "large: flown",
    ]
    .map(count);
    assert!(found.iter().all(|count| *count > 0), "{}", report.text());
}

/// The same for as many seconds of the processor as `SPINDRIFT_FUZZ_S` says (3,600), from seed `SPINDRIFT_FUZZ_SEED`
/// (1) on, with news every minute.
#[test]
#[ignore = "an hour: cargo test --release --features wasm --test determinism -- --ignored --nocapture \
    an_hour_of_modules"]
fn an_hour_of_modules_at_random() {
    let told = |name: &str, other: u64| std::env::var(name).map_or(other, |text| text.parse().unwrap());
    let (seconds, seed) = (told("SPINDRIFT_FUZZ_S", 3600) as f64, told("SPINDRIFT_FUZZ_SEED", 1));
    let mut report = Report::default();
    let (mut next, mut said) = (0, Instant::now());
    while report.cpu < seconds {
        next = report.try_modules(seed, next, next + OF_A_CHILD);
        if said.elapsed() > Duration::from_secs(60) {
            said = Instant::now();
            println!("{}", report.text());
        }
    }
    println!("{}", report.text());
    assert!(report.failures.is_empty(), "{}", report.text());
}
