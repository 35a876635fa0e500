//! Exact inference about a fraction from counts: the binomial distribution, Clopper-Pearson bounds, and the test behind a
//! requirement.
//!
//! C. J. Clopper & E. S. Pearson, *The use of confidence or fiducial limits illustrated in the case of the binomial*, Biometrika 26
//! (1934) 404. Counts are of independent runs; designs that lay samples out together need other intervals.

use crate::math::incomplete_beta::{incomplete_beta, inverse_incomplete_beta};

/// P(X <= k) of a binomial variable: `trials` trials with probability `p` in [0, 1] each.
pub fn at_most(k: u64, trials: u64, p: f64) -> f64 {
    if k >= trials { 1.0 } else { incomplete_beta(p, 1.0 - p, k as f64 + 1.0, (trials - k) as f64).upper }
}

/// P(X >= k) of a binomial variable: `trials` trials with probability `p` in [0, 1] each.
pub fn at_least(k: u64, trials: u64, p: f64) -> f64 {
    match k {
        0 => 1.0,
        _ if k > trials => 0.0,
        _ => incomplete_beta(p, 1.0 - p, k as f64, (trials - k) as f64 + 1.0).lower,
    }
}

/// One-sided lower confidence bound of a fraction with `successes` in `trials` (Clopper-Pearson).
///
/// With probability `confidence` or more the bound is not above the true fraction.
pub fn lower_bound(successes: u64, trials: u64, confidence: f64) -> f64 {
    if successes == 0 {
        return 0.0;
    }
    inverse_incomplete_beta(1.0 - confidence, confidence, successes as f64, (trials - successes) as f64 + 1.0)[0]
}

/// One-sided upper confidence bound of a fraction with `successes` in `trials` (Clopper-Pearson).
pub fn upper_bound(successes: u64, trials: u64, confidence: f64) -> f64 {
    if successes >= trials {
        return 1.0;
    }
    inverse_incomplete_beta(confidence, 1.0 - confidence, successes as f64 + 1.0, (trials - successes) as f64)[0]
}

/// Two-sided equal-tailed confidence interval of a fraction (Clopper-Pearson).
pub fn interval(successes: u64, trials: u64, confidence: f64) -> [f64; 2] {
    let one_sided = 0.5 + 0.5 * confidence;
    [lower_bound(successes, trials, one_sided), upper_bound(successes, trials, one_sided)]
}

/// What counts say of the requirement that at least a given fraction of runs succeeds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Decision {
    /// The one-sided lower bound reaches the target.
    Pass,
    /// The one-sided upper bound misses it.
    Fail,
    /// Neither; the number of runs that would decide if the observed fraction stayed as it is, where there is any.
    Undecided(Option<u64>),
}

/// Beyond this many runs, a requirement counts as one that no number of runs decides.
pub const MAX_RUNS: u64 = 1_000_000_000_000;

/// Decides whether a fraction of at least `target` in (0, 1) succeeds, at `confidence`, from `successes` in `trials`.
///
/// The bounds are not computed: the lower bound reaches the target exactly where P(X >= successes) at the target is at most
/// 1 - confidence, and the same for the upper one. So no rounding of an inverse decides.
pub fn decide(successes: u64, trials: u64, target: f64, confidence: f64) -> Decision {
    match decided(successes, trials, target, confidence) {
        Some(true) => Decision::Pass,
        Some(false) => Decision::Fail,
        None => Decision::Undecided(deciding_runs(successes, trials, target, confidence)),
    }
}

/// Whether the requirement is met (true), missed (false), or neither can be said.
fn decided(successes: u64, trials: u64, target: f64, confidence: f64) -> Option<bool> {
    let risk = 1.0 - confidence;
    if trials == 0 {
        None
    } else if at_least(successes, trials, target) <= risk {
        Some(true)
    } else if at_most(successes, trials, target) <= risk {
        Some(false)
    } else {
        None
    }
}

