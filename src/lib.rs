//! spindrift: Monte Carlo analysis of spacecraft attitude dynamics.
//!
//! A module imports only from floors below its own: [`math`] (0), [`scene`] (1), [`sampling`] and [`dynamics`] (2),
//! [`integrators`] and [`observables`] (3), [`campaign`] (4), [`ensemble`] (5), [`output`] (6), [`cli`] (7).

pub mod campaign;
pub mod cli;
pub mod dynamics;
pub mod ensemble;
pub mod integrators;
pub mod math;
pub mod observables;
pub mod output;
pub mod sampling;
pub mod scene;
