//! Hashes of 64 bits for shuffling in designs; not a generator of draws.

/// The golden ratio's fraction in 64 bits: separates neighbouring counters.
pub const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;

/// Mixes 64 bits one to one (variant 13 of D. Stafford's finalisers, as in G. L. Steele, D. Lea & C. H. Flood, *Fast
/// splittable pseudorandom number generators*, OOPSLA 2014).
#[inline(always)]
pub const fn mix(x: u64) -> u64 {
    let x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

#[inline(always)]
pub const fn keyed(key: u64, counter: u64) -> u64 {
    mix(key ^ mix(counter.wrapping_mul(GOLDEN).wrapping_add(GOLDEN)))
}

/// A whole number below `bound` > 0 from a hash; the bias is below `bound`/2^64.
#[inline(always)]
pub const fn below(hash: u64, bound: u64) -> u64 {
    ((hash as u128 * bound as u128) >> 64) as u64
}

#[cfg(test)]
mod tests {
    use super::*;

    /// SplitMix64 with seed 1234567: the first numbers of the authors' reference (S. Vigna, splitmix64.c).
    #[test]
    fn the_mixer_is_that_of_splitmix64() {
        let number = |k: u64| mix(1_234_567u64.wrapping_add(GOLDEN.wrapping_mul(k)));
        assert_eq!(
            [1, 2, 3].map(number),
            [6_457_827_717_110_365_317, 3_203_168_211_198_807_973, 9_817_491_932_198_370_423]
        );
    }
}
