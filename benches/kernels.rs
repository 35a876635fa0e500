//! The parts of a run: right-hand sides, steps, runs.
//!
//! `cargo bench -p spindrift-benches --bench kernels` (all), the same with ` -- run` (one group). One thread.
//! Throughput is in evaluations, steps or runs per second.
//!
//! - `right-hand side`: a chain of evaluations, each from the previous one as in an integration; the gyrostat with
//!   attitude and wheel angles, in lanes (eight runs at once) and one at a time, and the null-space kernel (62 states
//!   and 10 integrals).
//! - `step`: a whole run without observation points, divided by its accepted steps.
//! - `peak`: fused operations alone, sixteen independent chains, in flop/s: the maximum of one core on each instruction
//!   set.
//! - `taylor`: the arithmetic of Taylor steps alone (rate and attitude, free of torque), in flop/s, on each instruction
//!   set and for several tolerances, to compare with the peak.
//! - `run`: 128 samples of `campaigns/no_debris.toml` (`spin_sweep` without the debris: 10 s, 101 points), with all
//!   that its rows need.
//!
//! Through [`Engine`]s, which the library has compiled already: a driver instantiated in the bench would take minutes
//! to build.

#![allow(clippy::disallowed_methods)] // digits of no row: the elementary functions of the platform will do

use std::hint::black_box;
use std::path::Path;

use criterion::measurement::WallTime;
use criterion::{BenchmarkGroup, Criterion, Throughput, criterion_group, criterion_main};
use fearless_simd::Simd;
use spindrift::campaign::{Overrides, Plan};
use spindrift::dynamics::effects::within_arcs::Beside;
use spindrift::dynamics::gyrostat::equations::Constants;
use spindrift::dynamics::gyrostat::{ATTITUDE, Gyrostat, OMEGA, WITH_ANGLES};
use spindrift::dynamics::null_space::{Kernel, components, sigma};
use spindrift::ensemble::Ensemble;
use spindrift::ensemble::worker::BATCH;
use spindrift::math::isa::Work;
use spindrift::math::lanes::WIDTH;
use spindrift::math::{Isa, Lanes, Real};
use spindrift::ode::Control;
use spindrift::ode::Integrator;
use spindrift::ode::Tolerance;
use spindrift::propagation::CompletedRun;
use spindrift::propagation::Engine;
use spindrift::propagation::Method;
use spindrift::propagation::PropagationSettings;
use spindrift::propagation::taylor::step::StepRule;
use spindrift::run::{Grid, StateField, StateFields};
use spindrift::sampling::SampleId;
use spindrift::scene::Scene;

/// Evaluations per measurement of a right-hand side.
const EVALUATIONS: usize = 1000;

/// Length of the chain's steps, s: so short that the state remains realistic.
const MOMENT: f64 = 1e-9;

/// Methods with their tolerance (or, for a fixed step, the step in s). At 1e-16 `auto` is as accurate as f64 allows.
const METHODS: [(Method, f64); 8] = [
    (Method::Auto, 1e-10),
    (Method::Auto, 1e-16),
    (Method::Taylor, 1e-10),
    (Method::Gyrostat(Integrator::DormandPrince), 1e-8),
    (Method::Gyrostat(Integrator::Dop853), 1e-10),
    (Method::Gyrostat(Integrator::RungeKutta4), 1e-3),
    (Method::Gyrostat(Integrator::GaussLegendre), 1e-2),
    (Method::NullSpace, 1e-8),
];

/// The plan of a shipped campaign.
fn plan(name: &str) -> Plan {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../campaigns").join(name);
    Plan::load(&path, Overrides::default()).expect("a shipped campaign is valid")
}

/// The scenes of the first samples of `plan`.
fn scenes(plan: &Plan, count: usize) -> Vec<Scene> {
    let (mut sampler, mut input) = (plan.dispersions.sampler(), plan.nominal.clone());
    let mut applied = vec![0.0; plan.dispersions.columns().len()];
    let mut scene = |sample| {
        sampler.draw(SampleId(sample), &mut input, &mut applied);
        Scene::resolve(&input).expect("these samples are physical")
    };
    (0..count as u64).map(&mut scene).collect()
}

/// A chain of evaluations of the null-space kernel.
struct NullSpaceChain<'a> {
    kernel: &'a Kernel<2>,
    state: [f64; components(2)],
}

