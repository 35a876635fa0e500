//! spindrift: Monte Carlo analysis of spacecraft attitude dynamics.
//!
//! A campaign file becomes a [`campaign::Plan`]. The plan and a [`sampling::SampleId`] determine a [`scene::Scene`]; an
//! [`propagation::Engine`] integrates it to a [`run::StateTable`], and [`observables`] reduce that to a row. **A row is a pure function of
//! (plan, sample id)**: threads, lanes, parts and order cannot change a bit of it.
//!
//! ```
//! use spindrift::campaign::{Overrides, Plan};
//! use spindrift::ensemble::SingleRun;
//! use spindrift::math::Isa;
//! use spindrift::run::{StateField, Status};
//! use spindrift::sampling::SampleId;
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
//! # Ok::<(), spindrift::campaign::CampaignError>(())
//! ```
//!
//! The programs in `examples/` show a campaign in memory and a control law. A module imports only from layers below its own; `ARCHITECTURE.md`
//! shows the data flow, the layers and a glossary, `docs/model.md` the equations.

#![forbid(unsafe_code)]
#![warn(clippy::unwrap_used, clippy::print_stdout)] // failures are values; a printing macro panics where the pipe is closed
#![cfg_attr(test, allow(clippy::disallowed_methods))]

pub mod analysis;
pub mod campaign;
pub mod cli;
pub mod control;
pub mod ensemble;
pub mod report;
pub mod sampling;
pub mod storage;
pub mod workflow;

#[doc(inline)]
pub use spindrift_kernels::{dynamics, math, observables, ode, propagation, run, scene, statistics};
