//! Campaign files: what is read, what is refused, and the messages.

#![allow(clippy::disallowed_methods)] // digits of no row: the elementary functions of the platform will do

#[path = "../support/mod.rs"]
mod support;

mod analysis;
mod bad_actuators;
mod bad_bodies;
mod bad_campaign_cases;
mod bad_campaigns;
mod bad_dispersions;
mod bad_spacecraft;
mod implausible;
mod invalid_files;
mod keys;
mod misspelt;
mod ranges;
mod shipped;
mod spacecraft;
mod units;
mod variants;
