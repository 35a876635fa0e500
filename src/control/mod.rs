//! Layer 4: control in the loop.
//!
//! - [`law`]: [`ControlLaw`], a law that a plan can fly: its name, its parameters, and how it is made for a run from a
//!   [`LawContext`] (in [`context`]).
//! - [`runs`]: the laws of the runs that an engine propagates together.
//! - [`spec`]: what a loop of a campaign file consists of; [`parameters`]: its numbers (`declared`: how a part says its
//!   own). [`control_loop`]: it in a run, where the truth ([`plant`]) and what flies it ([`flight_software`]) meet,
//!   through [`bus`]. [`outcome`]: what comes of a run; [`failure`]: why a mission has failed; [`recorder`]: its
//!   telemetry; [`loop_record`]: quantities over time at the observation points.
//! - [`tick_times`]: the times of ticks. [`truth`]: the true state at a tick. [`sensors`]: what is measured of it
//!   ([`measurement`], [`sensor_spec`]), and what that says of the state ([`observes`]).
//! - [`estimators`]: from measurements to an [`estimate`].
//! - [`guidance`]: which phase a run is in, and the attitude and the maneuver that it wants.
//! - [`laws`]: from an estimate to a wanted torque. [`flight_code`]: WebAssembly modules as such a law.
//! - [`net_launch`]: what guidance and outcome have of the launch of a net at debris, and nothing else.
//! - [`allocation`]: from a wanted torque and force to wheels and thrusters. [`actuators`]: what these make of it.
//! - [`capacity`]: whether the momentum of a scene fits into the wheels of its loop.
//! - [`review`]: what in a loop looks like a mistake; [`stability`]: whether a sampled law is stable for small errors.
//! - [`vector`], [`rotation`], [`small_matrix`]: what all of them compute with.
//!
//! Not here: the interface by which an engine asks a law ([`crate::dynamics::actuation`]), and which campaign flies
//! which law (`campaign`).

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
