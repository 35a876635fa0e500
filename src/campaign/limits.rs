//! Limits of the keys of a campaign file that are not scene parameters.

use super::section::Limit;

/// Largest number of samples of a campaign: ids stay exact in a double.
pub const MAX_SAMPLES: u64 = crate::sampling::design::MAX_SAMPLES;
/// Largest seed: TOML integers are signed.
pub const LARGEST_SEED: u64 = i64::MAX as u64;
/// Largest number of observation points of a run: each worker stores the states at all of them (some 40 numbers each).
pub const MAX_POINTS: u64 = 10_000_000;
/// Tolerances between a few units in the last place and the point where nothing is accurate any more.
pub const TOLERANCE: Limit = Limit {
    allowed: "a number from 1e-16 to 1e-2",
    remedy: "1e-10 is a good start",
    test: |x| (1e-16..=1e-2).contains(&x),
};

/// A share of the samples.
pub const FRACTION: Limit = Limit {
    allowed: "a number from 0 to 1",
    remedy: "0.01 runs one sample in a hundred again exactly, 1 all of them",
    test: |x| (0.0..=1.0).contains(&x),
};
