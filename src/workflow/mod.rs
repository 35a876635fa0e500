//! Layer 11: campaigns and results for programs, such as the command line: a [`Campaign`] runs and finishes, its
//! [`Results`] are read, verified, compared and shown. Output, options and exit codes are in `cli`.

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
