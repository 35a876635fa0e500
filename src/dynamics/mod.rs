//! Floor 2: the equations of motion, each kernel generic over [`crate::math::Real`] where speed matters.
//!
//! - [`outcome`]: how a run ended and what it cost; on this floor, because integrators say it and observables read it.
//! - [`reference`]: the report's 62-state null-space form.
//! - [`table`]: the physical states of a run at its observation points.

pub mod outcome;
pub mod reference;
pub mod table;
