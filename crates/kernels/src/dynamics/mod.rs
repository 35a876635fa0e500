//! Layer 2: equations of motion and the forces and torques in them; generic over [`crate::math::Real`] for speed.

pub mod actuation;
pub(crate) mod applied;
pub(crate) mod arc_record;
pub mod debris;
pub mod earth_rotation;
pub mod effects;
pub mod environment;
pub mod gravity;
pub mod gyrostat;
pub mod magnetic_field;
pub mod null_space;
pub(crate) mod offset_series;
pub mod orbit;
pub(crate) mod orbit_in_body;
pub mod orbit_path;
pub(crate) mod orbit_series;
pub mod orbit_state;
pub mod relative_orbit;
pub mod surroundings;
