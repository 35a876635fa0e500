//! Exact inference about a success rate from independent trials: binomial tails, the bounds of C. J. Clopper & E. S.
//! Pearson, *Biometrika* 26 (1934) 404, and the test behind a requirement.

use crate::math::incomplete_beta::{incomplete_beta, inverse_incomplete_beta};
use crate::math::normal;

/// P(X <= k) for `trials` trials with probability `p` in [0, 1].
pub fn at_most(k: u64, trials: u64, p: f64) -> f64 {
    if k >= trials { 1.0 } else { incomplete_beta(p, 1.0 - p, k as f64 + 1.0, (trials - k) as f64).upper }
}

/// P(X >= k) for `trials` trials with probability `p` in [0, 1].
pub fn at_least(k: u64, trials: u64, p: f64) -> f64 {
    match k {
        0 => 1.0,
        _ if k > trials => 0.0,
        _ => incomplete_beta(p, 1.0 - p, k as f64, (trials - k) as f64 + 1.0).lower,
    }
}

/// One-sided lower bound (Clopper-Pearson) of the true rate.
pub fn lower_bound(successes: u64, trials: u64, confidence: f64) -> f64 {
    if successes == 0 {
        return 0.0;
    }
    inverse_incomplete_beta(1.0 - confidence, confidence, successes as f64, (trials - successes) as f64 + 1.0)[0]
}

/// One-sided upper bound (Clopper-Pearson).
pub fn upper_bound(successes: u64, trials: u64, confidence: f64) -> f64 {
    if successes >= trials {
        return 1.0;
    }
    inverse_incomplete_beta(confidence, 1.0 - confidence, successes as f64 + 1.0, (trials - successes) as f64)[0]
}

/// Equal-tailed confidence interval (Clopper-Pearson).
pub fn interval(successes: u64, trials: u64, confidence: f64) -> [f64; 2] {
    let one_sided = 0.5 + 0.5 * confidence;
    [lower_bound(successes, trials, one_sided), upper_bound(successes, trials, one_sided)]
}

/// Decision on a requirement of a smallest success rate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Decision {
    /// The lower bound reaches the target.
    Pass,
    /// The upper bound misses it.
    Fail,
    /// Neither; with a number of runs, if any, that decides with probability [`POWER`] at the observed rate.
    Undecided(Option<u64>),
}

/// Probability with which the number of runs in [`Decision::Undecided`] decides in a single look.
pub const POWER: f64 = 0.9;
/// Runs beyond which a requirement counts as undecidable.
pub const MAX_RUNS: u64 = 10_000_000_000;

/// Decides whether the success rate is at least `target` in (0, 1), at `confidence`. The tails decide, not the rounding
/// of a bound: the lower bound reaches the target if and only if P(X >= successes) there is at most 1 - confidence.
pub fn decide(successes: u64, trials: u64, target: f64, confidence: f64) -> Decision {
    let risk = 1.0 - confidence;
    if trials == 0 {
        Decision::Undecided(None)
    } else if at_least(successes, trials, target) <= risk {
        Decision::Pass
    } else if at_most(successes, trials, target) <= risk {
        Decision::Fail
    } else {
        Decision::Undecided(deciding_runs(successes, trials, target, confidence))
    }
}

/// A number of runs, at least `trials`, that decides with probability [`POWER`] at the observed rate; one run fewer
/// does not. `None` beyond [`MAX_RUNS`].
fn deciding_runs(successes: u64, trials: u64, target: f64, confidence: f64) -> Option<u64> {
    let (fraction, risk) = (successes as f64 / trials as f64, 1.0 - confidence);
    let power = |runs: u64| {
        if fraction > target {
            upper_rank(runs, target, risk).map_or(0.0, |least| at_least(least, runs, fraction))
        } else {
            lower_rank(runs, target, risk).map_or(0.0, |rank| at_most(rank - 1, runs, fraction))
        }
    };
    // first guess in the normal approximation
    let deviation = |fraction: f64| libm::sqrt(fraction * (1.0 - fraction));
    let width = normal::quantile(confidence) * deviation(target) + normal::quantile(POWER) * deviation(fraction);
    let near = width / (fraction - target);
    let near = (near * near).ceil();
    if near > MAX_RUNS as f64 || fraction == target {
        return None;
    }
    let near = near as u64;
    let found = first([trials, MAX_RUNS], [near, 1 + near / 1024], |runs| power(runs) >= POWER);
    (found < MAX_RUNS).then_some(found)
}

