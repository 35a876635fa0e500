//! Limits of the keys of a campaign file that are not scene parameters.

use super::numbers::NumberLimit;

/// Largest number of samples of a campaign: ids stay exact in a double.
pub const MAX_SAMPLES: u64 = crate::sampling::design::MAX_SAMPLES;
/// Largest seed: TOML integers are signed.
pub const LARGEST_SEED: u64 = i64::MAX as u64;
/// Largest number of observation points: some gigabytes in each thread.
pub const MAX_POINTS: u64 = 1_000_000;

/// Tolerances between a few units in the last place and the point where nothing is accurate any more.
pub const TOLERANCE: NumberLimit = NumberLimit {
    allowed: "a number from 1e-16 to 1e-2",
    remedy: "1e-10 is a good start",
    test: |x| (1e-16..=1e-2).contains(&x),
};

/// A probability that is neither impossible nor certain.
pub const PROBABILITY: NumberLimit = NumberLimit {
    allowed: "a number between 0 and 1, neither included",
    remedy: "write it like 0.99",
    test: |x| x > 0.0 && x < 1.0,
};

/// Confidence of an interval or a decision.
pub const CONFIDENCE: NumberLimit =
    NumberLimit { allowed: "a number from 0.5 to below 1", remedy: "0.95 is usual", test: |x| (0.5..1.0).contains(&x) };

/// A share of the samples.
pub const FRACTION: NumberLimit = NumberLimit {
    allowed: "a number from 0 to 1",
    remedy: "0.01 runs one sample in a hundred again exactly, 1 all of them",
    test: |x| (0.0..=1.0).contains(&x),
};
