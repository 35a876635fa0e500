//! Accuracy: every method against independent truth, closed forms, published cases and its own error estimate.

#![allow(clippy::disallowed_methods)] // digits of no row: the elementary functions of the platform will do

#[path = "../support/mod.rs"]
mod support;
#[path = "../textbook/mod.rs"]
mod textbook;

mod accuracy_claims;
mod air_table;
mod at_rest;
mod bodies;
mod closed_forms;
mod coupled;
mod drift_bounds;
mod dual_spin;
mod environment;
mod error_estimate;
mod feedback;
mod golden_truth;
mod hard_families;
mod jeod;
mod loop_errors;
mod magnetic_torque;
mod many_wheels;
mod null_space;
mod null_space_matrices;
mod oblate;
mod orbits;
mod order_runge_kutta;
mod outcomes_runge_kutta;
mod periodic;
mod reference_solution;
mod relative_motion;
mod report_figures;
mod round_off;
mod stress;
mod tolerance;
mod wheels;

use support::prelude;
