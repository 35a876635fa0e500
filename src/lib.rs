//! spindrift: Monte Carlo analysis of spacecraft attitude dynamics.
//!
//! A campaign file becomes a [`Plan`]. The plan and a [`SampleId`] determine a [`Scene`]; an [`Engine`] integrates it
//! to a [`StateTable`], and [`observables`] reduce that to a row. **A row is a pure function of (plan, sample id)**:
//! threads, lanes, parts and order cannot change a bit of it.
//!
//! ```
//! use spindrift::{Isa, Overrides, Plan, SampleId, SingleRun, StateField, Status};
//!
//! let text = r#"
//!     campaign = { name = "doc", samples = 100, seed = 1, duration_s = 10.0 }
//!     integrator = { method = "auto", tolerance = 1e-10 }
//!     observe = { points = 11 }
//!     initial = { angular_velocity_rad_s = [0.0, 0.1, 0.5] }
//!
//!     [body]
//!     mass_kg = 500.0
//!     center_of_mass_m = [0.0, 0.0, 0.0]
//!     inertia_kg_m2 = [[120.0, -3.0, 1.0], [-3.0, 150.0, 2.0], [1.0, 2.0, 90.0]]
//!     includes_wheels = false
//!
//!     [[disperse]]
//!     parameter = "initial.angular_velocity_rad_s.x"
//!     distribution = "normal"
//!     std = 0.05
//! "#;
//! let plan = Plan::from_text("doc.toml", text, Overrides::default())?;
//!
//! // sample 17 exactly as a campaign runs it, with all states at the observation points
//! let run = SingleRun::new(&plan, SampleId(17), plan.grid.clone(), Isa::best()).expect("the sample is physical");
//! assert_eq!(run.outcome.status, Status::Done);
//! let omega_se_s: [f64; 3] = run.table.at(StateField::Rate, 10); // rad/s, after 10 s
//! assert!(omega_se_s.iter().all(|component| component.is_finite()));
//! # Ok::<(), spindrift::CampaignError>(())
//! ```
//!
//! A stored campaign is a [`Campaign`], and what it has made are [`Results`]. The names on this page are the interface;
//! modules are its inside, which may change. The programs in `examples/` show campaigns in memory and on disk, and
//! control laws. `ARCHITECTURE.md` shows the data flow, the layers and a glossary, `docs/model.md` the equations.

#![forbid(unsafe_code)]
// failures are values; a printing macro panics where the pipe is closed
#![warn(clippy::unwrap_used, clippy::print_stdout)]
#![cfg_attr(test, allow(clippy::disallowed_methods))]

#[doc(hidden)]
pub mod cli;
#[doc(hidden)]
pub mod workflow;

#[doc(hidden)]
pub use spindrift_control::control;
#[doc(hidden)]
pub use spindrift_ensemble::{analysis, ensemble, storage, table};
#[doc(hidden)]
pub use spindrift_kernels::{dynamics, math, observables, ode, propagation, run, scene, statistics};
#[doc(hidden)]
pub use spindrift_plan::{loops, sampling};
#[doc(hidden)]
pub use spindrift_report::{findings, report};

/// Campaign files, whose loops [`control`] reads.
#[doc(hidden)]
pub mod campaign {
    pub use spindrift_control::control::tables::Overrides;
    pub use spindrift_plan::campaign::*;
}

