//! A row is a function of plan and sample, not of threads, parts or order.

use crate::prelude::*;
use std::sync::atomic::AtomicU64;

use crate::support::plans::{SOMETIMES_IMPOSSIBLE, seen, shipped_with};
use spindrift::ensemble::RunError;

fn plan(name: &str, samples: u64, with_failures: bool) -> Plan {
    shipped_with(name, Some(samples), if with_failures { SOMETIMES_IMPOSSIBLE } else { "" })
}

fn whole(campaign: &Ensemble<'_>, threads: usize) -> Vec<(u64, RowBits)> {
    seen(campaign, Some(threads), row_bits)
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

/// Law: a sample run alone, by a used worker, or in another part gives the same row.
#[test]
fn rows_do_not_depend_on_company() {
    let plan = plan("spin_sweep", 1000, true);
    let campaign = Ensemble::new(&plan, Isa::best());
    let expected = whole(&campaign, 1);
    let (mut worker, mut rows) = (campaign.worker(), Rows::new(campaign.shape(), 300));
    for (first, count) in [(999, 1), (0, 1), (517, 1), (3, 300), (250, 13), (998, 2), (0, 129)] {
        worker.run(Part { id: PartId(0), first: SampleId(first), count }, &mut rows, Supervision::progress(&|_| {}));
        for row in 0..count {
            assert!(row_bits(&rows, row) == expected[first as usize + row].1, "sample {}", first as usize + row);
        }
    }
}

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

/// Law: an error of the sink starts no further part and is reported; each thread offers one part at most after it.
#[test]
fn a_full_sink_stops_the_campaign() {
    let plan = plan("no_debris", 4096, false);
    let ensemble = Ensemble::new(&plan, Isa::best());
    let parts = Parts::of(4096);
    assert!(parts.count() > 8);
    let offered = |threads: usize, first_refused: u64| {
        let offered = AtomicU64::new(0);
        let sink = |rows: &Rows| {
            offered.fetch_add(1, Ordering::Relaxed);
            let part = rows.part().id.0;
            if part >= first_refused { Err(format!("no space for part {part}")) } else { Ok(()) }
        };
        let ended = run(&ensemble, parts, NonZeroUsize::new(threads), &sink, Supervision::progress(&|_| {}));
        assert!(matches!(ended, Err(RunError::Sink(error)) if error.starts_with("no space for part ")));
        offered.into_inner()
    };
    assert_eq!(offered(1, 1), 2);
    for threads in [2, 7] {
        let offered = offered(threads, 0);
        assert!((1..=threads as u64).contains(&offered), "{offered} parts offered by {threads} threads");
    }
}

#[test]
fn progress_counts_every_sample() {
    let plan = plan("no_debris", 777, false);
    let campaign = Ensemble::new(&plan, Isa::best());
    let heard = AtomicU64::new(0);
    let count = |samples| {
        heard.fetch_add(samples, Ordering::Relaxed);
    };
    run(&campaign, Parts::of(777), None, &|_| Ok::<(), String>(()), Supervision::progress(&count)).unwrap();
    assert_eq!(heard.into_inner(), 777);
}
