//! The project itself: architecture, README, documents.

#![allow(clippy::disallowed_methods)] // digits of no row: the elementary functions of the platform will do

#[path = "../support/mod.rs"]
mod support;

mod accuracy_document;
mod architecture;
mod documents;
mod examples;
mod gallery;
mod generated_tables;
mod weight;
mod words;

use support::prelude;
