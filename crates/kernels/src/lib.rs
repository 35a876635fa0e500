//! The kernels of spindrift: from a scene to its row, and the statistics of many rows.
//!
//! A [`scene::Scene`] is integrated by a [`propagation::Engine`] to a [`run::StateTable`], which [`observables`] reduce
//! to a row; [`statistics`] are functions of numbers. Nothing here knows a campaign, a file or a thread. The package
//! `spindrift` exports these modules as its own: use them from there. Its `ARCHITECTURE.md` shows the layers, its
//! `docs/model.md` the equations.

#![forbid(unsafe_code)]
// failures are values; a printing macro panics where the pipe is closed
#![warn(clippy::unwrap_used, clippy::print_stdout)]
#![cfg_attr(test, allow(clippy::disallowed_methods))]

pub mod dynamics;
pub mod math;
pub mod observables;
pub mod ode;
pub mod propagation;
pub mod run;
pub mod scene;
pub mod statistics;
#[cfg(test)]
mod testing;
