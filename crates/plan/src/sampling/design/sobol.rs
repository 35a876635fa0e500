//! `sobol`: Sobol's sequence with the direction numbers of Joe and Kuo and nested uniform scrambling.
//!
//! Directions: S. Joe & F. Y. Kuo, *Constructing Sobol sequences with better two-dimensional projections*, SIAM J. Sci.
//! Comput. 30 (2008) 2635, new-joe-kuo-6, first 512 dimensions. Scrambling: A. B. Owen, *Randomly permuted (t,m,s)-nets
//! and (t,s)-sequences* (1995): a hash of the dimension's key and the bits above flips each of the leading 32 bits, one
//! hash the bits below. Point 0 is used (A. B. Owen, *On dropping the first Sobol' point*, 2020): the sequence is best
//! in 2^m points, 2^m + 1 samples with the nominal one.

use super::prelude::*;
use std::collections::HashMap;

use super::replicates::Sequence;
use crate::sampling::stream::unit;

/// Dimensions in the table of directions.
pub const MAX_DIMENSIONS: usize = 512;
/// Bits that are scrambled one by one.
const NESTED: u32 = 32;

/// d, s, a, m_1 ... m_s of each dimension after the first; the licence is in the same folder.
const DIRECTIONS: &str = include_str!("../../../../../assets/joe-kuo-6.512");

#[derive(Clone, Debug)]
pub struct Sobol {
    directions: Vec<[u64; 64]>,
    keys: Vec<u64>,
}

impl Sequence for Sobol {
    const NAME: &'static str = "sobol";
    const MAX_DIMENSIONS: usize = MAX_DIMENSIONS;

    /// Directions follow from the position of a dimension.
    fn new(seed: u64, names: &[String]) -> Self {
        let keys = names.iter().map(|name| key(seed, name, *b"sobol   ")).collect();
        Sobol { directions: directions(names.len()), keys }
    }

    fn number(&self, dimension: usize, point: u64) -> f64 {
        unit(scrambled(self.bits(dimension, point), self.keys[dimension]))
    }
}

impl Sobol {
    /// The point before scrambling, as a binary fraction of 64 bits.
    pub fn bits(&self, dimension: usize, point: u64) -> u64 {
        let directions = &self.directions[dimension];
        let (mut bits, mut rest) = (0, point);
        while rest != 0 {
            bits ^= directions[rest.trailing_zeros() as usize];
            rest &= rest - 1;
        }
        bits
    }
}

/// The binary fractions of the first `count` dimensions, by the recurrence of the primitive polynomial (Joe & Kuo 2008,
/// (2)).
fn directions(count: usize) -> Vec<[u64; 64]> {
    // the first dimension is van der Corput's sequence
    let first = std::array::from_fn(|k| 1u64 << (63 - k));
    let others = DIRECTIONS.lines().skip(1).map(|line| {
        let numbers: Vec<u64> = line.split_ascii_whitespace().filter_map(|word| word.parse().ok()).collect();
        let (degree, a, initial) = (numbers[1] as usize, numbers[2], &numbers[3..]);
        let mut v = [0u64; 64];
        for k in 0..64 {
            if k < degree {
                v[k] = initial[k] << (63 - k);
                continue;
            }
            v[k] = v[k - degree] ^ (v[k - degree] >> degree);
            for j in 1..degree {
                if (a >> (degree - 1 - j)) & 1 == 1 {
                    v[k] ^= v[k - j];
                }
            }
        }
        v
    });
    std::iter::once(first).chain(others).take(count).collect()
}

/// Numbers of leading bits of one dimension and of the other two in [`bound`]: a test has at most nine cells of an
/// input, and the bits below the second of two inputs make 4% of their product, for normal numbers.
const BITS: [u32; 2] = [3, 2];
/// Correlation of two functions of leading bits above which their dimensions are bound: a sixteenth of the variance.
const BOUND: f64 = 0.25;

