//! A row is a pure function of plan and sample.

#![allow(clippy::disallowed_methods)] // digits of no row: the elementary functions of the platform will do

#[path = "../support/mod.rs"]
mod support;
#[path = "../textbook/mod.rs"]
mod textbook;

#[cfg(feature = "wasm")]
mod assembled_module;
mod bands;
mod events;
mod extremes;
mod failures;
mod feedback;
#[cfg(feature = "wasm")]
mod flight_code;
#[cfg(feature = "wasm")]
mod flight_code_fuzz;
#[cfg(feature = "wasm")]
mod flight_code_interface;
mod lanes;
mod lanes_runge_kutta;
#[cfg(feature = "cloud")]
mod object_store;
mod panics;
mod run_ends;
mod skipping;
#[cfg(feature = "cloud")]
mod store_bench;
#[cfg(feature = "cloud")]
mod store_proxy;
mod surface;
mod threads_and_order;
mod value_hashes;
mod whole_rows;

use support::prelude;
