//! A fault at the k-th read of a dataset, for every k and command, is an error and never taken for damage.

use crate::prelude::*;
use std::sync::Arc;

use spindrift::workflow::{
    Outputs, Verification, WorkflowError as Failure, compared::compared, finishing::finish as finished, page::remade,
    verify as verified,
};

use crate::reliability::failing_store::{Fault, Making, Operation, Plot, contents, made, on, reason};

type Files = BTreeMap<String, Vec<u8>>;

const SAMPLES: [u64; 2] = [260, 520];

const UNREADABLE: [i32; 3] = [5, 13, 2];

fn is_read(operation: Operation) -> bool {
    operation != Operation::Write
}

fn faults(operation: Operation) -> Vec<Fault> {
    let errors = match operation {
        Operation::Write => &[][..],
        Operation::Read | Operation::List => &UNREADABLE,
        Operation::Lock => &UNREADABLE[..1],
    };
    errors.iter().map(|number| Fault::System(*number)).collect()
}

fn causes(fault: Fault) -> [String; 2] {
    [fault.error().to_string(), "has no result of spindrift".to_owned()]
}

type Command = fn(&Arc<Plot>, &Path) -> Result<(), Failure>;

fn make_large(plot: &Arc<Plot>, root: &Path) -> Result<(), Failure> {
    Making::of(SAMPLES[1]).make(plot, root)
}

fn finish(plot: &Arc<Plot>, root: &Path) -> Result<(), Failure> {
    let outputs = Outputs { without_page: true, ..Outputs::default() };
    on(plot, |session| finished(session, root, &outputs, &|_| Ok(())).map(|_| ()))
}

fn verify(plot: &Arc<Plot>, root: &Path, repair: bool) -> Result<(), Failure> {
    on(plot, |session| verified(session, root, Verification { fraction: 0.0, repair }).map(|_| ()))
}

fn verify_only(plot: &Arc<Plot>, root: &Path) -> Result<(), Failure> {
    verify(plot, root, false)
}

fn repair(plot: &Arc<Plot>, root: &Path) -> Result<(), Failure> {
    verify(plot, root, true)
}

fn report(plot: &Arc<Plot>, root: &Path) -> Result<(), Failure> {
    on(plot, |session| remade(session, root, None, None).map(|_| ()))
}

fn compare(plot: &Arc<Plot>, root: &Path) -> Result<(), Failure> {
    on(plot, |session| {
        let [first, second] = [Results::open(root, *session)?, Results::open(root, *session)?];
        compared([&first, &second], ["first", "second"].map(str::to_owned)).map(|_| ())
    })
}

fn restore(root: &Path, files: &Files) {
    let _ = fs::remove_dir_all(root);
    for (name, bytes) in files {
        let path = root.join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, bytes).unwrap();
    }
}

struct Case<'a> {
    name: &'a str,
    command: Command,
    start: &'a Files,
    /// The name of the part that is damaged at the start, or has more rows at the end.
    made_again: &'static str,
}

#[derive(Debug, Default)]
struct Count {
    reads: usize,
    faults: usize,
    errors: usize,
}

