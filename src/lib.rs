//! spindrift: Monte Carlo analysis of spacecraft attitude dynamics.
//!
//! A module imports only from layers below its own; ARCHITECTURE.md shows the data flow and the layers.

#![forbid(unsafe_code)]

pub mod campaign;
pub mod cli;
pub mod dataset;
pub mod dynamics;
pub mod ensemble;
pub mod math;
pub mod observables;
pub mod ode;
pub mod propagation;
pub mod report;
pub mod run;
pub mod sampling;
pub mod scene;
pub mod statistics;
