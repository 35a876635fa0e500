//! Layer 2: statistics of many runs: pure functions of numbers.

pub mod binomial;
pub mod correlation;
pub mod moments;
pub mod quantile;
pub mod regression;
pub mod sensitivity;
pub mod sketch;
pub mod student;
