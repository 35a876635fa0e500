//! `halton`: Halton's sequence (*Numer. Math.* 2 (1960) 84), each digit scrambled by a random line.
//!
//! The number of a point in the dimension of base b is its radical inverse, in which each digit d becomes a d + c modulo b with a
//! random slope a > 0 and shift c for each digit's place (J. Matousek, *On the L2-discrepancy for anchored boxes*, J. Complexity 14
//! (1998) 527): without it neighbouring large bases are nearly proportional to each other. Digits continue beyond those of the point, so that each number
//! is uniform, down to about 2^-52.

use super::hash::{below, keyed};
use super::sobol::MAX_DIMENSIONS;
use super::traits::{BLOCK, Dimensions, Kind, PointSource, by_point};
use crate::sampling::keys::{KeyReader, KeyWriter};
use crate::sampling::stream::key;

/// Number of cells of the finest digit that is scrambled, at most: half a cell is still seen next to one.
const FINEST: u64 = 1 << 52;

/// One dimension.
#[derive(Clone, Debug)]
struct Radix {
    base: u64,
    /// Slope and shift of each digit, the first (the point's lowest, the fraction's highest) first.
    lines: Vec<(u64, u64)>,
    /// The weight of each digit, and what the shifts of this digit and all after it add up to.
    weights: Vec<u64>,
    rests: Vec<u64>,
    /// Number of cells.
    cells: f64,
}

/// The scrambled sequence in some dimensions.
#[derive(Clone, Debug)]
pub struct Halton {
    dimensions: Vec<Radix>,
}

impl Halton {
    /// The sequence for the dimensions `names`: bases by position (the primes in order), scrambling by seed and name.
    pub fn new(seed: u64, names: &[String]) -> Self {
        let bases = primes(names.len());
        let dimensions = names.iter().zip(bases).map(|(name, base)| Radix::new(base, key(seed, name, *b"halton  ")));
        Halton { dimensions: dimensions.collect() }
    }

    /// The number in (0, 1) of a point.
    pub fn number(&self, dimension: usize, point: u64) -> f64 {
        self.dimensions[dimension].number(point)
    }
}

impl Radix {
    fn new(base: u64, key: u64) -> Self {
        let mut cells = base;
        let mut digits = 1;
        while cells <= FINEST / base {
            cells *= base;
            digits += 1;
        }
        let line = |digit: u64| (1 + below(keyed(key, 2 * digit), base - 1), below(keyed(key, 2 * digit + 1), base));
        let lines: Vec<(u64, u64)> = (0..digits).map(line).collect();
        let mut weights = Vec::new();
        let mut weight = cells;
        for _ in 0..digits {
            weight /= base;
            weights.push(weight);
        }
        let mut rests = vec![0; lines.len() + 1];
        for digit in (0..lines.len()).rev() {
            rests[digit] = rests[digit + 1] + lines[digit].1 * weights[digit];
        }
        Radix { base, lines, weights, rests, cells: cells as f64 }
    }

    /// The middle of the cell of a point.
    fn number(&self, point: u64) -> f64 {
        let (mut cell, mut rest, mut digit) = (0, point, 0);
        while rest != 0 && digit < self.lines.len() {
            let (slope, shift) = self.lines[digit];
            cell += (slope * (rest % self.base) + shift) % self.base * self.weights[digit];
            rest /= self.base;
            digit += 1;
        }
        ((cell + self.rests[digit]) as f64 + 0.5) / self.cells
    }
}

/// The first `count` primes.
fn primes(count: usize) -> Vec<u64> {
    let mut primes: Vec<u64> = Vec::with_capacity(count);
    let mut candidate = 2;
    while primes.len() < count {
        if primes.iter().take_while(|prime| *prime * *prime <= candidate).all(|prime| !candidate.is_multiple_of(*prime))
        {
            primes.push(candidate);
        }
        candidate += 1;
    }
    primes
}

impl PointSource for Halton {
    fn fill(&mut self, block: u64, u: &mut [[f64; BLOCK]]) {
        by_point(block, u, |dimension, point| self.number(dimension, point));
    }
}

/// Halton's sequence, scrambled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HaltonDesign;

impl Kind for HaltonDesign {
    const NAME: &'static str = "halton";
    const MAX_DIMENSIONS: usize = MAX_DIMENSIONS;
    type Points = Halton;

    fn read(_keys: &mut dyn KeyReader) -> Option<Self> {
        Some(HaltonDesign)
    }

    fn write(&self, _keys: &mut dyn KeyWriter) {}

    fn points(&self, dimensions: Dimensions<'_>) -> Halton {
        Halton::new(dimensions.seed, dimensions.names)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bases_are_the_primes() {
        assert_eq!(primes(10), [2, 3, 5, 7, 11, 13, 17, 19, 23, 29]);
        assert_eq!(primes(512)[511], 3671);
    }

    /// Law: of any b^m consecutive points from a multiple of b^m one lies in each interval of width b^-m.
    #[test]
    fn each_interval_holds_one_point() {
        let names: Vec<String> = (0..40).map(|k| format!("d{k}")).collect();
        let halton = Halton::new(3, &names);
        for (dimension, base) in primes(40).into_iter().enumerate() {
            for cells in [base, base * base] {
                let mut counts = vec![0; cells as usize];
                for point in 7 * cells..8 * cells {
                    counts[(halton.number(dimension, point) * cells as f64) as usize] += 1;
                }
                assert!(counts.iter().all(|count| *count == 1), "base {base}");
            }
        }
    }

    #[test]
    fn without_slope_and_shift_it_is_the_radical_inverse() {
        let mut radix = Radix::new(3, 0);
        radix.lines.fill((1, 0));
        radix.rests.fill(0);
        let inverse = |point: u64| (radix.number(point) * 81.0).floor();
        // 1 = 0.1, 5 = 0.21, 26 = 0.222 in base 3
        assert_eq!([1, 5, 26].map(inverse), [27.0, 63.0, 78.0]);
    }

    #[test]
    fn numbers_stay_inside_for_any_point() {
        let names: Vec<String> = (0..512).map(|k| format!("d{k}")).collect();
        let halton = Halton::new(1, &names);
        for dimension in 0..512 {
            for point in [0, 1, 12_345, 1 << 40, (1 << 53) - 1, u64::MAX] {
                let u = halton.number(dimension, point);
                assert!(u > 0.0 && u < 1.0, "{dimension} {point} {u}");
            }
        }
    }
}
