//! `halton`: Halton's sequence (*Numer. Math.* 2 (1960) 84) with random digit permutations.
//!
//! In base b the number of a point is its radical inverse, each digit permuted by an independent random permutation of
//! 0..b (A. B. Owen, *A randomized Halton algorithm in R* (2017)). Unscrambled, neighbouring large bases are nearly
//! proportional; a random line a d + c for each digit is cheaper, but leaves correlations of 0.5 between pairs in 12
//! dimensions with 256 points. Digits continue below those of the point, to about 2^-52.

use super::hash::below;
use super::prelude::*;
use super::replicates::Sequence;
use super::sobol::MAX_DIMENSIONS;

/// Most cells of the finest scrambled digit: half a cell still shows next to one.
const FINEST: u64 = 1 << 52;

#[derive(Clone, Debug)]
struct Radix {
    base: u64,
    /// The permutation of each digit, `base` images each, from the lowest digit of the point. Bases are below 2^16.
    permutations: Vec<u16>,
    weights: Vec<u64>,
    /// Sum of the images of zero of this digit and all after it.
    rests: Vec<u64>,
    cells: f64,
}

#[derive(Clone, Debug)]
pub struct Halton {
    dimensions: Vec<Radix>,
}

impl Sequence for Halton {
    const NAME: &'static str = "halton";
    const MAX_DIMENSIONS: usize = MAX_DIMENSIONS;

    /// Bases are the primes in order.
    fn new(seed: u64, names: &[String]) -> Self {
        let bases = primes(names.len());
        let dimensions = names.iter().zip(bases).map(|(name, base)| Radix::new(base, key(seed, name, *b"halton  ")));
        Halton { dimensions: dimensions.collect() }
    }

    fn number(&self, dimension: usize, point: u64) -> f64 {
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
        let weights: Vec<u64> = (1..=digits).map(|digit| cells / base.pow(digit)).collect();
        let permutations: Vec<u16> = (0..u64::from(digits)).flat_map(|digit| permutation(base, key, digit)).collect();
        let mut radix = Radix { base, permutations, weights, rests: Vec::new(), cells: cells as f64 };
        radix.add_rests();
        radix
    }

    fn add_rests(&mut self) {
        let mut rest = 0;
        self.rests = vec![0; self.weights.len() + 1];
        for digit in (0..self.weights.len()).rev() {
            rest += self.image(digit, 0) * self.weights[digit];
            self.rests[digit] = rest;
        }
    }

    fn image(&self, digit: usize, value: u64) -> u64 {
        u64::from(self.permutations[digit * self.base as usize + value as usize])
    }

    fn number(&self, point: u64) -> f64 {
        let (mut cell, mut rest, mut digit) = (0, point, 0);
        while rest != 0 && digit < self.weights.len() {
            cell += self.image(digit, rest % self.base) * self.weights[digit];
            rest /= self.base;
            digit += 1;
        }
        ((cell + self.rests[digit]) as f64 + 0.5) / self.cells
    }
}

/// A random permutation of 0..`base` (Fisher and Yates): swap `i` of a digit uses hash `digit` `base` + `i`.
fn permutation(base: u64, key: u64, digit: u64) -> Vec<u16> {
    let mut images: Vec<u16> = (0..base as u16).collect();
    for i in (1..base).rev() {
        images.swap(i as usize, below(keyed(key, digit * base + i), i + 1) as usize);
    }
    images
}

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

/// Least part of a period of three dimensions that separates their effects: from a quarter on, a third input is named
/// as seldom as stated (measured over interactions of two, `false_names`).
const PARTS: u64 = 4;

/// The last three of `dimensions` dimensions, if the points do not cover the combinations of their leading digits
/// evenly: these repeat after the product of the three bases.
pub fn bound(dimensions: usize, points: u64) -> Option<[usize; 3]> {
    let last: [usize; 3] = core::array::from_fn(|back| dimensions.wrapping_sub(1 + back));
    let period: u64 = primes(dimensions).iter().rev().take(3).product();
    (dimensions > 2 && period > PARTS * points).then_some(last)
}
