//! The program as a user runs it: commands, files, audits, columns.

#![allow(clippy::disallowed_methods)] // digits of no row: the elementary functions of the platform will do

#[path = "../support/mod.rs"]
mod support;

mod commands;
mod loops;
mod observables;
mod page;
mod reliability;
mod results;
mod small_campaign;
mod views;
