//! Layer 6: many runs on all cores. A row is a pure function of (plan, sample).
//!
//! - [`mod@parts`]: how samples are divided into parts; [`run_cost`]: their size.
//! - [`rows`]: the rows of a part.
//! - [`Sink`]: takes the rows.
//! - [`worker`]: [`Ensemble`], shared by all threads, and [`Worker`], the memory of one thread; `batch`: scenes that it
//!   runs together.
//! - [`runner`]: distributes parts to threads; [`supervision`]: what it is told.
//! - [`drawn`]: sampled parameters without runs; [`percentiles`]: theirs.
//! - [`bands`]: quantiles over time, counted run by run (in `deviation_window`).
//! - [`influence`]: which of them change no requested column. [`plausibility`]: numbers that look like a mistake.
//!   [`magnitude`]: lengths and angles.
//! - [`single`]: one run with its states. [`flights`]: runs under the control law of the plan; `surface`: when they
//!   reach the central body.
//! - [`event_finder`]: when quantities cross values: seen in `sightings`, located in `crossing`, by values at other
//!   times (`lookup`); `extreme_finder`: their largest values, located in `peak`.
//! - [`run_end`]: the event that ends a run, found in `end_finder`.
//! - [`undefined`]: which of the quantities are not a number somewhere.
//! - [`audit`]: runs compared with a reference solution.
//! - [`precision`]: run time against error for every method.
//! - [`settings`]: observables and engine of a plan.
//! - [`probe`]: time of a run and of an audit.
//!
//! Not here: file formats (`storage`), and what a run is (`run`, `propagation`).

pub mod audit;
pub mod bands;
mod batch;
pub mod crew;
mod crossing;
mod deviation_window;
pub mod drawn;
mod end_finder;
pub mod event_finder;
mod extreme_finder;
pub mod failure_reasons;
pub mod flights;
pub mod influence;
mod lookup;
pub mod magnitude;
pub mod parts;
mod peak;
pub mod percentiles;
pub mod plausibility;
pub mod precision;
pub mod probe;
pub mod rows;
pub mod run_cost;
pub mod run_end;
pub mod runner;
pub mod settings;
mod sightings;
pub mod single;
pub mod supervision;
mod surface;
pub mod undefined;
pub mod worker;

pub use audit::{Audit, Auditor, NoAudit};
pub use bands::{BandLayout, Bands, PartBands, RunsOfColumn};
pub use drawn::DrawnScenes;
pub use failure_reasons::{FailureReason, FailureReasons};
pub use parts::{Part, PartId, Parts};
pub use percentiles::Percentiles;
pub use rows::{Rows, Shape};
pub use runner::{RunError, Sink, run};
pub use settings::EngineMaker;
pub use single::SingleRun;
pub use supervision::Supervision;
pub use worker::{Ensemble, Worker};
