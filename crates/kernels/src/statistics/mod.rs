//! Layer 2: statistics of many runs, as pure functions of numbers.

pub mod binomial;
pub(crate) mod carries;
pub mod conditional;
pub mod contingency;
pub mod correlation;
pub mod deviation;
pub mod gate;
pub mod jackknife;
pub mod looks;
pub mod mean;
pub mod moments;
pub mod quantile;
pub mod rank_tests;
pub(crate) mod ranks;
pub mod regression;
pub mod replicates;
pub mod sensitivity;
pub mod share_within;
pub mod sketch;
pub mod spread;
pub(crate) mod student;
pub mod two_sample;