/// Three dimensions (the last two may be equal) whose leading bits are bound in the first `points` points: those of the
/// first equal the product of the others' or its opposite. Scrambling flips the leading bits of all points alike and
/// keeps this: an input without effect appears to have the effect of an interaction of the others.
pub fn bound(dimensions: usize, points: u64) -> Option<[usize; 3]> {
    // the parity of some leading bits of a dimension is the parity of these bits of the point's number
    let parities = |directions: &[u64; 64], bits: u32| -> Vec<u64> {
        let of_bit = |bit: u32| (0..64).fold(0, |mask, k| mask | (directions[k] >> (63 - bit) & 1) << k);
        let of_set = |set: u32| (0..bits).filter(|bit| set >> bit & 1 == 1).fold(0, |mask, bit| mask ^ of_bit(bit));
        (1..1 << bits).map(of_set).collect()
    };
    let least = BOUND * points as f64;
    // a sum of signs over all points is at most 2^m, m being the number of trailing zeros of the mask
    let zeros = (1_u64 << libm::log2(least.max(1.0)).ceil() as u32) - 1;
    let is_bound = |mask: u64| {
        let period = (mask & mask.wrapping_neg()).saturating_mul(2);
        let rest = if mask == 0 { points } else { points % period };
        let sum = if mask == 0 { points } else { rest.min(period - rest) };
        sum as f64 > least
    };
    let directions = directions(dimensions);
    let mut first: HashMap<u64, Vec<(usize, u64)>> = HashMap::new();
    for (dimension, of) in directions.iter().enumerate() {
        for mask in parities(of, BITS[0]) {
            first.entry(mask & zeros).or_default().push((dimension, mask));
        }
    }
    let others: Vec<Vec<u64>> = directions.iter().map(|of| parities(of, BITS[1])).collect();
    for (j, of_j) in others.iter().enumerate() {
        for (k, of_k) in others[..=j].iter().enumerate() {
            let products = of_j.iter().flat_map(|a| of_k.iter().map(move |b| if k == j { *a } else { a ^ b }));
            for product in products {
                let found = first.get(&(product & zeros)).into_iter().flatten();
                let mut found = found.filter(|(i, mask)| *i != j && *i != k && is_bound(mask ^ product));
                if let Some((i, _)) = found.next() {
                    return Some([*i, k, j]);
                }
            }
        }
    }
    None
}

fn scrambled(bits: u64, key: u64) -> u64 {
    let mut flips = keyed(key, bits >> NESTED) >> NESTED;
    for level in 0..NESTED {
        // the node in the binary tree of leading bits: a one, and the bits above this one
        let node = (1u64 << level) | (bits >> 1 >> (63 - level));
        // counters of the nodes are below 2^32; counters of the bits below start there
        flips |= (keyed(key ^ NODES, node) >> 63) << (63 - level);
    }
    bits ^ flips
}

const NODES: u64 = 0x6e6f_6465_735f_6f66;

#[cfg(test)]
mod tests {
    use super::*;

    fn names(count: usize) -> Vec<String> {
        (0..count).map(|k| format!("d{k}")).collect()
    }

    /// Points 1, 2, 3 and 1000 of scipy.stats.qmc.Sobol(512, scramble=False, bits=62) in the dimensions 1, 2, 3, 10,
    /// 100, 512, in the order of Gray's code (point k ^ (k >> 1)), times 2^20.
    #[test]
    fn unscrambled_points_are_those_of_scipy() {
        let sobol = Sobol::new(0, &names(512));
        let leading = |dimension: usize, point: u64| sobol.bits(dimension - 1, point) >> 44;
        let expected: &[(u64, [u64; 6])] = &SCIPY;
        for (point, row) in expected {
            assert_eq!([1, 2, 3, 10, 100, 512].map(|dimension| leading(dimension, *point)), *row, "point {point}");
        }
    }

    const SCIPY: [(u64, [u64; 6]); 4] = [
        (1, [524288, 524288, 524288, 524288, 524288, 524288]),
        (2, [262144, 786432, 786432, 262144, 262144, 262144]),
        (3, [786432, 262144, 262144, 786432, 786432, 786432]),
        (1000, [97280, 168960, 472064, 128000, 525312, 683008]),
    ];

    /// Known from another program: the largest number of dimensions none of which is bound among so many points. Law:
    /// the mean product of the signs of leading bits is 1 for bound dimensions, less for others.
    #[test]
    fn bound_dimensions_are_known() {
        for (points, most) in [(32, 2), (64, 2), (128, 3), (256, 3), (512, 5), (1024, 6), (2048, 10), (4096, 13)] {
            assert!(bound(most, points).is_none() && bound(most + 1, points).is_some(), "{points}");
        }
        assert!(bound(512, 64).is_some() && bound(1, 1).is_none());
        let sobol = Sobol::new(3, &names(12));
        let sign = |dimension: usize, point: u64| if sobol.number(dimension, point) < 0.5 { -1.0 } else { 1.0 };
        let goes_with = |i: usize, [j, k]: [usize; 2]| {
            // the sign of the first, and both signs of its second bit
            let quarter = |point: u64| (sobol.number(i, point) * 4.0) as usize % 2;
            let sum = |weight: &dyn Fn(u64) -> f64| {
                (0..64).map(|point| weight(point) * sign(j, point) * sign(k, point)).sum::<f64>().abs()
            };
            sum(&|point| sign(i, point)).max(sum(&|point| 2.0 * quarter(point) as f64 - 1.0)) / 64.0
        };
        let triples = (0..12).flat_map(|i| (0..12).flat_map(move |j| (0..j).map(move |k| (i, [j, k]))));
        let most = triples.filter(|(i, of)| !of.contains(i)).map(|(i, of)| goes_with(i, of)).fold(0.0, f64::max);
        assert_eq!(most, 1.0, "twelve dimensions in 64 points");
        assert!(goes_with(2, [0, 1]) < 1.0);
    }
}
