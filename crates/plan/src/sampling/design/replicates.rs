//! [`REPLICATES`]: several designs of one kind, scrambled independently.
//!
//! Points of one net or hypercube depend on each other: intervals come from the spread of the means of independent
//! replicates (A. B. Owen, *Scrambled net variance for integrals of smooth functions*, Ann. Statist. 25 (1997) 1541,
//! section 1; *Monte Carlo theory, methods and examples*, chapter 17.4).
//!
//! Sample k >= 1 is point (k - 1) / R of replicate (k - 1) mod R.

use super::prelude::*;
use super::traits::MAX_SAMPLES;
use crate::sampling::error::{Table, error_of};
use crate::sampling::keys;
use std::fmt::Debug;

/// Each has its own scrambling in memory.
const MOST: u64 = 1024;

pub const REPLICATES: Row = Row::new(
    "replicates",
    keys::Kind::Count([1, MOST]),
    "Number of designs of this kind, each scrambled independently; default: 1",
);

pub(super) fn count(written: &Written) -> u64 {
    written.count(REPLICATES.key).unwrap_or(1)
}

/// The names that scramble the dimensions of each replicate.
pub(super) fn scrambling_names(written: &Written, names: &[String]) -> Vec<Vec<String>> {
    let of = |replicate| names.iter().map(|name| format!("{name} replicate {replicate}")).collect();
    match count(written) {
        1 => vec![names.to_vec()],
        count => (0..count).map(of).collect(),
    }
}

/// Replicates have equally many samples.
pub(super) fn check(written: &Written, samples: Option<u64>) -> Result<()> {
    let count = count(written);
    let allowed = format!("1 and a multiple of {count}: the nominal scene and {count} replicates of the design");
    whole_blocks(samples, count, allowed, ", or other replicates in [design]")
}

/// Checks that `samples` are 1 and a multiple of `block`.
pub(super) fn whole_blocks(samples: Option<u64>, block: u64, allowed: String, otherwise: &str) -> Result<()> {
    let Some(samples) = samples.filter(|samples| *samples > 1 && (samples - 1) % block != 0) else {
        return Ok(());
    };
    let below = 1 + (samples - 1) / block * block;
    let numbers = [Some(below).filter(|below| *below > 1), Some(below + block).filter(|above| *above <= MAX_SAMPLES)];
    let numbers: Vec<String> = numbers.into_iter().flatten().map(|number| number.to_string()).collect();
    let remedy = format!("write {}{otherwise}", numbers.join(" or "));
    Err(error_of(Table::Campaign, "samples", samples.to_string(), allowed, remedy))
}

/// A scrambled sequence of points.
pub trait Sequence: Debug {
    const NAME: &'static str;
    const MAX_DIMENSIONS: usize;

    /// Scrambled by seed and name.
    fn new(seed: u64, names: &[String]) -> Self;

    /// In (0, 1).
    fn number(&self, dimension: usize, point: u64) -> f64;
}

#[derive(Debug)]
pub struct Replicated<S>(Vec<S>);

impl<S: Sequence> PointSource for Replicated<S> {
    fn fill(&mut self, block: u64, u: &mut [[f64; BLOCK]]) {
        let count = self.0.len() as u64;
        by_point(block, u, |dimension, point| self.0[(point % count) as usize].number(dimension, point / count));
    }
}

impl<S: Sequence> Kind for Replicated<S> {
    const FACTS: Facts = Facts { max_dimensions: S::MAX_DIMENSIONS, ..Facts::new(S::NAME, &[REPLICATES], &[]) };

    fn points(written: &Written, dimensions: Dimensions<'_>) -> Self {
        let names = scrambling_names(written, dimensions.names);
        Replicated(names.iter().map(|names| S::new(dimensions.seed, names)).collect())
    }
}
