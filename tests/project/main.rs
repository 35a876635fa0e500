//! The project itself: architecture, README, documents.

#[path = "../support/mod.rs"]
mod support;

mod accuracy_document;
mod architecture;
mod documents;
mod examples;
mod generated_tables;
mod source;
mod supply_chain;
mod vocabulary;
