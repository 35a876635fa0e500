//! Figures over time, of the page and of `simulate --plot`.
//!
//! [`figure_list`]: which figures a scene gets. [`curves`]: the nominal run and the bands of the ensemble as marks;
//! `states`, `control`, `energies`, `ground_track` and `drift`: what the figures show. `limits`: the limits in them.
//! `envelope`, `spectrum`, `relative_errors`: what curves need.

mod control;
pub mod curves;
mod drift;
mod energies;
mod envelope;
pub mod figure_list;
mod ground_track;
mod limits;
mod relative_errors;
mod spectrum;
mod states;
