//! Layer 6: many runs on all cores. A row is a pure function of (plan, sample).
//!
//! - [`mod@parts`]: division of samples into parts; [`run_cost`]: their size; [`rows`]: the rows of a part, taken by a
//!   [`Sink`].
//! - [`worker`]: [`Ensemble`], shared by all threads, and [`Worker`], the memory of one thread; `batch`: scenes run
//!   together; [`runner`]: parts over threads; [`supervision`]: progress and stops.
//! - [`drawn`]: drawn parameters without runs; [`percentiles`]: their quantiles; [`magnitude`]: lengths and angles.
//! - [`influence`]: parameters without effect. [`plausibility`]: numbers that look like a mistake. [`undefined`]:
//!   quantities that are not a number somewhere.
//! - [`flights`]: runs under the control law of the plan; `observed_runs`: with their rows; [`single`]: one run with
//!   its states; `surface`: contact with the central body.
//! - [`event_finder`]: crossings, seen in `sightings` and located in `crossing` from values at other times (`lookup`);
//!   `extreme_finder`: extremes, located in `peak`; [`run_end`]: the event that ends a run, found in `end_finder`.
//! - [`bands`]: quantiles over time, counted in `deviation_window`.
//! - [`audit`]: runs compared with a reference solution; [`precision`]: run time against error for every method.
//! - [`settings`]: observables and engine of a plan; [`probe`]: time of a run and of an audit.
//!
//! Not here: file formats (`storage`), and single runs (`run`, `propagation`).

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
mod observed_runs;
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