/// ```
/// use spindrift::{CampaignError, Overrides, Plan};
/// let wrong: CampaignError = Plan::from_text("a.toml", "[campaign]", Overrides::default()).unwrap_err();
/// assert!(wrong.to_string().contains("campaign.seed"));
/// ```
#[doc(inline)]
pub use campaign::CampaignError;
/// ```
/// use spindrift::{Overrides, Plan};
///
/// let plan = Plan::load("campaigns/no_debris.toml".as_ref(), Overrides::default())?;
/// let fewer = Overrides { samples: Some(10), ..Overrides::default() };
/// assert_eq!(Plan::load("campaigns/no_debris.toml".as_ref(), fewer)?.samples, 10);
/// # Ok::<(), spindrift::CampaignError>(())
/// ```
#[doc(inline)]
pub use campaign::Overrides;
/// ```
/// use spindrift::{Overrides, Plan};
///
/// let plan = Plan::load("campaigns/no_debris.toml".as_ref(), Overrides::default())?;
/// assert_eq!(plan.name, "no_debris");
/// # Ok::<(), spindrift::CampaignError>(())
/// ```
#[doc(inline)]
pub use campaign::Plan;
/// ```
/// use spindrift::Actuation;
/// let push = Actuation::none(2.0).with_thrust(&[5.0]); // until 2 s
/// assert_eq!(push.thrust[0], 5.0);
/// ```
#[doc(inline)]
pub use dynamics::actuation::Actuation;
/// ```
/// use spindrift::{Actuation, ActuationLaw, BodyState, WheelState};
/// let mut law = |_: f64, body: &BodyState, _: &WheelState| Actuation {
///     body_torque: body.omega_se_s.map(|rate| -rate),
///     ..Actuation::none(f64::INFINITY)
/// };
/// let (omega_se_s, q_es) = ([0.1, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0]);
/// let body = BodyState { omega_se_s, q_es, r_co_e: [0.0; 3], v_co_e: [0.0; 3] };
/// assert_eq!(law.arc(0.0, &body, &WheelState::AT_REST).body_torque[0], -0.1);
/// ```
#[doc(inline)]
pub use dynamics::actuation::ActuationLaw;
/// ```
/// use spindrift::BodyState;
/// let body = BodyState { omega_se_s: [0.0; 3], q_es: [1.0, 0.0, 0.0, 0.0], r_co_e: [0.0; 3], v_co_e: [0.0; 3] };
/// assert_eq!(body.q_es[0], 1.0); // scalar first
/// ```
#[doc(inline)]
pub use dynamics::actuation::BodyState;
/// ```
/// use spindrift::WheelState;
/// assert_eq!(WheelState::AT_REST.rates[0], 0.0);
/// ```
#[doc(inline)]
pub use dynamics::actuation::WheelState;
/// ```
/// use spindrift::{Actuation, BodyState, WheelState, ZeroOrderHold};
/// let idle = |_: f64, _: &BodyState, _: &WheelState| Actuation::none(f64::INFINITY);
/// let sampled = ZeroOrderHold::new(0.1, idle); // asked at 0, 0.1, 0.2, ... s
/// # let _ = sampled;
/// ```
#[doc(inline)]
pub use dynamics::actuation::ZeroOrderHold;
/// ```
/// use spindrift::{Ensemble, Isa, Overrides, Plan};
///
/// let plan = Plan::load("campaigns/no_debris.toml".as_ref(), Overrides::default())?;
/// let ensemble = Ensemble::new(&plan, Isa::best());
/// assert_eq!(ensemble.shape().parameters, plan.dispersions.columns().len());
/// # Ok::<(), spindrift::CampaignError>(())
/// ```
#[doc(inline)]
pub use ensemble::Ensemble;
/// ```
/// use spindrift::Parts;
/// assert_eq!(Parts::of(300).iter().map(|part| part.count).sum::<usize>(), 300);
/// ```
#[doc(inline)]
pub use ensemble::Parts;
/// ```
/// use spindrift::{Ensemble, Isa, Overrides, Plan, Rows};
///
/// let plan = Plan::load("campaigns/no_debris.toml".as_ref(), Overrides::default())?;
/// let rows: Rows = Ensemble::new(&plan, Isa::best()).rows(16);
/// assert!(rows.samples().is_empty());
/// # Ok::<(), spindrift::CampaignError>(())
/// ```
#[doc(inline)]
pub use ensemble::Rows;
/// ```
/// use spindrift::{Isa, Overrides, Plan, SampleId, SingleRun};
///
/// let plan = Plan::load("campaigns/no_debris.toml".as_ref(), Overrides::default())?;
/// let run = SingleRun::new(&plan, SampleId(3), plan.grid.clone(), Isa::best()).unwrap();
/// assert!(run.audit(&plan, Isa::best()).unwrap().state() < 1e-9);
/// # Ok::<(), spindrift::CampaignError>(())
/// ```
#[doc(inline)]
pub use ensemble::SingleRun;
/// ```
/// use spindrift::Supervision;
/// let supervision = Supervision::progress(&|samples| println!("{samples} more"));
/// assert!(!supervision.stop.load(std::sync::atomic::Ordering::Relaxed));
/// ```
#[doc(inline)]
pub use ensemble::Supervision;
/// ```
/// use spindrift::{Ensemble, Isa, Overrides, Parts, Plan, Rows, run_ensemble, Supervision};
/// use std::convert::Infallible;
/// use std::sync::atomic::{AtomicUsize, Ordering};
///
/// let plan = Plan::load("campaigns/no_debris.toml".as_ref(), Overrides::default())?;
/// let count = AtomicUsize::new(0);
/// let sink = |rows: &Rows| {
///     count.fetch_add(rows.samples().len(), Ordering::Relaxed);
///     Ok::<(), Infallible>(())
/// };
/// let quiet = Supervision::progress(&|_| ());
/// run_ensemble(&Ensemble::new(&plan, Isa::best()), Parts::of(20), None, &sink, quiet).unwrap();
/// assert_eq!(count.into_inner(), 20);
/// # Ok::<(), spindrift::CampaignError>(())
/// ```
#[doc(inline)]
pub use ensemble::run as run_ensemble;
#[doc(inline)]
pub use loops::ControlLaw;
/// ```
/// use spindrift::{Actuated, Actuation, BodyState, ControlLaw, LawContext, WheelState};
/// let make = |context: &LawContext<'_>| {
///     let mass = context.nominal.mass.total; // what flight software knows
///     move |_: f64, _: &BodyState, _: &WheelState| Actuation::none(f64::INFINITY).with_thrust(&[0.01 * mass])
/// };
/// let law = ControlLaw::new("push", Actuated { thrusters: true, ..Actuated::NONE }, &[], make);
/// assert!(law.parameters.is_empty());
/// ```
#[doc(inline)]
pub use loops::LawContext;
/// ```
/// use spindrift::Isa;
/// assert!(Isa::available().iter().any(|isa| isa.name() == Isa::best().name()));
/// ```
#[doc(inline)]
pub use math::Isa;
/// ```
/// use spindrift::Group;
/// assert!(Group::ALL.iter().any(|group| group.name() == "exchange"));
/// ```
#[doc(inline)]
pub use observables::Group;
/// ```
/// use spindrift::{Observer, Overrides, Plan};
///
/// let plan = Plan::load("campaigns/no_debris.toml".as_ref(), Overrides::default())?;
/// let observer = Observer::new(plan.request(), &plan.grid);
/// # let _ = observer;
/// # Ok::<(), spindrift::CampaignError>(())
/// ```
#[doc(inline)]
pub use observables::Observer;
/// ```
/// use spindrift::{Overrides, Plan, Request};
///
/// let plan = Plan::load("campaigns/no_debris.toml".as_ref(), Overrides::default())?;
/// let request: Request = plan.request();
/// assert!(request.columns().iter().any(|column| column.quantity.name() == "energy_error_max"));
/// # Ok::<(), spindrift::CampaignError>(())
/// ```
#[doc(inline)]
pub use observables::Request;
/// ```
/// use spindrift::{Control, Tolerance};
/// let tolerance = Tolerance { relative: 1e-12, absolute: 1e-12 };
/// let control = Control { tolerance, step: None, max_steps: 100_000 };
/// # let _ = control;
/// ```
#[doc(inline)]
pub use ode::Control;
/// ```
/// use spindrift::Tolerance;
/// let tolerance = Tolerance { relative: 1e-12, absolute: 1e-12 };
/// # let _ = tolerance;
/// ```
#[doc(inline)]
pub use ode::Tolerance;
/// ```
/// use spindrift::{Engine, Ensemble, Isa, Overrides, Plan};
///
/// let plan = Plan::load("campaigns/no_debris.toml".as_ref(), Overrides::default())?;
/// let engine: Box<dyn Engine> = Ensemble::new(&plan, Isa::best()).propagator().engine(Isa::best());
/// # let _ = engine;
/// # Ok::<(), spindrift::CampaignError>(())
/// ```
#[doc(inline)]
pub use propagation::Engine;
/// ```
/// use spindrift::PropagationMethod;
/// assert_eq!(PropagationMethod::from_name("taylor"), Some(PropagationMethod::Taylor));
/// ```
#[doc(inline)]
pub use propagation::Method as PropagationMethod;
/// ```
/// use spindrift::{
///     Control, Grid, Isa, PropagationMethod, PropagationSettings, Scene, SceneInput, StateField, StateFields, Status,
///     Tolerance,
/// };
/// let scene = Scene::resolve(&SceneInput::report()).unwrap();
/// let tolerance = Tolerance { relative: 1e-12, absolute: 1e-12 };
/// let control = Control { tolerance, step: None, max_steps: 100_000 };
/// let fields = StateFields::NONE.with(StateField::Rate);
/// let settings = PropagationSettings::new(PropagationMethod::Auto, control, Grid::uniform(1.0, 2), fields, &scene);
/// settings.engine(Isa::best()).propagate(&[scene], &mut |run| assert_eq!(run.outcome.status, Status::Done));
/// ```
#[doc(inline)]
pub use propagation::PropagationSettings;
/// ```
/// use spindrift::Grid;
/// assert_eq!(Grid::uniform(10.0, 3).times(), [0.0, 5.0, 10.0]);
/// ```
#[doc(inline)]
pub use run::Grid;
/// ```
/// use spindrift::Quantity;
/// let rate = Quantity::new("rate_rad_s", "rad/s", "A rate.");
/// assert_eq!(rate.unit(), "rad/s");
/// ```
#[doc(inline)]
pub use run::Quantity;
/// ```
/// use spindrift::{StateField, StateFields};
/// assert!(StateFields::NONE.with(StateField::Rate).contains(StateField::Rate));
/// ```
#[doc(inline)]
pub use run::StateField;
/// ```
/// use spindrift::{StateField, StateFields};
/// assert!(!StateFields::NONE.contains(StateField::Rate));
/// ```
#[doc(inline)]
pub use run::StateFields;
/// ```
/// use spindrift::{Isa, Overrides, Plan, SampleId, SingleRun, StateTable};
///
/// let plan = Plan::load("campaigns/no_debris.toml".as_ref(), Overrides::default())?;
/// let run = SingleRun::new(&plan, SampleId(0), plan.grid.clone(), Isa::best()).unwrap();
/// let table: &StateTable = &run.table;
/// assert_eq!(table.points(), plan.grid.points());
/// # Ok::<(), spindrift::CampaignError>(())
/// ```
#[doc(inline)]
pub use run::StateTable;
/// ```
/// use spindrift::Status;
/// assert_eq!(Status::Done.name(), "ok");
/// ```
#[doc(inline)]
pub use run::Status;
/// ```
/// use spindrift::{Noise, SampleId};
/// let mut noise = Noise::new(1, "gyro.x", SampleId(3));
/// let fifth = noise.normal(5);
/// assert_eq!(Noise::new(1, "gyro.x", SampleId(3)).normal(5), fifth);
/// ```
#[doc(inline)]
pub use sampling::Noise;
/// ```
/// use spindrift::SampleId;
/// assert!(SampleId(0) < SampleId(1)); // 0 is the nominal scene
/// ```
#[doc(inline)]
pub use sampling::SampleId;
/// ```
/// use spindrift::Actuated;
/// assert!(!Actuated::NONE.any() && Actuated::ALL.thrusters);
/// ```
#[doc(inline)]
pub use scene::Actuated;
/// ```
/// use spindrift::{LawParameter, Limit};
/// static GAIN: LawParameter = LawParameter::number("gain_n_m", "N m", "Gain", Limit::Positive).or(&[2.0]);
/// assert_eq!(GAIN.default, Some(&[2.0][..]));
/// ```
#[doc(inline)]
pub use scene::LawParameter;
/// ```
/// use spindrift::{Scene, SceneInput};
/// let scene = Scene::resolve(&SceneInput::report()).unwrap();
/// assert_eq!(scene.mass.wheels.len(), 2);
/// ```
#[doc(inline)]
pub use scene::Scene;
/// ```
/// use spindrift::{Scene, SceneError, SceneInput};
/// let wrong = SceneInput::report().with("wheels.w1.radius_m", &[-1.0]);
/// let errors: Vec<SceneError> = Scene::resolve(&wrong).unwrap_err();
/// assert_eq!(errors[0].key, "wheels.w1.radius_m");
/// ```
#[doc(inline)]
pub use scene::SceneError;
/// ```
/// use spindrift::{Scene, SceneInput};
/// let scene = SceneInput::report().with("initial.angular_velocity_rad_s", &[0.0, 0.1, 0.5]);
/// assert_eq!(Scene::resolve(&scene).unwrap().initial.omega_se_s, [0.0, 0.1, 0.5]);
/// ```
#[doc(inline)]
pub use scene::SceneInput;
/// ```
/// use spindrift::Limit;
/// assert_eq!(Limit::Positive.words(), "above zero");
/// ```
#[doc(inline)]
pub use scene::schema::Limit;
/// ```
/// use spindrift::{
///     Campaign, CampaignOutcome, Outputs, Quiet, Results, SampleId, Session, Verification, WorkflowError, verify,
/// };
///
/// let watch = Quiet::default();
/// let folder = std::env::temp_dir().join(format!("spindrift-doctest-{}", std::process::id()));
/// let session = Session::new(&watch)?;
/// let campaign = Campaign::from_file("campaigns/no_debris.toml", session).samples(50).store(&folder);
/// let Some(prepared) = campaign.prepare()? else { panic!("all samples are meant") };
/// assert!(matches!(prepared.run()?, CampaignOutcome::Finished(_)));
///
/// let results = Results::open(&folder, session)?;
/// assert_eq!(results.column("energy_error_max")?.len(), 50);
/// let largest = results.statistics()?;
/// let worst: spindrift::SingleRun = results.replay(SampleId(7))?;
/// drop(results);
/// let all = Verification { fraction: 1.0, repair: false };
/// assert_eq!(verify(&session, &folder, all)?.unwrap().checked.problems, 0);
/// # let _ = (largest, worst, Outputs::default());
/// # std::fs::remove_dir_all(&folder).unwrap();
/// # Ok::<(), WorkflowError>(())
/// ```
#[doc(inline)]
pub use workflow::Campaign;
#[doc(inline)]
pub use workflow::CampaignOutcome;
/// ```
/// use spindrift::Outputs;
/// let rows_and_tables_only = Outputs { without_page: true, ..Outputs::default() };
/// assert!(rows_and_tables_only.junit.is_none());
/// ```
#[doc(inline)]
pub use workflow::Outputs;
#[doc(inline)]
pub use workflow::Quiet;
#[doc(inline)]
pub use workflow::Results;
/// ```
/// use spindrift::{Quiet, Session};
/// let watch = Quiet::default();
/// let session = Session::new(&watch).unwrap();
/// assert!(session.law.is_none());
/// ```
#[doc(inline)]
pub use workflow::Session;
/// ```
/// use spindrift::Verification;
/// let all = Verification { fraction: 1.0, repair: false };
/// # let _ = all;
/// ```
#[doc(inline)]
pub use workflow::Verification;
/// ```
/// use spindrift::{Quiet, Watch};
/// assert!(!Quiet::default().stop().load(std::sync::atomic::Ordering::Relaxed));
/// ```
#[doc(inline)]
pub use workflow::Watch;
#[doc(inline)]
pub use workflow::WorkflowError;
#[doc(inline)]
pub use workflow::verify;
