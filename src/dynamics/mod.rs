//! Floor 2: the equations of motion, each kernel generic over [`crate::math::Real`] where speed matters.
//!
//! - [`debris`]: the free body beside the spacecraft.
//! - [`gyrostat`]: the reduced form, fast: three rates, an attitude, and what a scene asks for beyond.
//! - [`outcome`]: how a run ended and what it cost; on this floor, because integrators say it and observables read it.
//! - [`mod@reference`]: the report's 62-state null-space form.
//! - [`table`]: the physical states of a run at its observation points.

pub mod actuation;
pub mod debris;
pub mod gyrostat;
pub mod null_space;
