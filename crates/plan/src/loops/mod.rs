//! The description of control loops as data, the interfaces of their makers and of attitude laws, and the capacity and
//! records by which the layers above know a loop. `control` reads, makes and flies them.
//!
//! Quantities are in SI units and radians. Suffixes name their frames: `_s` is F_s of the spacecraft, `_d` F_d of the
//! debris, `_e` the inertial F_e; `q_es` turns F_s to F_e, scalar first.
//!
//! [`spec`] is a loop in a campaign file, [`law`] the law of a plan and its maker, [`attitude_law`] a law of attitude.

pub mod attitude_law;
pub mod callback;
pub mod capacity;
pub mod condition;
pub mod context;
pub mod declared;
pub mod estimate;
pub mod failure;
pub mod flight_code;
pub mod kinds;
pub mod launch_geometry;
pub mod launch_numbers;
pub mod law;
pub mod loop_record;
pub mod measurement;
pub mod observes;
pub mod phase;
pub mod rod_law;
pub mod sensor_spec;
pub mod spec;
pub mod target;
pub mod vector;

pub use context::LawContext;
pub use law::{ControlLaw, LawMaker, LawRuns, OwnLaw};
pub use spec::{LoopSpec, STANDARD_GRAVITY};
