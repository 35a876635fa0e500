//! Layer 2: the equations of motion, each kernel generic over [`crate::math::Real`] where speed matters, and what acts
//! on them.
//!
//! - [`actuation`]: the interface by which a run is asked for its arcs of constant actuation.
//! - [`applied`]: the arc that a run flies next.
//! - [`arc_record`]: the arcs that a run has flown.
//! - [`debris`]: the free body beside the spacecraft.
//! - [`earth_rotation`]: how the Earth is turned at a date.
//! - [`effects`]: what acts beside the actuators. [`gravity`]: the pull of a central body. [`orbit`]: motion on a
//!   two-body orbit in closed form; [`orbit_series`]: Taylor series of an orbit; [`orbit_path`]: motion on any orbit;
//!   [`orbit_state`]: position and velocity on it. [`offset_series`]: motion relative to a point on it;
//!   [`relative_orbit`]: that of a free body.
//! - [`magnetic_field`]: the Earth's magnetic field. [`environment`]: air, the Sun and the Earth's shadow.
//! - [`gyrostat`]: the reduced form, fast: three rates, an attitude, and further components where a scene needs them.
//! - [`null_space`]: Berdoz's 62-state null-space form.

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
