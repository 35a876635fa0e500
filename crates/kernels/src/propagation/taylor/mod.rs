//! Taylor series of the gyrostat in lanes, with periodic propagation of torque-free motion.
//!
//! Without torque omega is periodic: it stays on the intersection of energy ellipsoid and momentum sphere. A period
//! turns the attitude by a fixed rotation about the constant angular momentum L, so that a run costs one period plus
//! its observation points. Without a period (near the separatrix, or with torque) the same steps integrate the whole
//! run.
#![expect(clippy::needless_range_loop, reason = "components are numbered alike in several arrays")]

mod brief;
pub(crate) mod dense;
pub(crate) mod driver;
pub mod engine;
pub(crate) mod fold_buffer;
pub(crate) mod jet;
mod lane_state;
mod lane_vectors;
mod lanes;
pub(crate) mod period;
mod period_folding;
mod period_search;
mod point_rows;
mod points;
mod reference_run;
pub mod reference_solution;
pub(crate) mod return_detector;
pub(crate) mod series_ring;
pub mod step;
mod switched_reference;
pub mod thrust;
mod truncation;
pub(crate) mod workspace;
