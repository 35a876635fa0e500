//! What several test programs share; each of them uses a part.
#![allow(dead_code)] // every file under tests/ is a program of its own and compiles all of this

pub mod extrapolation;
pub mod golden;
pub mod runs;
pub mod scenes;