impl Case<'_> {
    /// Lets every read fail: in every way, once and from then on, or in one of these ways in turn.
    fn check(&self, root: &Path, in_turn: bool) -> Count {
        let (name, start) = (self.name, self.start);
        restore(root, start);
        let counted = Plot::harmless(is_read);
        (self.command)(&counted, root).unwrap_or_else(|error| panic!("{name}: {error:?}"));
        let goal = contents(root);
        let reads = counted.done();
        println!("{name}: {} reads", reads.len());
        restore(root, start);
        let mut count = Count { reads: reads.len(), ..Count::default() };
        for (fails, (operation, path)) in reads.iter().enumerate() {
            let all = faults(*operation);
            let ways = all.iter().flat_map(|fault| [(*fault, false), (*fault, true)]);
            let (skipped, taken) = if in_turn { (count.faults % (2 * all.len()), 1) } else { (0, usize::MAX) };
            for (fault, persists) in ways.skip(skipped).take(taken) {
                let what = format!(
                    "{name}: {fault:?} at read {fails} ({operation:?} {}), persists: {persists}",
                    path.display()
                );
                let plot = Plot::new(is_read, fails as u64, persists, fault);
                let ended = (self.command)(&plot, root);
                count.faults += 1;
                count.errors += usize::from(ended.is_err());
                let failed = plot.done().split_off(fails);
                let paths = failed.iter().take(if persists { failed.len() } else { 1 }).map(|(_, path)| path);
                self.check_end(&what, root, paths.collect(), (ended, fault), &goal);
            }
        }
        count
    }

    /// Checks how the command ended, and what it left.
    fn check_end(
        &self,
        what: &str,
        root: &Path,
        paths: Vec<&PathBuf>,
        (ended, fault): (Result<(), Failure>, Fault),
        goal: &Files,
    ) {
        let now = contents(root);
        match &ended {
            Ok(()) => assert!(now == *goal, "{what}: ended well with other files"),
            Err(failure) => {
                let message = reason(failure);
                let is_nothing =
                    message.contains("has no result of spindrift") && fault == Fault::System(UNREADABLE[2]);
                assert!(matches!(failure, Failure::Files(_)) || is_nothing, "{what}: {message}");
                let names = |path: &&PathBuf| message.contains(path.to_str().unwrap());
                assert!(paths.iter().any(names), "{what}: no path in {message:?}");
                assert!(causes(fault).iter().any(|cause| message.contains(cause)), "{what}: no cause in {message:?}");
            }
        }
        if now == *self.start {
            return;
        }
        for (name, bytes) in
            self.start.iter().filter(|(name, _)| ["runs/", "bands/"].iter().any(|of| name.starts_with(of)))
        {
            let is_sound = self.made_again.is_empty() || !name.contains(self.made_again);
            assert!(!is_sound || now.get(name) == Some(bytes), "{what}: {name} was dropped or changed");
        }
        for (name, bytes) in now.iter().filter(|(name, _)| !name.ends_with(".tmp")) {
            let is_known = [goal, self.start].iter().any(|files| files.get(name) == Some(bytes));
            assert!(is_known, "{what}: {name} is neither as before nor as it will be");
        }
        if now != *goal {
            (self.command)(&Plot::harmless(is_read), root).unwrap_or_else(|error| panic!("{what}: again: {error:?}"));
            let again = contents(root);
            assert_eq!(again.keys().collect::<Vec<_>>(), goal.keys().collect::<Vec<_>>(), "{what}: again");
            assert!(again == *goal, "{what}: again");
        }
        restore(root, self.start);
    }
}

/// Law: whichever read fails, the command names path and cause with code 4 or is not affected; no part is lost.
macro_rules! reads_may_fail {
    ($($test:ident: $command:literal),* $(,)?) => {$(
        #[test]
        fn $test() {
            reads_fail($command, true);
        }
    )*};
}

reads_may_fail! {
    reads_of_campaign_may_fail: "campaign",
    reads_of_finish_may_fail: "finish",
    reads_of_verify_may_fail: "verify",
    reads_of_report_may_fail: "report",
    reads_of_compare_may_fail: "compare",
}

#[ignore = "a minute: cargo test --release --test program -- --ignored every_read_may_fail"]
#[test]
fn every_read_may_fail() {
    reads_fail("", false);
}

fn reads_fail(of: &str, in_turn: bool) {
    let scratch = ScratchFolder::new(&format!("read-faults-{of}-{in_turn}"));
    let root = scratch.path("r");
    let [whole, longer] = SAMPLES.map(|samples| made(Making::of(samples), &root));
    let without_end = |files: &Files, parts: usize| -> Files {
        let numbers: Vec<String> = (0..parts).map(|part| format!("part-{part:06}.")).collect();
        let is_kept = |name: &str| {
            ["plan.toml", "dataset.json"].contains(&name) || numbers.iter().any(|number| name.contains(number))
        };
        files.iter().filter(|(name, _)| is_kept(name)).map(|(name, bytes)| (name.clone(), bytes.clone())).collect()
    };
    let (interrupted, unfinished) = (without_end(&longer, 2), without_end(&whole, 2));
    let mut damaged = whole.clone();
    damaged.get_mut("runs/part-000001.parquet").unwrap()[200] ^= 4;
    let case = |name, command, start| Case { name, command, start, made_again: "" };
    let cases = [
        case("campaign, interrupted", make_large as Command, &interrupted),
        Case { made_again: "part-000001", ..case("campaign, extended", make_large, &whole) },
        case("campaign, complete", make_large, &longer),
        case("finish", finish, &unfinished),
        case("verify", verify_only, &longer),
        case("verify --repair of a sound result", repair, &longer),
        Case { made_again: "part-000001", ..case("verify --repair", repair, &damaged) },
        case("report", report, &whole),
        case("compare", compare, &whole),
    ];
    for case in cases.iter().filter(|case| case.name.starts_with(of)) {
        let count = case.check(&root, in_turn);
        println!("{}: {count:?}", case.name);
        assert!(count.reads > 15 && count.faults > 10 && count.errors * 2 > count.faults, "{}: {count:?}", case.name);
    }
}