impl Work for NullSpaceChain<'_> {
    type Output = [f64; components(2)];

    #[inline(always)]
    fn run<S: Simd>(self, _simd: S) -> [f64; components(2)] {
        let mut x = self.state;
        for _ in 0..EVALUATIONS {
            let rate = self.kernel.derivative(&x);
            for (x, f) in x.iter_mut().zip(rate) {
                *x = f.mul_add(MOMENT, *x);
            }
        }
        x
    }
}

/// A chain of evaluations of the gyrostat, in lanes or one at a time.
struct Lanewise<'a> {
    run: &'a Gyrostat<f64>,
    lanes: bool,
}

impl Work for Lanewise<'_> {
    type Output = f64;

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) -> f64 {
        if self.lanes { chain(Lanes::broadcast(simd, 0.0), self.run) } else { chain(0.0, self.run) }
    }
}

/// The chain; `zero` says in how many lanes.
#[inline(always)]
fn chain<R: Real>(zero: R, run: &Gyrostat<f64>) -> f64 {
    let mut constants = Constants::zero(zero);
    let mut y = [zero; WITH_ANGLES];
    for lane in 0..R::LANES {
        constants.set_run(lane, run, 1.0);
        constants.set_arc(lane, run, 0, 1.0);
        for i in 0..3 {
            y[OMEGA + i].set_lane(lane, run.omega_b[i]);
        }
        for i in 0..4 {
            y[ATTITUDE + i].set_lane(lane, run.q_eb[i]);
        }
    }
    let moment = zero.splat(MOMENT);
    for _ in 0..EVALUATIONS {
        let rate = constants.derivative(zero, &y, &Beside { torque: [zero; 3], force: None, carrier: None });
        for i in 0..WITH_ANGLES {
            y[i] = rate[i].mul_add(moment, y[i]);
        }
    }
    (0..WITH_ANGLES).map(|i| y[i].lane(0)).sum()
}

fn right_hand_side(criterion: &mut Criterion) {
    let spin_sweep = plan("spin_sweep.toml");
    let scene = Scene::resolve(&spin_sweep.nominal).expect("Berdoz's scene is physical");
    let kernel = Kernel::<2>::new(&scene);
    let gyrostat = Gyrostat::new(0.0, &scene, 10.0);
    let mut group = criterion.benchmark_group("right-hand side");
    for isa in Isa::available() {
        for (name, lanes) in [("gyrostat, 8 lanes", true), ("gyrostat, scalar", false)] {
            group.throughput(Throughput::Elements(EVALUATIONS as u64 * if lanes { 8 } else { 1 }));
            group.bench_function(format!("{name}/{}", isa.name()), |bencher| {
                bencher.iter(|| isa.run(Lanewise { run: black_box(&gyrostat), lanes }));
            });
        }
        group.throughput(Throughput::Elements(EVALUATIONS as u64));
        group.bench_function(format!("reference/{}", isa.name()), |bencher| {
            let state = sigma::<2>(&scene).components();
            bencher.iter(|| black_box(isa.run(NullSpaceChain { kernel: &kernel, state: black_box(state) })));
        });
    }
    group.finish();
}

/// The engine of a method for the grid and blocks.
fn engine(
    isa: Isa,
    (method, setting): (Method, f64),
    grid: Grid,
    blocks: StateFields,
    scene: &Scene,
) -> Box<dyn Engine> {
    let fixed = method.has_fixed_step();
    let relative = if fixed { 1e-10 } else { setting };
    let tolerance = Tolerance { relative, absolute: relative };
    let control = Control { tolerance, step: fixed.then_some(setting), max_steps: 10_000_000 };
    PropagationSettings::new(method, control, grid, blocks, scene).engine(isa)
}

/// Accepted steps of all runs together.
fn steps(engine: &mut dyn Engine, scenes: &[Scene]) -> u64 {
    let mut steps = 0;
    engine.propagate(scenes, &mut |run| steps += run.outcome.effort.steps);
    steps
}

fn measure(group: &mut BenchmarkGroup<'_, WallTime>, name: String, engine: &mut dyn Engine, scenes: &[Scene]) {
    group.bench_function(name, |bencher| {
        bencher.iter(|| {
            engine.propagate(scenes, &mut |CompletedRun { table, .. }| {
                black_box(table.column(StateField::Rate, 0));
            });
        });
    });
}

/// The slow kernel makes fewer runs per measurement.
fn of(scenes: &[Scene], method: Method) -> &[Scene] {
    if method == Method::NullSpace { &scenes[..4] } else { scenes }
}

