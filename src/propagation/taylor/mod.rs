//! Taylor series of the gyrostat in lanes, with periodic propagation of what is free of torque.
//!
//! - [`jet`]: the recurrences. [`step`]: order and step size. [`thrust`]: integrals of the thrust along a step.
//! - `truncation`: what the steps leave out. [`driver`]: the lanes; `lane_state`: where each is in its run; `points`: what it passes;
//!   [`workspace`]: their memory. [`dense`]: evaluating series at the observation points.
//! - [`period`]: finding the period of omega and folding time by it; [`return_detector`]: the same for all lanes at once;
//!   [`period_folding`]: the points of runs whose period is known.
//! - [`reference_solution`]: reference solutions of any scene by the same recurrences in double-double.
//!
//! The motion of omega without torque is periodic: it stays on the curve in which the energy ellipsoid meets the momentum
//! sphere. One period turns the attitude by a fixed rotation about the constant angular momentum L, so a horizon of any
//! length costs one period and the observation points. Where no period shows up (near the separatrix, or with torque), the
//! same march simply is the Taylor integration of the whole horizon.

pub mod dense;
pub mod driver;
pub mod engine;
pub mod jet;
mod lane_state;
pub mod period;
pub mod period_folding;
mod points;
pub mod reference_solution;
pub mod return_detector;
pub mod step;
pub mod thrust;
mod truncation;
pub mod workspace;
