//! Layer 11: campaigns and results, as a program works with them; the command line is one such program.
//!
//! - [`campaign`]: [`Campaign`], a file and where its result goes; [`outcome`]: how it ended; `running`: the samples
//!   that are not there yet.
//! - [`results`]: [`Results`], a finished result to be read. [`compared`](mod@compared): two of them compared.
//! - [`check`]: what a campaign would run. [`simulated`]: one sample over time.
//! - [`finishing`]: what is made once all rows are there: [`analysed`], [`page`], `derived`.
//! - `ending`: how a finished campaign ended.
//! - [`verification`]: whether a result is what was written, and (`derived_check`) what its rows say.
//! - [`results_index`]: all results below a folder. [`sampling`]: draws without runs. [`precision`]:
//!   time against error.
//! - [`failed_samples`]: samples that failed, again or as the end.
//! - [`source`]: where plans come from.
//! - [`session`]: disk, threads, control law, and who is told.
//! - [`outputs`]: files that are not written.
//! - [`columns`]: the columns that rows may have. [`threads`]: how many are allowed. [`error`].
//! - [`workload`]: what a command would compute and write, refused where it cannot be done; [`machine`]: what is left
//!   of memory and disk.
//!
//! Not here: what is printed, options and exit codes (`cli`).

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
