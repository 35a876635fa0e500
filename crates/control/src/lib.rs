//! Control loops of spindrift: their tables in campaign files, plant and flight software.

#![forbid(unsafe_code)]
#![warn(clippy::unwrap_used, clippy::print_stdout)]
#![cfg_attr(test, allow(clippy::disallowed_methods))]

#[doc(hidden)]
pub mod control;

#[doc(hidden)]
pub use spindrift_kernels::{dynamics, math, observables, ode, propagation, run, scene, statistics};
#[doc(hidden)]
pub use spindrift_plan::{campaign, loops, sampling};
