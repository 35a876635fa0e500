//! A control loop: what a tick costs, law included.
//!
//! `cargo bench -p spindrift-benches --bench control`. One thread; 600 s at a control period of 0.1 s (6,000 ticks),
//! three wheels, feedback of the modified Rodrigues parameters: the spacecraft, wheels, gains and initial state of
//! Basilisk's `scenarioAttitudeFeedbackRW`, without its thruster, orbit and integral term; initial rates are dispersed.
//! Throughput is in runs per second.
//!
//! - `engine`: propagation alone, with attitude, rates and wheel rates at the points;
//! - `rows`: the campaign, all default columns, bands included.

#![allow(clippy::disallowed_methods)] // digits of no row: the elementary functions of the platform will do

use std::convert::Infallible;
use std::hint::black_box;
use std::num::NonZeroUsize;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use spindrift::campaign::{Overrides, Plan};
use spindrift::control::ControlLaw;
use spindrift::dynamics::actuation::{Actuation, ActuationLaw, BodyState, Laws, WheelState, ZeroOrderHold};
use spindrift::ensemble::settings::propagator;
use spindrift::ensemble::{Ensemble, Parts, Rows, Supervision, run};
use spindrift::loops::OwnLaw;
use spindrift::math::Isa;
use spindrift::run::{StateField, StateFields, Status};
use spindrift::sampling::SampleId;
use spindrift::scene::{Actuated, Scene};

/// The campaign.
const CAMPAIGN: &str = r#"
[campaign]
name = "control"
samples = 64
seed = 1
duration_s = 600.0

[observe]
points = 61

[integrator]
method = "auto"
tolerance = 1e-10

[body]
mass_kg = 750.0
center_of_mass_m = [0.0, 0.0, 0.0]
inertia_kg_m2 = [[900.0, 0.0, 0.0], [0.0, 800.0, 0.0], [0.0, 0.0, 600.0]]
includes_wheels = true

[[wheels]]
name = "w1"
axis = [1, 0, 0]
mass_kg = 9.0
axial_inertia_kg_m2 = 0.159
transverse_inertia_kg_m2 = 0.08

[[wheels]]
name = "w2"
axis = [0, 1, 0]
mass_kg = 9.0
axial_inertia_kg_m2 = 0.159
transverse_inertia_kg_m2 = 0.08

[[wheels]]
name = "w3"
axis = [0, 0, 1]
mass_kg = 9.0
axial_inertia_kg_m2 = 0.159
transverse_inertia_kg_m2 = 0.08

[initial]
attitude = [0.7543859649122807, 0.17543859649122806, 0.3508771929824561, -0.5263157894736842]
angular_velocity_rad_s = [0.001, -0.01, 0.03]

[[disperse]]
parameter = "initial.angular_velocity_rad_s"
distribution = "normal"
std = ["0.1 deg/s", "0.1 deg/s", "0.1 deg/s"]
"#;

/// u = -K sigma - P omega by motors along the axes of the body, so that the law costs little beside what asks it.
struct Feedback {
    stiffness: f64,
    damping: f64,
}

impl ActuationLaw for Feedback {
    fn arc(&mut self, _time: f64, body: &BodyState, _wheels: &WheelState) -> Actuation {
        let [w, ..] = body.q_es;
        let per = w.signum() / (1.0 + w.abs());
        let mut actuation = Actuation::none(f64::INFINITY);
        for i in 0..3 {
            actuation.motor_torque[i] = self.stiffness * per * body.q_es[i + 1] + self.damping * body.omega_se_s[i];
        }
        actuation
    }
}

/// The law, as a campaign flies it.
fn law() -> ControlLaw {
    let commands = Actuated { motors: true, ..Actuated::NONE };
    ControlLaw::new("mrp", commands, &[], |_| ZeroOrderHold::new(0.1, Feedback { stiffness: 3.5, damping: 30.0 }))
}

fn plan() -> Plan {
    let overrides = Overrides { law: Some(OwnLaw::Loop(law())), ..Overrides::default() };
    Plan::from_text("control.toml", CAMPAIGN, overrides).unwrap_or_else(|error| panic!("{error}"))
}

/// Drops the rows.
fn drain(rows: &Rows) -> Result<(), Infallible> {
    assert!(rows.statuses().iter().all(|status| *status == Status::Done));
    Ok(())
}

fn control(criterion: &mut Criterion) {
    let plan = plan();
    let isa = Isa::chosen().expect("the variable names a path");
    let (mut sampler, mut input) = (plan.dispersions.sampler(), plan.nominal.clone());
    let mut applied = vec![0.0; plan.dispersions.columns().len()];
    let mut draw = |sample| {
        sampler.draw(SampleId(sample), &mut input, &mut applied);
        Scene::resolve(&input).expect("these samples are physical")
    };
    let scenes: Vec<Scene> = (0..plan.samples).map(&mut draw).collect();
    let mut group = criterion.benchmark_group("control");
    group.throughput(Throughput::Elements(plan.samples));

    let fields = StateFields::NONE.with(StateField::Rate).with(StateField::Attitude).with(StateField::WheelRates);
    let mut engine = propagator(&plan, plan.grid.clone(), fields).engine(isa);
    group.bench_function("engine", |bencher| {
        bencher.iter(|| {
            let mut laws: Vec<_> =
                scenes.iter().map(|_| ZeroOrderHold::new(0.1, Feedback { stiffness: 3.5, damping: 30.0 })).collect();
            engine.propagate_under(Laws::Feedback(&mut laws), &scenes, &mut |run| {
                assert_eq!(run.outcome.status, Status::Done);
                black_box(run.table);
            });
        });
    });

    let campaign = Ensemble::new(&plan, isa);
    let (parts, one) = (Parts::of(plan.samples), NonZeroUsize::new(1));
    group.bench_function("rows", |bencher| {
        bencher.iter(|| run(&campaign, parts, one, &drain, Supervision::progress(&|_| {})).expect("nothing fails"));
    });
    group.finish();
}

fn brief() -> Criterion {
    let (warm_up, measurement) = (std::time::Duration::from_millis(500), std::time::Duration::from_secs(2));
    Criterion::default().sample_size(10).warm_up_time(warm_up).measurement_time(measurement)
}

criterion_group! { name = benches; config = brief(); targets = control }
criterion_main!(benches);
