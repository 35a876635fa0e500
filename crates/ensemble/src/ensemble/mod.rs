//! Layer 6: many runs on all cores. A row is a pure function of (plan, sample).
//!
//! A [`Worker`] flies the samples of a part into [`Rows`]; [`run`] gives parts to threads. [`SingleRun`]
//! is one run with its states.

pub mod audit;
pub mod bands;
mod batch;
mod crossing;
mod deviation_window;
pub mod drawn;
pub mod event_finder;
mod extreme_finder;
pub mod failure_reasons;
pub mod flights;
pub mod influence;
mod lookup;
pub mod loop_errors;
pub mod parts;
mod peak;
pub mod percentiles;
pub mod pilots;
pub mod plausibility;
pub mod precision;
pub mod probe;
pub mod replays;
pub mod rows;
pub mod run_cost;
pub mod runner;
pub mod settings;
mod sightings;
pub mod single;
pub mod supervision;
mod surface;
pub mod surroundings;
pub(crate) mod threads;
pub mod undefined;
pub mod worker;

pub use audit::{Audit, Auditor, NoAudit};
pub use bands::{BandLayout, Bands, PartBands, RunsOfColumn};
pub use drawn::DrawnScenes;
pub use failure_reasons::{FailureReason, FailureReasons};
pub use parts::{Part, PartId, Parts};
pub use percentiles::Percentiles;
pub use rows::{Rows, Shape};
pub use runner::{RunError, run};
pub use settings::EngineMaker;
pub use single::SingleRun;
pub use supervision::Supervision;
pub use worker::{Ensemble, Worker};
