//! Many runs of a spindrift campaign, flown on all cores, stored and analysed.

#![forbid(unsafe_code)]
#![warn(clippy::unwrap_used, clippy::print_stdout)]
#![cfg_attr(test, allow(clippy::disallowed_methods))]

#[doc(hidden)]
pub mod analysis;
#[doc(hidden)]
pub mod ensemble;
#[doc(hidden)]
pub mod storage;
#[doc(hidden)]
pub mod table;

#[doc(hidden)]
pub use spindrift_kernels::{dynamics, math, observables, ode, propagation, run, scene, statistics};
#[doc(hidden)]
pub use spindrift_plan::{campaign, loops, sampling};
