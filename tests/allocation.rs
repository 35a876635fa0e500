//! Code that runs once per sample does not allocate after the first batch; a counting allocator checks this.

#![allow(clippy::disallowed_methods)] // digits of no row: the elementary functions of the platform will do
#![allow(unsafe_code)] // a global allocator cannot be written without it

mod support;

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::hint::black_box;

use spindrift::analysis::fold::RunningFold;
use spindrift::campaign::Plan;
use spindrift::dynamics::actuation::Laws;
use spindrift::dynamics::effects::within_arcs::Beside;
use spindrift::dynamics::gyrostat::Gyrostat;
use spindrift::dynamics::gyrostat::equations::Constants;
use spindrift::dynamics::null_space::{Kernel, components, sigma};
use spindrift::ensemble::{Ensemble, Part, PartId, Rows, Supervision};
use spindrift::math::Isa;
use spindrift::observables::{Groups, Observer, Request};
use spindrift::ode::{Control, Integrator};
use spindrift::propagation::{CompletedRun, Method, PropagationSettings};
use spindrift::run::Grid;
use spindrift::sampling::SampleId;
use spindrift::scene::{Actuated, Scene};
use spindrift::storage::part_sink::{CountRows, PartFiles};
use support::draws;
use support::feedback::law;
use support::observed::request;
use support::plans::shipped;
use support::runs::{adaptive, everything, fixed};
use support::scenes::mixed;

/// The system's allocator, which counts per thread, so that other tests do not count.
struct Counting;

thread_local! {
    static COUNT: Cell<u64> = const { Cell::new(0) };
}

fn count() {
    COUNT.with(|count| count.set(count.get() + 1));
}

// SAFETY: everything is handed on to the system's allocator unchanged; the counter is a plain number that needs no
// memory.
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

/// Allocations of this thread while `work` runs.
fn allocations(work: impl FnOnce()) -> u64 {
    let before = COUNT.with(Cell::get);
    work();
    COUNT.with(Cell::get) - before
}

fn plan(name: &str, method: &str) -> Plan {
    let mut plan = shipped(name, Some(512));
    plan.method = Method::ALL.into_iter().find(|known| known.name() == method).expect("a method");
    plan
}

/// The counter counts; otherwise every test below would pass for any program.
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

/// Law: after one batch a batch of other samples costs no allocation, with any method.
#[test]
fn engines() {
    for name in ["spin_sweep", "burn"] {
        let plan = plan(name, "auto");
        let (first, second) = (draws::scenes(&plan, 0..128), draws::scenes(&plan, 128..256));
        for (method, control) in [
            (Method::Auto, adaptive(1e-12)),
            (Method::Taylor, adaptive(1e-12)),
            (Method::Gyrostat(Integrator::DormandPrince), adaptive(1e-6)),
            (Method::Gyrostat(Integrator::Dop853), adaptive(1e-6)),
            (Method::Gyrostat(Integrator::RungeKutta4), fixed(0.05)),
            (Method::Gyrostat(Integrator::GaussLegendre), fixed(0.05)),
            (Method::NullSpace, adaptive(1e-3)),
        ] {
            let count = if method == Method::NullSpace { 4 } else { 128 };
            no_allocation(method, control, &first[..count], &second[..count], name);
        }
    }
}

/// The same for scenes of every kind: missing wheels, products of inertia, boxes as debris, forced and free.
#[test]
fn engines_with_scenes_of_every_kind() {
    for forced in [false, true] {
        let scenes = mixed(24, forced, 10.0);
        for method in [Method::Auto, Method::Taylor, Method::Gyrostat(Integrator::DormandPrince)] {
            no_allocation(method, adaptive(1e-8), &scenes, &scenes, "every kind");
        }
    }
}

