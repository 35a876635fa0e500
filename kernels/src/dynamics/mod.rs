//! Layer 2: equations of motion and the forces and torques in them; generic over [`crate::math::Real`] for speed.
//!
//! - [`actuation`]: interface of laws. [`applied`]: the next arc of a run. [`arc_record`]: its arcs so far.
//! - [`effects`]: forces and torques other than actuators. [`environment`]: air, Sun, the Earth's shadow.
//!   [`magnetic_field`], [`earth_rotation`].
//! - [`gravity`]; [`orbit`]: two-body orbits in closed form; [`orbit_series`]: Taylor series; [`orbit_path`]: any
//!   orbit; [`orbit_state`]: position and velocity. [`offset_series`], [`relative_orbit`]: motion relative to an orbit.
//! - [`gyrostat`]: the reduced form, fast. [`null_space`]: Berdoz's 62-state form. [`debris`]: the free body.

pub mod actuation;
pub mod applied;
pub mod arc_record;
pub mod debris;
pub mod earth_rotation;
pub mod effects;
pub mod environment;
pub mod gravity;
pub mod gyrostat;
pub mod magnetic_field;
pub mod null_space;
pub mod offset_series;
pub mod orbit;
pub mod orbit_in_body;
pub mod orbit_path;
pub mod orbit_series;
pub mod orbit_state;
pub mod relative_orbit;
