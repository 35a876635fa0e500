//! Taylor series of the gyrostat in lanes, with periodic propagation of what is free of torque.
//!
//! - [`jet`]: the recurrences. [`step`]: order and step size. [`thrust`]: integrals of the thrust along a step.
//!   `brief`: the order of arcs much shorter than a step. `truncation`: estimates of what the steps leave out.
//!   [`dense`]: evaluation of series.
//! - [`driver`]: the steps of all lanes and what happens to them; `lanes`: which run is in which lane; `lane_state`,
//!   `lane_vectors`: where each is in its run; `points`, `point_rows`: observation points during a step; [`workspace`],
//!   `series_ring`: memory.
//! - [`period`], `period_search`: the period of omega and time folded by it; [`return_detector`]: its search in all
//!   lanes at once; `period_folding`, `fold_buffer`: the points of runs whose period is known.
//! - [`reference_solution`]: reference solutions of any scene by the same recurrences in double-double;
//!   `switched_reference`: where torques have no series; `reference_run`: what both have of a run.
//!
//! The motion of omega without torque is periodic: it stays on the curve in which the energy ellipsoid meets the
//! momentum sphere. One period turns the attitude by a fixed rotation about the constant angular momentum L, so a run
//! of any length costs one period and the observation points. Where no period shows up (near the separatrix, or with
//! torque), the same steps are the Taylor integration of the whole run.

mod brief;
pub mod dense;
pub mod driver;
pub mod engine;
pub mod fold_buffer;
pub mod jet;
mod lane_state;
mod lane_vectors;
mod lanes;
pub mod period;
mod period_folding;
mod period_search;
mod point_rows;
mod points;
mod reference_run;
pub mod reference_solution;
pub mod return_detector;
pub mod series_ring;
pub mod step;
mod switched_reference;
pub mod thrust;
mod truncation;
pub mod workspace;
