//! Taylor series of the gyrostat in lanes, with periodic propagation of torque-free motion.
//!
//! - [`jet`]: recurrences. [`step`]: order and step size. [`thrust`]: integrals of thrust along a step. `brief`: order
//!   of arcs much shorter than a step. `truncation`: estimated truncation. [`dense`]: evaluation of series.
//! - [`driver`]: steps of all lanes; `lanes`: assignment of runs; `lane_state`, `lane_vectors`: progress of each;
//!   `points`, `point_rows`: observation points during a step; [`workspace`], `series_ring`: memory.
//! - [`period`], `period_search`, [`return_detector`]: the period of omega and its search; `period_folding`,
//!   `fold_buffer`: points of runs with a known period.
//! - [`reference_solution`]: reference solutions in double-double by the same recurrences; `switched_reference`: for
//!   torques without series; `reference_run`: shared by both.
//!
//! Without torque omega is periodic: it stays on the intersection of energy ellipsoid and momentum sphere. A period
//! turns the attitude by a fixed rotation about the constant angular momentum L, so that a run of any length costs one
//! period plus its observation points. Without a period (near the separatrix, or with torque) the same steps integrate
//! the whole run.

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
