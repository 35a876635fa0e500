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
//! assert!(run.audit(&plan, Isa::best()).unwrap().state() < 1e-9);
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
/// use spindrift::{Observer, Overrides, Plan, Request};
///
/// let fewer = Overrides { samples: Some(10), ..Overrides::default() };
/// let plan = Plan::load("campaigns/no_debris.toml".as_ref(), fewer)?;
/// let request: Request = plan.request();
/// assert!(request.columns().iter().any(|column| column.quantity.name() == "energy_error_max"));
/// let observer = Observer::new(request, &plan.grid);
/// # let _ = observer;
/// # Ok::<(), spindrift::CampaignError>(())
/// ```
#[doc(inline)]
pub use campaign::Overrides;
/// A resolved campaign file.
#[doc(inline)]
pub use campaign::Plan;
/// ```
/// use spindrift::{Actuation, ActuationLaw, BodyState, WheelState, ZeroOrderHold};
/// let law = |_: f64, body: &BodyState, _: &WheelState| Actuation {
///     body_torque: body.omega_se_s.map(|rate| -rate),
///     ..Actuation::none(f64::INFINITY).with_thrust(&[5.0])
/// };
/// let (omega_se_s, q_es) = ([0.1, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0]); // q_es: scalar first
/// let body = BodyState { omega_se_s, q_es, r_co_e: [0.0; 3], v_co_e: [0.0; 3] };
/// let mut sampled = ZeroOrderHold::new(0.1, law); // asked at 0, 0.1, 0.2, ... s
/// let first = sampled.arc(0.0, &body, &WheelState::AT_REST);
/// assert_eq!((first.body_torque[0], first.thrust[0], first.until), (-0.1, 5.0, 0.1));
/// ```
#[doc(inline)]
pub use dynamics::actuation::ActuationLaw;
#[doc(inline)]
pub use dynamics::actuation::{Actuation, BodyState, WheelState, ZeroOrderHold};
/// A campaign in memory.
///
/// ```
/// use spindrift::{Ensemble, Isa, Overrides, Parts, Plan, Rows, run_ensemble, Supervision};
/// use std::convert::Infallible;
/// use std::sync::atomic::{AtomicUsize, Ordering};
///
/// let plan = Plan::load("campaigns/no_debris.toml".as_ref(), Overrides::default())?;
/// let ensemble = Ensemble::new(&plan, Isa::best());
/// let count = AtomicUsize::new(0);
/// let sink = |rows: &Rows| {
///     count.fetch_add(rows.samples().len(), Ordering::Relaxed);
///     Ok::<(), Infallible>(())
/// };
/// run_ensemble(&ensemble, Parts::of(20), None, &sink, Supervision::progress(&|_| ())).unwrap();
/// assert_eq!(count.into_inner(), 20);
/// # Ok::<(), spindrift::CampaignError>(())
/// ```
#[doc(inline)]
pub use ensemble::Ensemble;
/// Ranges of consecutive samples.
#[doc(inline)]
pub use ensemble::Parts;
/// The rows of a part.
#[doc(inline)]
pub use ensemble::Rows;
/// A sample exactly as a campaign runs it.
#[doc(inline)]
pub use ensemble::SingleRun;
/// Progress of runs, and how they are stopped.
#[doc(inline)]
pub use ensemble::Supervision;
#[doc(inline)]
pub use ensemble::run as run_ensemble;
/// ```
/// use spindrift::{Actuated, Actuation, BodyState, ControlLaw, LawContext, LawParameter, Limit, OwnLaw, WheelState};
/// static PUSH: [LawParameter; 1] =
///     [LawParameter::number("push_m_s2", "m/s^2", "Acceleration", Limit::Positive).or(&[0.01])];
/// let make = |context: &LawContext<'_>| {
///     let thrust = context.number("push_m_s2") * context.nominal.mass.total; // what flight software knows
///     move |_: f64, _: &BodyState, _: &WheelState| Actuation::none(f64::INFINITY).with_thrust(&[thrust])
/// };
/// let law = ControlLaw::new("push", Actuated { thrusters: true, ..Actuated::NONE }, &PUSH, make);
/// let law = OwnLaw::Loop(law); // for `Session::under`
/// # let _ = law;
/// ```
#[doc(inline)]
pub use loops::LawContext;
#[doc(inline)]
pub use loops::{ControlLaw, OwnLaw};
#[doc(inline)]
pub use math::Isa;
#[doc(inline)]
pub use observables::{Group, Observer, Request};
#[doc(inline)]
pub use ode::{Control, Tolerance};
#[doc(inline)]
pub use propagation::Engine;
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
/// A set of fields of the state.
#[doc(inline)]
pub use run::StateFields;
#[doc(inline)]
pub use run::{Grid, Quantity, StateField, StateTable, Status};
/// ```
/// use spindrift::{Noise, SampleId};
/// let mut noise = Noise::new(1, "gyro.x", SampleId(3));
/// let fifth = noise.normal(5);
/// assert_eq!(Noise::new(1, "gyro.x", SampleId(3)).normal(5), fifth);
/// ```
#[doc(inline)]
pub use sampling::Noise;
#[doc(inline)]
pub use sampling::SampleId;
/// ```
/// use spindrift::{Scene, SceneError, SceneInput};
/// let scene = SceneInput::report().with("initial.angular_velocity_rad_s", &[0.0, 0.1, 0.5]);
/// assert_eq!(Scene::resolve(&scene).unwrap().initial.omega_se_s, [0.0, 0.1, 0.5]);
/// let errors: Vec<SceneError> = Scene::resolve(&scene.with("wheels.w1.radius_m", &[-1.0])).unwrap_err();
/// assert_eq!(errors[0].key, "wheels.w1.radius_m");
/// ```
#[doc(inline)]
pub use scene::SceneInput;
#[doc(inline)]
pub use scene::schema::Limit;
#[doc(inline)]
pub use scene::{Actuated, LawParameter, Scene, SceneError};
/// A campaign file and the place of its result.
///
/// ```
/// use spindrift::{
///     Campaign, CampaignOutcome, Outputs, Quiet, Results, SampleId, Session, Verification, WorkflowError, verify,
/// };
///
/// let watch = Quiet::default();
/// let folder = std::env::temp_dir().join(format!("spindrift-doctest-{}", std::process::id()));
/// let session = Session::new(&watch)?;
/// let campaign = Campaign::from_file("campaigns/no_debris.toml", session).samples(50).store(&folder);
/// let without_page = Outputs { without_page: true, ..Outputs::default() };
/// // `results()` in place of `prepare()` runs and opens it
/// let Some(prepared) = campaign.outputs(without_page).prepare()? else { panic!("all samples are meant") };
/// assert!(matches!(prepared.run()?, CampaignOutcome::Finished(_)));
///
/// let results = Results::open(&folder, session)?;
/// assert_eq!(results.column("energy_error_max")?.len(), 50);
/// let (largest, verdicts) = (results.statistics()?, results.verdicts()?);
/// let worst: spindrift::SingleRun = results.replay(SampleId(7))?;
/// drop(results);
/// let all = Verification { fraction: 1.0, repair: false };
/// assert_eq!(verify(&session, &folder, all)?.unwrap().checked.problems, 0);
/// # let _ = (largest, verdicts, worst);
/// # std::fs::remove_dir_all(&folder).unwrap();
/// # Ok::<(), WorkflowError>(())
/// ```
#[doc(inline)]
pub use workflow::Campaign;
/// Means for all work on campaigns and results.
#[doc(inline)]
pub use workflow::Session;
#[doc(inline)]
pub use workflow::{CampaignOutcome, Outputs, Quiet, Results, Verification, Watch, WorkflowError, verify};
