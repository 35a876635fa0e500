//! Layer 2: statistics of many runs: pure functions of numbers.

pub mod sketch;
