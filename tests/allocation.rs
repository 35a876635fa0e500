//! Code that runs once per sample allocates nothing after the first batch, by a counting allocator.

#![allow(clippy::disallowed_methods)] // digits of no row: the elementary functions of the platform will do
#![allow(unsafe_code)] // a global allocator cannot be written without it

mod support;

use std::{
    alloc::{GlobalAlloc, Layout, System},
    cell::Cell,
    hint::black_box,
};
use support::prelude::*;

use spindrift::{
    analysis::fold::RunningFold,
    storage::part_sink::{CountRows, PartFiles},
};
use support::{
    feedback::law,
    plans::shipped,
    runs::{METHODS, adaptive, everything},
    scenes::mixed,
};

struct Counting;

thread_local! {
    static COUNT: Cell<u64> = const { Cell::new(0) };
}

fn count() {
    COUNT.with(|count| count.set(count.get() + 1));
}

// SAFETY: everything is handed on to the system's allocator unchanged; the counter needs no memory.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count();
        // SAFETY: the caller fulfils the requirements of `System`.
        unsafe { System.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        count();
        // SAFETY: as above.
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn realloc(&self, old: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count();
        // SAFETY: as above.
        unsafe { System.realloc(old, layout, size) }
    }

    unsafe fn dealloc(&self, old: *mut u8, layout: Layout) {
        // SAFETY: as above.
        unsafe { System.dealloc(old, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

fn allocations(work: impl FnOnce()) -> u64 {
    let before = COUNT.with(Cell::get);
    work();
    COUNT.with(Cell::get) - before
}

fn plan(name: &str, method: &str) -> Plan {
    let mut plan = shipped(name, Some(512));
    plan.method = Method::ALL.into_iter().find(|known| known.name() == method).unwrap();
    plan
}

#[test]
fn the_counter_counts() {
    assert_eq!(allocations(|| drop(black_box(Box::new(1.0)))), 1);
    let counted = allocations(|| {
        let mut list = vec![0_u8; 8];
        list.reserve_exact(1000);
        black_box(&list);
    });
    assert_eq!(counted, 2);
}

#[test]
fn engines_with_scenes_of_every_kind() {
    for forced in [false, true] {
        let scenes = mixed(24, forced, 10.0);
        for (method, control) in METHODS {
            let scenes = &scenes[..if method == Method::NullSpace { 4 } else { 24 }];
            let grid = Grid::uniform(10.0, 101);
            let settings = PropagationSettings::new(method, control, grid, everything(method), &scenes[0]);
            let mut engine = settings.engine(Isa::best());
            let mut finished = 0;
            engine.propagate(scenes, &mut |_| finished += 1);
            let counted = allocations(|| engine.propagate(scenes, &mut |_| finished += 1));
            assert_eq!((finished, counted), (2 * scenes.len(), 0), "{} allocates", method.name());
        }
    }
}

#[test]
fn engines_under_laws() {
    let scenes = mixed(24, false, 10.0);
    for (method, tolerance) in [(Method::Auto, 1e-8), (DORMAND_PRINCE, 1e-6), (Method::NullSpace, 1e-3)] {
        let count = if method == Method::NullSpace { 4 } else { 24 };
        let scenes = &scenes[..count];
        let grid = Grid::uniform(2.0, 21);
        let settings = PropagationSettings::new(method, adaptive(tolerance), grid, everything(method), &scenes[0]);
        let mut engine = settings.with_feedback(Actuated::ALL).engine(Isa::best());
        let laws = || scenes.iter().map(law).collect::<Vec<_>>();
        let (mut first, mut second) = (laws(), laws());
        engine.propagate_under(Laws::Feedback(&mut first), scenes, &mut |_| {});
        let counted = allocations(|| engine.propagate_under(Laws::Feedback(&mut second), scenes, &mut |_| {}));
        assert_eq!(counted, 0, "{} allocates under laws", method.name());
    }
}

#[test]
fn a_worker() {
    for (name, method) in [
        ("spin_sweep", "auto"),
        ("spin_sweep", "taylor"),
        ("burn", "auto"),
        ("no_debris", "dormand_prince"),
        ("correlated", "auto"),
        ("sobol", "auto"),
    ] {
        let plan = Plan { groups: Group::ALL.to_vec(), ..plan(name, method) };
        let campaign = Ensemble::new(&plan, Isa::best());
        let mut worker = campaign.worker();
        let mut rows = Rows::new(campaign.shape(), 256);
        let mut part = |first, count| {
            let part = Part { id: PartId(0), first: SampleId(first), count };
            worker.run(part, &mut rows, Supervision::progress(&|_| {}));
        };
        part(0, 256);
        assert_eq!(allocations(|| part(256, 256)), 0, "{name}, {method}");
    }
}

#[test]
fn a_worker_with_bands() {
    let plan = plan("spin_sweep", "auto");
    let campaign = Ensemble::new(&plan, Isa::best());
    let mut worker = campaign.worker();
    let mut rows = campaign.rows(256);
    let columns = rows.bands().unwrap().layout().columns() as u64;
    let mut part = |first| {
        let part = Part { id: PartId(0), first: SampleId(first), count: 256 };
        worker.run(part, &mut rows, Supervision::progress(&|_| {}));
    };
    assert!(allocations(|| part(0)) > columns, "the counter-test: the first part has every window to make");
    assert_eq!(allocations(|| part(0)), 0);
    let later = allocations(|| part(256));
    assert!(later < columns, "{later} of {columns} columns");
}

#[derive(Debug)]
struct Added {
    allocations: u64,
    rows: usize,
    bands: usize,
}

const PART: usize = 1024;

fn added(samples: u64, first: u64) -> Added {
    let plan = shipped("no_debris", Some(samples));
    let campaign = Ensemble::new(&plan, Isa::best());
    let (mut worker, mut rows) = (campaign.worker(), campaign.rows(PART));
    let (files, fold) = (PartFiles::new(&campaign).unwrap(), RunningFold::of(&campaign).unwrap());
    let mut buffers: Vec<Vec<u8>> = Vec::new();
    let mut part = |id: u64| {
        let part = Part { id: PartId(id), first: SampleId(first + id * PART as u64), count: PART };
        worker.run(part, &mut rows, Supervision::progress(&|_| {}));
        let emptied = buffers.drain(..).map(|mut bytes| {
            bytes.clear();
            bytes
        });
        let written = files.encoded(&rows, emptied.collect::<Vec<_>>().into_iter()).unwrap();
        fold.add(&rows);
        buffers = written.into_iter().map(|file| file.bytes).collect();
        [buffers[0].len(), buffers[1].len()]
    };
    part(0);
    let mut bytes = [0; 2];
    let allocations = allocations(|| bytes = part(1));
    Added { allocations, rows: bytes[0], bands: bytes[1] }
}

#[test]
fn a_row_of_many() {
    let (few, many) = (added(100_000, 50_000), added(1_000_000, 500_000));
    // other samples compress to other bytes; measured: 0.1%
    assert!(many.rows as f64 <= 1.01 * few.rows as f64, "{many:?}, {few:?}");
    assert!(many.rows <= 900 * PART, "bytes of rows: {many:?}");
    assert!(many.bands * 4 <= few.bands, "bands: {many:?}, {few:?}");
    assert!(many.allocations <= few.allocations, "{many:?}, {few:?}");
}
