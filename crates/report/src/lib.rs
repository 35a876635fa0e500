//! Findings of a spindrift campaign in words and figures, on screens and report pages.

#![forbid(unsafe_code)]
#![warn(clippy::unwrap_used, clippy::print_stdout)]
#![cfg_attr(test, allow(clippy::disallowed_methods))]

#[doc(hidden)]
pub mod findings;
#[doc(hidden)]
pub mod report;

#[doc(hidden)]
pub use spindrift_ensemble::{analysis, ensemble, storage, table};
#[doc(hidden)]
pub use spindrift_kernels::{dynamics, math, observables, ode, propagation, run, scene, statistics};
#[doc(hidden)]
pub use spindrift_plan::{campaign, loops, sampling};
