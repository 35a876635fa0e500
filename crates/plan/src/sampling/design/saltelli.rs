//! `saltelli`: blocks of samples for first-order and total sensitivity indices (A. Saltelli et al., *Variance based
//! sensitivity analysis of model output*, Comput. Phys. Commun. 181 (2010) 259, section 3).
//!
//! A block of k + 2 samples, for k distributions, has two independent points A and B: A, then A with the numbers of
//! distribution 1, ..., k from B, then B. More blocks leave earlier ones unchanged.
//!
//! In each dimension A and B are the two coordinates of a scrambled Sobol sequence in an order of its own (A. B. Owen,
//! *Latin supercube sampling for very high-dimensional simulations*, ACM TOMACS 8 (1998) 71). In one sequence for all
//! dimensions, leading bits of three depend on each other: it estimated the first-order index of x in the exclusive or
//! of x and y as -1 instead of 0.

use super::latin::Permutation;
use super::prelude::*;
use super::replicates::{Sequence, whole_blocks};
use super::sobol::Sobol;

#[derive(Clone, Debug)]
pub struct Saltelli {
    /// The sequence of each dimension, and the key of its order.
    sequences: Vec<(Sobol, u64)>,
    factors: Vec<usize>,
    members: u64,
}

/// Samples of a block.
pub fn members(factors: &[usize]) -> u64 {
    factors.iter().max().map_or(0, |last| *last as u64 + 1) + 2
}

impl Saltelli {
    pub fn new(seed: u64, names: &[String], factors: &[usize]) -> Self {
        let sequence =
            |name: &String| (Sobol::new(seed, &[name.clone(), format!("{name}/B")]), key(seed, name, *b"saltelli"));
        Saltelli {
            sequences: names.iter().map(sequence).collect(),
            factors: factors.to_vec(),
            members: members(factors),
        }
    }

    pub fn number(&self, dimension: usize, point: u64) -> f64 {
        let (block, member) = (point / self.members, point % self.members);
        let from_b = member == self.members - 1 || member == self.factors[dimension] as u64 + 1;
        let (sequence, order) = &self.sequences[dimension];
        sequence.number(usize::from(from_b), place(*order, block))
    }
}

/// The point of `block` in the order of `key`: points 2^m to 2^(m+1) are shuffled among themselves, so that the first
/// 2^m blocks have the first 2^m points.
fn place(key: u64, block: u64) -> u64 {
    let Some(level) = block.checked_ilog2() else { return 0 };
    let first = 1 << level;
    first + Permutation::new(first, keyed(key, u64::from(level))).image(block - first)
}

impl PointSource for Saltelli {
    fn fill(&mut self, block: u64, u: &mut [[f64; BLOCK]]) {
        by_point(block, u, |dimension, point| self.number(dimension, point));
    }
}

impl Kind for Saltelli {
    const FACTS: Facts = Facts {
        excludes_correlation: Some([
            "a design for correlated parameters: indices of variance are defined for independent ones",
            "delete [[correlate]], or use sobol",
        ]),
        ..Facts::new("saltelli", &[], &[])
    };

    fn check(dimensions: Dimensions<'_>, samples: Option<u64>) -> Result<()> {
        let members = members(dimensions.factors);
        let allowed = format!(
            "1 and a multiple of {members}: the nominal scene and whole blocks of the distributions and two more"
        );
        whole_blocks(samples, members, allowed, "")
    }

    fn points(_: &Written, dimensions: Dimensions<'_>) -> Self {
        Saltelli::new(dimensions.seed, dimensions.names, dimensions.factors)
    }
}
