//! The parts of a campaign, each alone, and the whole.
//!
//! `cargo bench -p spindrift-benches --bench campaign`. One thread; `campaigns/no_debris.toml`, which is `spin_sweep`
//! without the debris, `auto` at 1e-10. Throughput is in samples per second.
//!
//! - `sampling`: samples, and mass properties and initial state from them;
//! - `observation`: the observables of a run in the state table: all, those about the centre of mass with the
//!   energy transfer, those alone, and the error estimate alone;
//! - `writing`: rows to Parquet, in memory;
//! - `campaign`: all of it, rows given to a sink that drops them, and rows written.

#![allow(clippy::disallowed_methods)] // digits of no row: the elementary functions of the platform will do

use std::convert::Infallible;
use std::hint::black_box;
use std::num::NonZeroUsize;
use std::path::Path;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use spindrift::campaign::{Compression, Overrides, Plan};
use spindrift::ensemble::settings::propagator;
use spindrift::ensemble::{Ensemble, Part, PartId, Parts, Rows, Supervision, run};
use spindrift::math::Isa;
use spindrift::observables::{Group, Groups, Observer, Request};
use spindrift::propagation::CompletedRun;
use spindrift::sampling::SampleId;
use spindrift::scene::Scene;
use spindrift::storage::rows_file::RowsFile;

/// Samples of one measurement.
const SAMPLES: u64 = 1024;

fn plan() -> Plan {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../campaigns/no_debris.toml");
    Plan::load(&path, Overrides { samples: Some(SAMPLES), ..Overrides::default() })
        .expect("a shipped campaign is valid")
}

fn sampling(criterion: &mut Criterion) {
    let plan = plan();
    let (mut sampler, mut input) = (plan.dispersions.sampler(), plan.nominal.clone());
    let mut applied = vec![0.0; plan.dispersions.columns().len()];
    let mut scene = Scene::resolve(&input).expect("the nominal scene is physical");
    let mut group = criterion.benchmark_group("sampling");
    group.throughput(Throughput::Elements(SAMPLES));
    group.bench_function("draws and mass properties", |bencher| {
        bencher.iter(|| {
            for sample in 0..SAMPLES {
                sampler.draw(SampleId(sample), &mut input, &mut applied);
                scene.resolve_into(black_box(&input)).expect("these samples are physical");
            }
        });
    });
    group.finish();
}

fn observation(criterion: &mut Criterion) {
    let plan = plan();
    let isa = Isa::best();
    let scene = Scene::resolve(&plan.nominal).expect("the nominal scene is physical");
    let com = Groups::NONE.with(Group::EnergiesCom);
    let mut group = criterion.benchmark_group("observation");
    group.throughput(Throughput::Elements(1));
    let numerics = Groups::NONE.with(Group::Numerics);
    for (name, groups) in [
        ("all", Group::DEFAULT.into_iter().collect()),
        ("energies_com and exchange", com.with(Group::Exchange)),
        ("energies_com", com),
        ("numerics", numerics),
    ] {
        let request = Request { groups, ..*Ensemble::new(&plan, isa).request() };
        let mut observer = Observer::new(request, &plan.grid);
        let mut row = vec![0.0; request.columns().len()];
        let mut engine = propagator(&plan, plan.grid.clone(), request.fields()).engine(isa);
        engine.propagate(std::slice::from_ref(&scene), &mut |CompletedRun { table, outcome, .. }| {
            group.bench_function(name, |bencher| {
                bencher.iter(|| observer.observe(isa, &scene, black_box(table), outcome, black_box(&mut row)));
            });
        });
    }
    group.finish();
}

fn writing(criterion: &mut Criterion) {
    let plan = plan();
    let campaign = Ensemble::new(&plan, Isa::best());
    let count = SAMPLES as usize;
    let mut rows = Rows::new(campaign.shape(), count);
    campaign.worker().run(Part { id: PartId(0), first: SampleId(0), count }, &mut rows, Supervision::progress(&|_| {}));
    let mut bytes = Vec::new();
    let mut group = criterion.benchmark_group("writing");
    group.throughput(Throughput::Elements(SAMPLES));
    for compression in Compression::ALL {
        let packed = Plan { compression, ..plan.clone() };
        let file = RowsFile::new(&Ensemble::new(&packed, Isa::best())).expect("names are unique");
        group.bench_function(format!("parquet, {}", compression.name()), |bencher| {
            bencher.iter(|| {
                bytes.clear();
                file.write(black_box(&rows), None, &mut bytes).expect("memory takes all");
            });
        });
        println!("{} bytes a row", bytes.len() / count);
    }
    group.finish();
}

fn campaign(criterion: &mut Criterion) {
    let plan = plan();
    let campaign = Ensemble::new(&plan, Isa::best());
    let dropped = |rows: &Rows| {
        black_box(rows.statuses());
        Ok::<(), Infallible>(())
    };
    let file = RowsFile::new(&campaign).expect("names are unique");
    let written = |rows: &Rows| file.write(rows, None, std::io::sink());
    let (parts, one) = (Parts::of(SAMPLES), NonZeroUsize::new(1));
    let mut group = criterion.benchmark_group("campaign");
    group.throughput(Throughput::Elements(SAMPLES));
    group.bench_function("rows dropped", |bencher| {
        bencher.iter(|| run(&campaign, parts, one, &dropped, Supervision::progress(&|_| {})).expect("nothing fails"));
    });
    group.bench_function("rows written", |bencher| {
        bencher.iter(|| run(&campaign, parts, one, &written, Supervision::progress(&|_| {})).expect("nothing fails"));
    });
    group.finish();
}

fn brief() -> Criterion {
    let (warm_up, measurement) = (std::time::Duration::from_millis(500), std::time::Duration::from_secs(2));
    Criterion::default().sample_size(20).warm_up_time(warm_up).measurement_time(measurement)
}

criterion_group! { name = benches; config = brief(); targets = sampling, observation, writing, campaign }
criterion_main!(benches);