/// Largest r >= 1 with P(X <= r - 1) <= `risk` for X successes in `trials` of probability `p`.
pub fn lower_rank(trials: u64, p: f64, risk: f64) -> Option<u64> {
    let misses = |rank: u64| at_most(rank - 1, trials, p) > risk;
    let found = first([1, trials + 1], [near_rank(trials, p, risk), 1], misses);
    (found > 1).then(|| found - 1)
}

/// Smallest s <= `trials` with P(X >= s) <= `risk`.
pub fn upper_rank(trials: u64, p: f64, risk: f64) -> Option<u64> {
    let is_seldom = |rank: u64| at_least(rank, trials, p) <= risk;
    let found = first([1, trials + 1], [near_rank(trials, p, 1.0 - risk), 1], is_seldom);
    (found <= trials).then_some(found)
}

/// Normal approximation of the `q`-quantile of the number of successes.
fn near_rank(trials: u64, p: f64, q: f64) -> u64 {
    let n = trials as f64;
    (n * p + normal::quantile(q) * libm::sqrt(n * p * (1.0 - p))) as u64
}

/// First number in [low, high] from which on `holds` is true, or `high`: outward from `at` in steps doubling from
/// `step`, then by bisection.
fn first([mut low, mut high]: [u64; 2], [mut at, mut step]: [u64; 2], holds: impl Fn(u64) -> bool) -> u64 {
    let mut is_within = [false; 2];
    while low < high {
        at = at.clamp(low, high - 1);
        if holds(at) {
            (high, is_within[1]) = (at, true);
        } else {
            (low, is_within[0]) = (at + 1, true);
        }
        at = match is_within {
            [true, true] => low + (high - low) / 2,
            [true, false] => low.saturating_add(step),
            _ => high.saturating_sub(step),
        };
        step = step.saturating_mul(2);
    }
    high
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{close, near};

    fn sum(range: core::ops::RangeInclusive<u64>, trials: u64, p: f64) -> f64 {
        let choose = |k: u64| (1..=k).fold(1.0, |product, i| product * (trials - k + i) as f64 / i as f64);
        range.map(|k| choose(k) * libm::pow(p, k as f64) * libm::pow(1.0 - p, (trials - k) as f64)).sum()
    }

    #[test]
    fn tails_are_sums_of_terms() {
        for trials in [1, 2, 7, 30] {
            for k in 0..=trials {
                for p in [0.01, 0.3, 0.95] {
                    // measured 1.8e-14 and 3.3e-14: the incomplete beta function has some 13 digits
                    near(at_most(k, trials, p), sum(0..=k, trials, p), 2e-13);
                    near(at_least(k, trials, p), sum(k..=trials, trials, p), 3e-13);
                }
            }
        }
    }

    /// Law: at a bound, outcomes at least as extreme have the probability 1 - confidence.
    #[test]
    fn bounds_invert_the_tails() {
        for (successes, trials) in [(1, 10), (9, 10), (10, 10), (0, 10), (590, 600), (999_000, 1_000_000)] {
            for confidence in [0.8, 0.95, 0.999] {
                let lower = lower_bound(successes, trials, confidence);
                let upper = upper_bound(successes, trials, confidence);
                let risk = 1.0 - confidence;
                // measured 3.8e-12 and 3.1e-12: rounding of a bound for a million trials
                if successes > 0 {
                    near(at_least(successes, trials, lower), risk, 3e-11);
                }
                if successes < trials {
                    near(at_most(successes, trials, upper), risk, 3e-11);
                }
                assert!(lower <= successes as f64 / trials as f64 && successes as f64 / trials as f64 <= upper);
            }
        }
        // rule of three: 1 - (1 - confidence)^(1/n) without a success
        let upper = upper_bound(0, 59, 0.95);
        close(upper, 1.0 - libm::pow(0.05, 1.0 / 59.0), 1e-15);
    }

    /// Published: 59 runs without a failure show 95% at 95% (S. S. Wilks, *Ann. Math. Stat.* 12 (1941) 91).
    #[test]
    fn fifty_nine_successes_decide_95_95() {
        for (successes, trials, decision) in [
            (59, 59, Decision::Pass),
            (58, 58, Decision::Undecided(Some(59))),
            (10, 59, Decision::Fail),
            (0, 0, Decision::Undecided(None)),
            (95, 100, Decision::Undecided(None)),
        ] {
            assert_eq!(decide(successes, trials, 0.95, 0.95), decision);
        }
    }
}
