//! Floor 2: the equations of motion, each kernel generic over [`crate::math::Real`] where speed matters.
//!
//! - [`mod@reference`]: the report's 62-state null-space form.
//! - [`table`]: the physical states of a run at its observation points.

pub mod reference;
pub mod table;
