//! Code that several test programs share; each of them uses a part.
#![allow(dead_code)] // every file under tests/ is a program of its own and compiles all of this

pub mod campaigns;
pub mod claims;
pub mod draws;
pub mod every_key;
pub mod exact;
pub mod feedback;
pub mod golden;
pub mod invariants;
pub mod observed;
pub mod orbits;
pub mod parquet_tables;
pub mod plans;
pub mod prelude;
pub mod runs;
pub mod scenes;
pub mod scratch_folder;
