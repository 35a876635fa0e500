//! Layer 11: campaigns and results for programs, such as the command line.
//!
//! - [`campaign`]: [`Campaign`], a file and the place of its result; [`outcome`]: its end; `running`: missing samples.
//! - [`results`]: [`Results`], a finished result. [`compared`](mod@compared): two of them.
//! - [`check`]: estimate of a campaign. [`simulated`]: one sample over time.
//! - [`finishing`]: products of complete rows: [`analysed`], [`page`], `derived`.
//! - `ending` of a finished campaign.
//! - [`verification`]: whether a result is as written, and (`derived_check`) follows from its rows.
//! - [`results_index`]: all results below a folder. [`sampling`]: draws without runs. [`precision`]:
//!   time against error.
//! - [`failed_samples`]: run again, or ending a campaign.
//! - [`source`] of plans.
//! - [`session`]: disk, threads, control law, listeners.
//! - [`outputs`]: refused files.
//! - [`columns`] of rows. [`threads`]: their allowed number. [`error`].
//! - [`workload`]: estimated work, refused if impossible; [`machine`]: free memory and disk.
//!
//! Output, options and exit codes are in `cli`.

pub mod analysed;
pub mod campaign;
pub mod check;
pub mod columns;
pub mod compared;
mod derived;
mod derived_check;
mod ending;
pub mod error;
pub mod failed_samples;
pub mod finishing;
pub mod machine;
pub mod outcome;
pub mod outputs;
pub mod page;
pub mod precision;
pub mod results;
pub mod results_index;
mod running;
pub mod sampling;
pub mod session;
pub mod simulated;
pub mod source;
pub mod threads;
pub mod verification;
pub mod workload;

pub use analysed::Analysed;
pub use campaign::{Campaign, PreparedCampaign};
pub use error::WorkflowError;
pub use finishing::{Completed, Finished, Made, Outputs, finish};
pub use outcome::CampaignOutcome;
pub use results::Results;
pub use session::{Quiet, Session, Watch, isa};
pub use verification::{Verification, Verified, verify};
