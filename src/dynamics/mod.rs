//! Floor 2: the equations of motion, each kernel generic over [`crate::math::Real`] where speed matters.
//!
//! - [`table`]: the physical states of a run at its observation points.

pub mod table;
