//! A row is a pure function of (plan, sample): not of threads, parts, order, or what a worker did before.

use std::num::NonZeroUsize;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

use crate::support::plans::{SOMETIMES_IMPOSSIBLE, shipped_with};
use spindrift::campaign::Plan;
use spindrift::ensemble::{Ensemble, Part, PartId, Parts, Rows, RunError, Sink, Supervision, run};
use spindrift::math::Isa;
use spindrift::run::Status;
use spindrift::sampling::SampleId;

/// The shipped campaign of that name, with a wheel that is sometimes impossible where `with_failures`.
fn plan(name: &str, samples: u64, with_failures: bool) -> Plan {
    shipped_with(name, Some(samples), if with_failures { SOMETIMES_IMPOSSIBLE } else { "" })
}

/// A row as bits: status, dispersed values, observables.
type Bits = (Status, Vec<u64>);

fn bits(rows: &Rows, row: usize) -> Bits {
    let shape = rows.shape();
    let parameters = (0..shape.parameters).map(|index| rows.parameter(index)[row]);
    let observables = (0..shape.observables).map(|index| rows.observable(index)[row]);
    (rows.statuses()[row], parameters.chain(observables).map(f64::to_bits).collect())
}

/// Keeps rows in memory; refuses all parts from a given one on.
#[derive(Default)]
struct Memory {
    rows: Mutex<Vec<(u64, Bits)>>,
    parts: AtomicU64,
    full_from: Option<u64>,
}

impl Sink for Memory {
    type Error = String;

    fn take(&self, rows: &Rows) -> Result<(), String> {
        let part = rows.part();
        self.parts.fetch_add(1, Ordering::Relaxed);
        if self.full_from.is_some_and(|first| part.id.0 >= first) {
            return Err(format!("no space for part {}", part.id.0));
        }
        let mut kept = self.rows.lock().unwrap();
        kept.extend(part.samples().enumerate().map(|(row, sample)| (sample.0, bits(rows, row))));
        Ok(())
    }
}

fn whole(campaign: &Ensemble<'_>, threads: usize) -> Vec<(u64, Bits)> {
    let sink = Memory::default();
    let parts = Parts::of(campaign.plan().samples);
    run(campaign, parts, NonZeroUsize::new(threads), &sink, Supervision::progress(&|_| {})).unwrap();
    let mut rows = sink.rows.into_inner().unwrap();
    rows.sort_by_key(|(sample, _)| *sample);
    rows
}

#[test]
fn rows_do_not_depend_on_threads() {
    for (name, failures) in [("spin_sweep", true), ("burn", false), ("no_debris", false), ("pyramid", false)] {
        let plan = plan(name, 1000, failures);
        let campaign = Ensemble::new(&plan, Isa::best());
        let one = whole(&campaign, 1);
        assert_eq!(one.len(), 1000);
        assert_eq!(one.iter().any(|(_, (status, _))| *status == Status::InvalidSample), failures, "{name}");
        assert!(one == whole(&campaign, 2), "{name}, 2 threads");
        assert!(one == whole(&campaign, 7), "{name}, 7 threads");
    }
}

/// Law: a sample that is run alone, by a worker that has run other samples before, in a part with other bounds, gives the same row.
#[test]
fn rows_do_not_depend_on_company() {
    let plan = plan("spin_sweep", 1000, true);
    let campaign = Ensemble::new(&plan, Isa::best());
    let expected = whole(&campaign, 1);
    let (mut worker, mut rows) = (campaign.worker(), Rows::new(campaign.shape(), 300));
    for (first, count) in [(999, 1), (0, 1), (517, 1), (3, 300), (250, 13), (998, 2), (0, 129)] {
        worker.run(Part { id: PartId(0), first: SampleId(first), count }, &mut rows, Supervision::progress(&|_| {}));
        for row in 0..count {
            assert!(bits(&rows, row) == expected[first as usize + row].1, "sample {}", first as usize + row);
        }
    }
}

/// Counter-test: the comparison sees a single changed bit of a scene.
#[test]
fn the_comparison_can_fail() {
    let plan = plan("spin_sweep", 64, false);
    let rows = |plan: &Plan| whole(&Ensemble::new(plan, Isa::best()), 1);
    let mut other = plan.clone();
    let side = other.nominal.wheels[1].length_m.as_mut().unwrap();
    *side = f64::from_bits(side.to_bits() + 1);
    assert!(rows(&plan) == rows(&plan));
    assert!(rows(&plan) != rows(&other));
}

/// Law: after an error of the sink no further part is started, and the error is reported. With one thread nothing follows the
/// refused part. With more threads, where every part is refused, each thread offers one at most, however they are scheduled.
#[test]
fn a_full_sink_stops_the_campaign() {
    let plan = plan("no_debris", 4096, false);
    let ensemble = Ensemble::new(&plan, Isa::best());
    let parts = Parts::of(4096);
    assert!(parts.count() > 8);
    let offered = |threads: usize, first_refused: u64| {
        let sink = Memory { full_from: Some(first_refused), ..Memory::default() };
        let ended = run(&ensemble, parts, NonZeroUsize::new(threads), &sink, Supervision::progress(&|_| {}));
        assert!(matches!(ended, Err(RunError::Sink(error)) if error.starts_with("no space for part ")));
        sink.parts.into_inner()
    };
    assert_eq!(offered(1, 1), 2);
    for threads in [2, 7] {
        let offered = offered(threads, 0);
        assert!((1..=threads as u64).contains(&offered), "{offered} parts offered by {threads} threads");
    }
}

/// Law: progress counts every sample once.
#[test]
fn progress_counts_every_sample() {
    let plan = plan("no_debris", 777, false);
    let campaign = Ensemble::new(&plan, Isa::best());
    let heard = AtomicU64::new(0);
    let count = |samples| {
        heard.fetch_add(samples, Ordering::Relaxed);
    };
    run(&campaign, Parts::of(777), None, &Memory::default(), Supervision::progress(&count)).unwrap();
    assert_eq!(heard.into_inner(), 777);
}
