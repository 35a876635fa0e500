//! Figures over time, of the page and of `simulate --plot`.
//!
//! [`figure_list`]: which figures a scene gets. [`curves`]: the nominal run and the bands of the ensemble as marks;
//! `states`, `control`, `energies`, `ground_track` and `drift`: what the figures show. `limits`: the limits in them.

pub mod control;
pub mod curves;
mod drift;
mod energies;
pub mod figure_list;
mod ground_track;
mod limits;
mod states;
