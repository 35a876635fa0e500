//! Figures over time, for the page and for `simulate --plot`: [`figure_list`] selects them, [`curves`] draws runs and
//! bands.

mod aliasing;
pub mod control;
pub mod curves;
mod drift;
mod energies;
pub mod figure_list;
mod ground_track;
mod limits;
mod states;
