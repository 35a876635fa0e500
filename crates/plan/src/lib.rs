//! Campaign files of spindrift, resolved to plans, with the description of control loops as data.

#![forbid(unsafe_code)]
#![warn(clippy::unwrap_used, clippy::print_stdout)]
#![cfg_attr(test, allow(clippy::disallowed_methods))]

#[doc(hidden)]
pub mod campaign;
#[doc(hidden)]
pub mod loops;
#[doc(hidden)]
pub mod sampling;

#[doc(hidden)]
pub use spindrift_kernels::{dynamics, math, observables, ode, propagation, run, scene, statistics};
