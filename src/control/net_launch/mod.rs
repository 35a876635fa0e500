//! The launch of a net at debris, which is the rest of `control`'s second body for sensors only.

pub mod geometry;
pub mod launch;
pub mod parameters;
