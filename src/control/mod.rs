//! Layer 4: control in the loop.
//!
//! - [`law`]: [`ControlLaw`], a law that a plan can fly; [`context`]: its settings for a run; [`runs`]: the laws of the
//!   runs that an engine propagates together.
//! - [`spec`]: the structure of a loop in a campaign file; [`parameters`] and `declared`: its numbers.
//! - [`control_loop`]: the loop of a run, where plant and flight software exchange the data of [`bus`].
//! - [`plant`]: the truth ([`truth`]), which [`sensors`] measure ([`measurement`], [`sensor_spec`], [`observes`]) and
//!   [`actuators`] move.
//! - [`flight_software`]: [`estimators`] from measurements to an [`estimate`], [`guidance`] to a phase and its target,
//!   [`laws`] to a torque ([`flight_code`]: those of WebAssembly modules), [`allocation`] to commands.
//! - [`outcome`], [`failure`]: the end of a run; [`recorder`], [`loop_record`]: its telemetry and quantities over time.
//! - [`net_launch`]: the launch of a net at debris.
//! - [`capacity`], [`review`], [`stability`]: checks of a loop before it flies.
//! - [`vector`], [`rotation`], [`small_matrix`], [`tick_times`]: numbers and times.
//!
//! Not here: the interface between engines and laws ([`crate::dynamics::actuation`]), and reading of campaign files
//! (`campaign`).

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
pub mod rotation;
pub mod runs;
pub mod sensor_spec;
pub mod sensors;
pub mod small_matrix;
pub mod spec;
pub mod stability;
pub mod tick_times;
pub mod truth;
pub mod vector;

pub use context::LawContext;
pub use law::ControlLaw;
pub use outcome::STANDARD_GRAVITY;
pub use runs::LawRuns;
pub use spec::LoopSpec;
