//! Campaign files: what is read, what is refused, and the messages.

#![allow(clippy::disallowed_methods)] // digits of no row: the elementary functions of the platform will do

#[path = "../support/mod.rs"]
mod support;

mod analysis;
mod bad_campaigns;
mod implausible;
mod invalid_files;
mod keys;
mod loop_notes;
mod loops;
mod misspelt;
mod ranges;
mod refusals;
mod schema;
mod shipped;
mod spacecraft;
mod units;
mod variants;

use support::prelude;