fn no_allocation(method: Method, control: Control, first: &[Scene], second: &[Scene], what: &str) {
    let grid = Grid::uniform(10.0, 101);
    let mut engine = PropagationSettings::new(method, control, grid, everything(method), &first[0]).engine(Isa::best());
    let mut finished = 0;
    engine.propagate(first, &mut |_| finished += 1);
    let counted = allocations(|| engine.propagate(second, &mut |_| finished += 1));
    assert_eq!(finished, first.len() + second.len());
    assert_eq!(counted, 0, "{} allocates in {what}", method.name());
}

/// The same under laws of the runs' own.
#[test]
fn engines_under_laws() {
    let scenes = mixed(24, false, 10.0);
    for (method, tolerance) in
        [(Method::Auto, 1e-8), (Method::Gyrostat(Integrator::DormandPrince), 1e-6), (Method::NullSpace, 1e-3)]
    {
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

/// Law: an observer allocates when it is made and never again.
#[test]
fn observation() {
    for (name, method) in [("spin_sweep", Method::Auto), ("burn", Method::Auto), ("spin_sweep", Method::NullSpace)] {
        let plan = plan(name, "auto");
        let scenes = draws::scenes(&plan, 0..3);
        let actuated = Actuated::of(&plan.nominal);
        let constrained = method == Method::NullSpace;
        let wheels = plan.nominal.turning_wheels();
        let request =
            Request { actuated, wheels, ..request(Groups::ALL, 0, plan.nominal.debris.is_some(), false, constrained) };
        let mut observer = Observer::new(request, &plan.grid);
        let mut row = vec![0.0; request.columns().len()];
        let control = adaptive(if constrained { 1e-3 } else { 1e-12 });
        let propagator = PropagationSettings::new(method, control, plan.grid.clone(), request.fields(), &scenes[0]);
        let mut observed = 0;
        propagator.engine(Isa::best()).propagate(&scenes, &mut |CompletedRun { index, table, outcome, .. }| {
            let counted = allocations(|| {
                observer.observe(Isa::best(), &scenes[index], table, outcome, &mut row);
            });
            assert_eq!(counted, 0, "observing {name}");
            observed += 1;
        });
        assert_eq!(observed, 3);
    }
}

/// Law: right-hand sides use the stack only.
#[test]
fn right_hand_sides() {
    let scene = &mixed(1, true, 1.0)[0];
    let actuation = scene.schedule[0].applied;
    let state: [f64; components(2)] = sigma::<2>(scene).components();
    let gyrostat = Gyrostat::new(0.0, scene, 1.0);
    let mut constants = Constants::zero(0.0);
    constants.set_run(0, &gyrostat, 1.0);
    constants.set_arc(0, &gyrostat, 0, 1.0);
    let reduced: [f64; 21] = std::array::from_fn(|i| 0.1 * i as f64);
    let beside = Beside { torque: [0.0; 3], force: None, carrier: None };
    let counted = allocations(|| {
        let mut kernel = Kernel::<2>::new(scene);
        kernel.drive(&actuation);
        black_box(kernel.derivative(black_box(&state)));
        black_box(constants.derivative(0.0, black_box(&reduced), &beside));
    });
    assert_eq!(counted, 0);
}

/// Law: drawing a sample into a scene, and making the scene of it, reuses memory.
#[test]
fn draws_and_scenes() {
    for name in ["spin_sweep", "burn", "no_debris", "correlated", "sobol"] {
        let plan = plan(name, "auto");
        let mut sampler = plan.dispersions.sampler();
        let mut applied = vec![0.0; plan.dispersions.columns().len()];
        let mut input = plan.nominal.clone();
        sampler.draw(SampleId(1), &mut input, &mut applied);
        let mut scene = Scene::resolve(&input).expect("shipped campaigns draw physical scenes");
        let counted = allocations(|| {
            for sample in 0..256 {
                sampler.draw(SampleId(sample), &mut input, &mut applied);
                scene.resolve_into(&input).expect("shipped campaigns draw physical scenes");
            }
        });
        assert_eq!(counted, 0, "{name}");
    }
}

/// Law: a worker of a campaign - draw, propagate, observe, write rows - allocates in its first part only.
#[test]
fn a_worker() {
    for (name, method) in
        [("spin_sweep", "auto"), ("spin_sweep", "taylor"), ("burn", "auto"), ("no_debris", "dormand_prince")]
    {
        let plan = plan(name, method);
        let campaign = Ensemble::new(&plan, Isa::best());
        let mut worker = campaign.worker();
        let mut rows = Rows::new(campaign.shape(), 256);
        let mut part = |first, count| {
            worker.run(
                Part { id: PartId(0), first: SampleId(first), count },
                &mut rows,
                Supervision::progress(&|_| {}),
            );
        };
        part(0, 256);
        assert_eq!(allocations(|| part(256, 256)), 0, "{name}, {method}");
    }
}

/// Law: bands allocate only where a deviation is in an octave that no earlier one was in: the same part again allocates
/// nothing, and a later part less than once in a column.
#[test]
fn a_worker_with_bands() {
    let plan = plan("spin_sweep", "auto");
    let campaign = Ensemble::new(&plan, Isa::best());
    let mut worker = campaign.worker();
    let mut rows = campaign.rows(256);
    let columns = rows.bands().expect("bands").layout().columns() as u64;
    let mut part = |first| {
        let part = Part { id: PartId(0), first: SampleId(first), count: 256 };
        worker.run(part, &mut rows, Supervision::progress(&|_| {}));
    };
    assert!(allocations(|| part(0)) > columns, "the counter-test: the first part has every window to make");
    assert_eq!(allocations(|| part(0)), 0);
    let later = allocations(|| part(256));
    assert!(later < columns, "{later} of {columns} columns");
}

/// What a part of `no_debris` adds to a campaign that runs: allocations, bytes of its file of rows and of its bands.
#[derive(Debug)]
struct Added {
    allocations: u64,
    rows: usize,
    bands: usize,
}

/// Rows of the part that is looked at.
const PART: usize = 1024;

/// What the part of the samples from `first` on adds to a campaign of `samples` samples, after another part.
fn added(samples: u64, first: u64) -> Added {
    let plan = shipped("no_debris", Some(samples));
    let campaign = Ensemble::new(&plan, Isa::best());
    let (mut worker, mut rows) = (campaign.worker(), campaign.rows(PART));
    let (files, fold) = (PartFiles::new(&campaign).expect("files"), RunningFold::of(&campaign).expect("a fold"));
    let mut buffers: Vec<Vec<u8>> = Vec::new();
    let mut part = |id: u64| {
        let part = Part { id: PartId(id), first: SampleId(first + id * PART as u64), count: PART };
        worker.run(part, &mut rows, Supervision::progress(&|_| {}));
        let emptied = buffers.drain(..).map(|mut bytes| {
            bytes.clear();
            bytes
        });
        let written = files.encoded(&rows, emptied.collect::<Vec<_>>().into_iter()).expect("encoded");
        fold.add(&rows);
        buffers = written.into_iter().map(|file| file.bytes).collect();
        [buffers[0].len(), buffers[1].len()]
    };
    part(0);
    let mut bytes = [0; 2];
    let allocations = allocations(|| bytes = part(1));
    Added { allocations, rows: bytes[0], bands: bytes[1] }
}

/// Law: a row costs no more where there are many. Counted in place of clocks: its bytes on the disk, and allocations of
/// encoding and statistics. A part beyond those that bands count adds extremes only; sketches of a large campaign
/// allocate no more than lists of values of a small one.
#[test]
fn a_row_of_many() {
    let (few, many) = (added(100_000, 50_000), added(1_000_000, 500_000));
    println!("{few:?} {many:?}");
    // other samples compress to other bytes; measured: 0.1%
    assert!(many.rows as f64 <= 1.01 * few.rows as f64, "{many:?}, {few:?}");
    assert!(many.rows <= 900 * PART, "bytes of rows: {many:?}");
    assert!(many.bands * 4 <= few.bands, "bands: {many:?}, {few:?}");
    assert!(many.allocations <= few.allocations, "{many:?}, {few:?}");
}
