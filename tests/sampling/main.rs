//! Draws: streams, distributions, designs, dependence.

#![allow(clippy::disallowed_methods)] // digits of no row: the elementary functions of the platform will do

#[path = "../support/mod.rs"]
mod support;

mod arcs;
mod bootstrap;
mod causal_structures;
mod coverage;
mod coverage_of_means;
mod coverage_of_sensitivities;
mod dependence;
mod designs;
mod dispersable;
mod distributions;
mod drivers_of_known_truth;
mod drivers_of_structures;
mod effect;
mod false_names;
mod geometric;
mod means_with_tails;
mod replay;
mod replicates;
mod structure;

use support::prelude;