/// The smallest number of runs, at least `trials`, that decides if the fraction of successes stays what it is; `None` where no
/// number up to [`MAX_RUNS`] does.
///
/// Successes are whole: of n runs round(n f). The decision is not monotonic in n run by run (rounding), hence the last undecided
/// number is looked for from above by bisection, and the result is within one step of rounding (1/f or 1/(1 - f) runs).
fn deciding_runs(successes: u64, trials: u64, target: f64, confidence: f64) -> Option<u64> {
    if trials == 0 {
        return None;
    }
    let fraction = successes as f64 / trials as f64;
    let decides = |n: u64| decided((fraction * n as f64).round() as u64, n, target, confidence).is_some();
    let (mut low, mut high) = (trials, trials);
    while !decides(high) {
        low = high;
        high = high.checked_mul(2).filter(|high| *high <= MAX_RUNS)?;
    }
    while high - low > 1 {
        let middle = low + (high - low) / 2;
        if decides(middle) { high = middle } else { low = middle }
    }
    Some(high)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The sum of terms, for small numbers of trials.
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
                    assert!((at_most(k, trials, p) / sum(0..=k, trials, p) - 1.0).abs() < 2e-13);
                    assert!((at_least(k, trials, p) / sum(k..=trials, trials, p) - 1.0).abs() < 3e-13);
                }
            }
        }
    }

    /// Law: a bound at a confidence is the fraction at which what was seen, or more (or less), has the rest for a probability.
    #[test]
    fn bounds_invert_the_tails() {
        for (successes, trials) in [(1, 10), (9, 10), (10, 10), (0, 10), (590, 600), (999_000, 1_000_000)] {
            for confidence in [0.8, 0.95, 0.999] {
                let lower = lower_bound(successes, trials, confidence);
                let upper = upper_bound(successes, trials, confidence);
                let risk = 1.0 - confidence;
                // measured 3.8e-12 and 3.1e-12: of a million trials, rounding of a bound moves the tail by that much
                if successes > 0 {
                    assert!((at_least(successes, trials, lower) / risk - 1.0).abs() < 3e-11, "{successes}/{trials}");
                }
                if successes < trials {
                    assert!((at_most(successes, trials, upper) / risk - 1.0).abs() < 3e-11, "{successes}/{trials}");
                }
                assert!(lower <= successes as f64 / trials as f64 && successes as f64 / trials as f64 <= upper);
            }
        }
        // none in n: the rule of three, exactly 1 - (1 - confidence)^(1/n)
        let upper = upper_bound(0, 59, 0.95);
        // measured 1.1e-16
        assert!((upper - (1.0 - libm::pow(0.05, 1.0 / 59.0))).abs() < 1e-15, "{upper}");
    }

    /// Published: 59 runs without a failure show 95% with 95% confidence (S. S. Wilks, Ann. Math. Statist. 12 (1941) 91).
    #[test]
    fn fifty_nine_successes_decide_95_95() {
        assert_eq!(decide(59, 59, 0.95, 0.95), Decision::Pass);
        assert_eq!(decide(58, 58, 0.95, 0.95), Decision::Undecided(Some(59)));
        assert_eq!(decide(10, 59, 0.95, 0.95), Decision::Fail);
        assert_eq!(decide(0, 0, 0.95, 0.95), Decision::Undecided(None));
        assert_eq!(decide(95, 100, 0.95, 0.95), Decision::Undecided(None), "exactly at the target nothing decides");
    }

    /// Law: the number of runs that is named decides, and one well below it does not.
    #[test]
    fn the_number_of_runs_that_decides() {
        for (successes, trials, target) in [(992, 1000, 0.99), (49, 50, 0.95), (940, 1000, 0.95), (48, 50, 0.9)] {
            let Decision::Undecided(Some(needed)) = decide(successes, trials, target, 0.95) else {
                panic!("{successes} of {trials} at {target} is decided")
            };
            let at = |n: u64| decided((successes as f64 / trials as f64 * n as f64).round() as u64, n, target, 0.95);
            assert!(at(needed).is_some() && at(needed * 9 / 10).is_none(), "{needed}");
        }
    }

    /// H0: the fraction is exactly the target. Errors of the decision are at most 1 - confidence each, exactly.
    #[test]
    fn decisions_err_as_seldom_as_stated() {
        for (trials, target, confidence) in [(59, 0.95, 0.95), (200, 0.5, 0.9), (1000, 0.99, 0.99)] {
            let probability =
                |k: u64| at_most(k, trials, target) - if k == 0 { 0.0 } else { at_most(k - 1, trials, target) };
            let of = |met: bool| -> f64 {
                (0..=trials).filter(|k| decided(*k, trials, target, confidence) == Some(met)).map(probability).sum()
            };
            let risk = 1.0 - confidence + 1e-12;
            assert!(of(true) <= risk && of(false) <= risk, "{} {}", of(true), of(false));
            // and not needlessly seldom: within a factor that the lumps of small counts explain
            assert!(of(true) > 0.2 * risk, "{}", of(true));
        }
    }
}
