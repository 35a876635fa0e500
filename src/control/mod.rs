//! Layer 4: control in the loop, between the engines' interface to laws ([`crate::dynamics::actuation`]) and
//! `campaign`, which reads the files.
//!
//! Quantities are in SI units and radians. Suffixes name their frames: `_s` is F_s of the spacecraft, `_d` F_d of the
//! debris, `_e` the inertial F_e; `q_es` turns F_s to F_e, scalar first.
//!
//! - [`spec`], [`parameters`], `declared`: the structure of a loop in a campaign file, and its numbers.
//! - [`law`], [`context`]: the law of a plan with the laws of runs that share an engine, and its settings for one run.
//! - [`control_loop`]: the loop of one run, in which plant and flight software exchange the data of [`bus`].
//! - [`plant`]: the [`truth`], measured by [`sensors`] and moved by [`actuators`].
//! - [`flight_software`]: [`estimators`], [`guidance`], [`laws`] (those of WebAssembly modules: [`flight_code`]) and
//!   [`allocation`].
//! - [`outcome`], [`failure`], [`recorder`], [`loop_record`]: results of a run, at its end and over time.
//! - [`net_launch`]: launch of a net at debris.
//! - [`capacity`], [`review`], [`stability`]: checks before a loop flies.
//! - [`vector`], [`tick_times`]: arithmetic and times.

pub mod actuators;
pub mod allocation;
pub mod bus;
pub mod capacity;
pub mod context;
pub mod control_loop;
pub(crate) mod declared;
pub mod estimate;
pub mod estimators;
pub mod failure;
pub mod flight_code;
pub mod flight_software;
pub mod guidance;
pub mod law;
pub mod laws;
pub mod loop_record;
pub mod measurement;
pub mod net_launch;
pub mod observes;
pub mod outcome;
pub mod parameters;
pub mod plant;
pub mod recorder;
pub mod review;
pub mod sensor_spec;
pub mod sensors;
pub mod spec;
pub mod stability;
pub mod tick_times;
pub mod truth;
pub mod vector;

pub use context::LawContext;
pub use law::{ControlLaw, LawRuns};
pub use outcome::STANDARD_GRAVITY;
pub use spec::LoopSpec;