fn name((method, setting): (Method, f64)) -> String {
    format!("{}, {} {setting:e}", method.name(), if method.has_fixed_step() { "step" } else { "tolerance" })
}

fn step(criterion: &mut Criterion) {
    let plan = plan("no_debris.toml");
    let scenes = scenes(&plan, BATCH);
    let isa = Isa::best();
    let mut group = criterion.benchmark_group("step");
    // where `auto` finds a period it does not step through the run
    for method in METHODS.into_iter().filter(|(method, _)| *method != Method::Auto) {
        let blocks = StateFields::NONE.with(StateField::Rate).with(StateField::Attitude);
        let mut engine = engine(isa, method, Grid::uniform(plan.grid.duration(), 2), blocks, &scenes[0]);
        let scenes = of(&scenes, method.0);
        group.throughput(Throughput::Elements(steps(&mut *engine, scenes)));
        measure(&mut group, name(method), &mut *engine, scenes);
    }
    group.finish();
}

fn run(criterion: &mut Criterion) {
    let plan = plan("no_debris.toml");
    let isa = Isa::best();
    let blocks = Ensemble::new(&plan, isa).request().fields();
    let scenes = scenes(&plan, BATCH);
    let mut group = criterion.benchmark_group("run");
    for method in METHODS {
        let mut engine = engine(isa, method, plan.grid.clone(), blocks, &scenes[0]);
        let scenes = of(&scenes, method.0);
        group.throughput(Throughput::Elements(scenes.len() as u64));
        measure(&mut group, name(method), &mut *engine, scenes);
    }
    group.finish();
}

/// Fused operations of one chain per measurement.
const CHAIN: usize = 1000;

/// Independent chains: two units times a latency of four, twice.
const CHAINS: usize = 16;

/// Independent chains of fused operations and nothing else.
struct Peak(f64);

impl Work for Peak {
    type Output = f64;

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) -> f64 {
        let (a, b) = (Lanes::broadcast(simd, self.0), Lanes::broadcast(simd, 1.0 - self.0));
        let mut sums = [b; CHAINS];
        for _ in 0..CHAIN {
            for sum in &mut sums {
                *sum = sum.mul_add(a, b);
            }
        }
        let mut all = sums[0];
        for sum in &sums[1..] {
            all += *sum;
        }
        all.lane(0)
    }
}

fn peak(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("peak");
    for isa in Isa::available() {
        group.throughput(Throughput::Elements((2 * CHAIN * CHAINS * WIDTH) as u64));
        group.bench_function(isa.name(), |bencher| bencher.iter(|| isa.run(Peak(black_box(0.5)))));
    }
    group.finish();
}

/// Floating-point operations of one step of one run of rate and attitude by a series of order `p`; a fused one counts
/// two.
///
/// Cauchy products: fifteen fused operations for each pair of coefficients. For each order: h x omega (9), the rate
/// (9), its division by the order (3), that of the attitude (4). Then the value at the end of the step, two for each
/// coefficient, and the step size, less than a hundred, which is omitted.
fn flops_of_step(p: u64) -> u64 {
    2 * 15 * p * (p + 1) / 2 + p * (9 + 9 + 3 + 4) + 2 * 7 * p
}

fn taylor(criterion: &mut Criterion) {
    let plan = plan("no_debris.toml");
    let scenes = scenes(&plan, BATCH);
    let blocks = StateFields::NONE.with(StateField::Rate).with(StateField::Attitude);
    let mut group = criterion.benchmark_group("taylor");
    for isa in Isa::available() {
        for tolerance in [1e-6, 1e-10, 1e-13, 1e-16] {
            let grid = Grid::uniform(plan.grid.duration(), 2);
            let mut engine = engine(isa, (Method::Taylor, tolerance), grid, blocks, &scenes[0]);
            let order = StepRule::in_f64(tolerance).order as u64;
            group.throughput(Throughput::Elements(steps(&mut *engine, &scenes) * flops_of_step(order)));
            measure(&mut group, format!("{}/{tolerance:e}", isa.name()), &mut *engine, &scenes);
        }
    }
    group.finish();
}

fn brief() -> Criterion {
    let (warm_up, measurement) = (std::time::Duration::from_millis(500), std::time::Duration::from_secs(2));
    Criterion::default().sample_size(20).warm_up_time(warm_up).measurement_time(measurement)
}

criterion_group! { name = benches; config = brief(); targets = right_hand_side, step, run, peak, taylor }
criterion_main!(benches);
