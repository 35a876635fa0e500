//! Floor 5: many runs. Parts of consecutive samples over threads; a row is a pure function of (plan, sample).
//!
//! - [`parts`]: where a campaign is cut. - [`rows`]: the rows of a part, column by column. - [`sink`]: where they go.
//! - [`campaign`]: what all workers share, and [`campaign::Worker`], what each owns.
//! - [`drawn`]: samples drawn and not run. - [`runner`]: parts over threads. - [`single`]: one run with its states, as `simulate` shows it.
//! - [`audit`]: runs once more, exactly. - [`precision`]: run time against error for every method. - [`cpu_clock`]: the clock of that time.
//!
//! Not here: file formats (the output floor), and what a run is (the floors below).

pub mod audit;
pub mod cpu_clock;
pub mod drawn;
pub mod parts;
pub mod precision;
pub mod rows;
pub mod runner;
pub mod single;
pub mod sink;
pub mod worker;

pub use audit::{Audit, Auditor};
pub use drawn::DrawnScenes;
pub use parts::{Part, PartId, Parts};
pub use rows::{Rows, Shape};
pub use runner::{RunError, run};
pub use single::SingleRun;
pub use sink::Sink;
pub use worker::{Ensemble, Worker};
