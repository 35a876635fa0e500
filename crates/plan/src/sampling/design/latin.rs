//! `latin_hypercube`: in each dimension one sample in each of n equal strata (M. D. McKay, R. J. Beckman & W. J.
//! Conover, *Technometrics* 21 (1979) 239).
//!
//! The stratum of a sample is its image under a keyed permutation of 0..n without memory: a Feistel network over the
//! next even number of bits, walked until below n (J. Black & P. Rogaway, *Ciphers with arbitrary finite domains*,
//! CT-RSA 2002). Within it a sample lies as in the random design. n = samples - 1, without the nominal scene.

use super::prelude::*;
use super::replicates::{self, REPLICATES};
use super::traits::streams;
use crate::sampling::stream::Stream;

/// Four make a pseudorandom permutation of an ideal round function (M. Luby & C. Rackoff, 1988); two more for safety.
const ROUNDS: usize = 6;
/// Least bits of half a block: small networks reach few permutations.
const MIN_HALF: u32 = 4;

/// A permutation of 0..`n`, chosen by a key.
#[derive(Clone, Debug)]
pub struct Permutation {
    n: u64,
    half: u32,
    keys: [u64; ROUNDS],
}

impl Permutation {
    /// n <= 2^62.
    pub fn new(n: u64, key: u64) -> Self {
        let bits = u64::BITS - n.saturating_sub(1).leading_zeros();
        let keys = std::array::from_fn(|round| keyed(key, round as u64));
        Permutation { n, half: bits.div_ceil(2).max(MIN_HALF), keys }
    }

    pub fn image(&self, index: u64) -> u64 {
        let mut image = index;
        loop {
            image = self.walk(image);
            if image < self.n {
                return image;
            }
        }
    }

    /// A permutation of all numbers of 2 `half` bits.
    fn walk(&self, index: u64) -> u64 {
        let mask = (1u64 << self.half) - 1;
        let (mut left, mut right) = (index >> self.half, index & mask);
        for key in self.keys {
            (left, right) = (right, left ^ (keyed(key, right) >> (u64::BITS - self.half)));
        }
        left << self.half | right
    }
}

#[derive(Debug)]
pub struct LatinHypercube {
    strata: u64,
    /// Permutations of each dimension, one for each hypercube.
    permutations: Vec<Vec<Permutation>>,
    within: Vec<Stream>,
}

impl PointSource for LatinHypercube {
    fn fill(&mut self, block: u64, u: &mut [[f64; BLOCK]]) {
        const LAST: f64 = 1.0 - f64::EPSILON / 2.0;
        let n = self.strata as f64;
        for ((permutations, within), u) in self.permutations.iter().zip(&mut self.within).zip(u) {
            within.uniforms(block, u);
            let replicates = permutations.len() as u64;
            for (lane, u) in u.iter_mut().enumerate() {
                let point = (block * BLOCK as u64 + lane as u64).saturating_sub(1);
                let permutation = &permutations[(point % replicates) as usize];
                *u = ((permutation.image(point / replicates % self.strata) as f64 + *u) / n).min(LAST);
            }
        }
    }
}

impl Kind for LatinHypercube {
    const FACTS: Facts = Facts {
        depends_on_samples: Some([
            "whose strata are 1/(samples - 1) wide",
            "write samples in the file for a hypercube of that size, or use sobol, whose rows stay",
        ]),
        excludes_correlation: Some([
            "a design for correlated parameters: with [[correlate]] only the first would stay stratified",
            "delete [[correlate]], or use sobol",
        ]),
        ..Facts::new("latin_hypercube", &[REPLICATES], &[])
    };

    fn points(written: &Written, dimensions: Dimensions<'_>) -> Self {
        let Dimensions { seed, samples, names, .. } = dimensions;
        let strata = (samples.saturating_sub(1) / replicates::count(written)).max(1);
        let permutation = |name: &String| Permutation::new(strata, key(seed, name, *b"latin   "));
        let scrambled = replicates::scrambling_names(written, names);
        let of_dimension = |dimension: usize| scrambled.iter().map(|names| permutation(&names[dimension])).collect();
        let permutations = (0..names.len()).map(of_dimension).collect();
        LatinHypercube { strata, permutations, within: streams(seed, names) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// H0: over keys, all 120 permutations of five are alike. n = 24,000 keys, chi-square with 119 degrees of freedom,
    /// alpha = 1e-3: critical 172.4. Power: were one permutation in ten missing, the statistic would be above 2000.
    #[test]
    fn all_permutations_of_five_are_alike() {
        let mut counts = std::collections::HashMap::new();
        for key in 0..24_000 {
            let permutation = Permutation::new(5, key);
            *counts.entry(std::array::from_fn::<u64, 5, _>(|k| permutation.image(k as u64))).or_insert(0) += 1;
        }
        assert_eq!(counts.len(), 120);
        let chi: f64 = counts.values().map(|count| (f64::from(*count) - 200.0).powi(2) / 200.0).sum();
        assert!(chi < 172.4, "{chi}");
    }
}
