//! Share of a variance due to repetition alone, from pairs of values under equal conditions.
//!
//! One-way random effects with pairs as groups (R. A. Fisher, *Statistical Methods for Research Workers*, 1925,
//! intraclass correlation): the variance within pairs, the mean of (a - b)^2/2, over the variance about the mean of
//! all, with the interval of [`super::jackknife`].
//!
//! Unseen events ask for another interval of yes-or-no values. Let r be the share of pairs with two events among pairs
//! with any, and m the share of the latter among all; both have Clopper-Pearson intervals. The share within is (1 -
//! r)/(1 + r)/(1 - p), p = m (1 + r)/2, and its ends combine the distances of those of r and m as root sum of squares
//! (G. Y. Zou & A. Donner, *Stat. Med.* 27 (2008) 1693).

use super::binomial;
use super::jackknife::{Estimate, explained_share};

/// Fewest values other than the most frequent one.
pub const FEWEST_OTHERS: usize = 10;

/// Number of values other than the most frequent one.
pub fn others(pairs: &[[f64; 2]]) -> usize {
    let mut values: Vec<f64> = pairs.iter().flatten().copied().collect();
    values.sort_unstable_by(f64::total_cmp);
    values.len() - values.chunk_by(|a, b| a == b).map(<[f64]>::len).max().unwrap_or(0)
}

/// Share of the variance within `pairs`; `None` if all values are equal, or fewer than [`FEWEST_OTHERS`] differ.
pub fn share_within(pairs: &[[f64; 2]], confidence: f64) -> Option<Estimate> {
    let count = pairs.len();
    let mean = pairs.iter().flatten().sum::<f64>() / (2 * count) as f64;
    let parts =
        |[a, b]: &[f64; 2]| [0.5 * (a - b) * (a - b), 0.5 * ((a - mean) * (a - mean) + (b - mean) * (b - mean))];
    let [within, whole] = pairs.iter().map(parts).fold([0.0; 2], |[w, all], [x, y]| [w + x, all + y]);
    if count < 2 || whole.is_nan() || whole <= 0.0 {
        return None;
    }
    if within == 0.0 {
        return Some(Estimate { value: 0.0, lower: 0.0, upper: 0.0 });
    }
    let others = others(pairs);
    if others < FEWEST_OTHERS {
        return None;
    }
    let first = pairs[0][0];
    let second = pairs.iter().flatten().copied().find(|value| *value != first)?;
    if pairs.iter().flatten().all(|value| *value == first || *value == second) {
        let has_first = pairs.iter().flatten().filter(|value| **value == first).count();
        let event = if has_first == others { first } else { second };
        return Some(of_yes_or_no(pairs, event, confidence));
    }
    let shares = pairs.iter().map(parts).map(|[x, y]| [x / within, y / whole]);
    let between = explained_share(within / whole, count, shares, confidence);
    let [value, lower, upper] = [between.value, between.upper, between.lower].map(|share| (1.0 - share).min(1.0));
    Some(Estimate { value, lower, upper })
}

/// [`share_within`] for pairs of two values, `event` being the rarer one.
fn of_yes_or_no(pairs: &[[f64; 2]], event: f64, confidence: f64) -> Estimate {
    let in_pair = |count: usize| {
        pairs.iter().filter(|pair| pair.iter().filter(|value| **value == event).count() == count).count() as u64
    };
    let (one, both, all) = (in_pair(1), in_pair(2), pairs.len() as u64);
    // above one if pairs happen to be less alike than independent runs
    let share = |r: f64, m: f64| (1.0 - r) / (1.0 + r) / (1.0 - 0.5 * m * (1.0 + r));
    let (r, m) = (both as f64 / (one + both) as f64, (one + both) as f64 / all as f64);
    let [r_lower, r_upper] = binomial::interval(both, one + both, confidence);
    let [m_lower, m_upper] = binomial::interval(one + both, all, confidence);
    let value = share(r, m);
    let [lower, upper] = [[r_upper, m_lower], [r_lower, m_upper]]
        .map(|[r_end, m_end]| libm::hypot(share(r_end, m) - value, share(r, m_end) - value));
    let [value, lower, upper] = [value, value - lower, value + upper].map(|share| share.clamp(0.0, 1.0));
    Estimate { value, lower, upper }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::normal;
    use crate::statistics::rank_tests::tests::Uniform;
    use crate::testing::near;

    /// Sums of scene and noise from numbers `draw(u)`, with the share `share` of noise.
    fn pairs(seed: u64, scenes: usize, share: f64, draw: &dyn Fn(f64) -> f64) -> Vec<[f64; 2]> {
        let mut u = Uniform(seed);
        let mut next = || draw(u.next());
        let pair = |_| {
            let of_scene = libm::sqrt(1.0 - share) * next();
            [0; 2].map(|_| of_scene + libm::sqrt(share) * next())
        };
        (0..scenes).map(pair).collect()
    }

    /// Law: for normal and skewed values of known share the mean estimate is right to 6%, and 95% intervals cover it in
    /// at least 92% of 1,000 repetitions with 200 pairs.
    #[test]
    fn known_shares_are_covered() {
        let skewed = |u: f64| -libm::log1p(-u) - 1.0;
        for share in [0.05, 0.5, 0.95] {
            for draw in [&normal::quantile as &dyn Fn(f64) -> f64, &skewed] {
                let (mut covered, mut total) = (0, 0.0);
                for seed in 1..=1_000 {
                    let found = share_within(&pairs(seed, 200, share, draw), 0.95).expect("values differ");
                    assert!(found.lower <= found.value && found.value <= found.upper, "{found:?}");
                    covered += u32::from(found.lower <= share && share <= found.upper);
                    total += found.value;
                }
                assert!(covered >= 920, "{share}: {covered}");
                near(total / 1_000.0, share, 0.06);
            }
        }
    }

    /// Share of noise in the variance of the event that a sum of scene and noise, both normal, exceeds a limit; `share`
    /// is the share of noise in the sum. 1 - (P(both) - p^2)/(p (1 - p)), by Simpson's rule over the scene.
    fn truth(limit: f64, share: f64) -> f64 {
        const STEPS: u32 = 4000;
        let upper_tail = |x: f64| 0.5 * libm::erfc(x * core::f64::consts::FRAC_1_SQRT_2);
        let given = |x: f64| upper_tail((limit - libm::sqrt(1.0 - share) * x) / libm::sqrt(share));
        let step = 18.0 / f64::from(STEPS);
        let both: f64 = (0..=STEPS)
            .map(|k| {
                let weight = if k == 0 || k == STEPS { 1.0 } else { f64::from(2 + 2 * (k % 2)) };
                let x = -9.0 + step * f64::from(k);
                weight * libm::exp(-0.5 * x * x) * given(x) * given(x)
            })
            .sum();
        let both = both * step / 3.0 / libm::sqrt(2.0 * core::f64::consts::PI);
        let p = upper_tail(limit);
        1.0 - (both - p * p) / (p * (1.0 - p))
    }

    /// H0: 95% intervals of yes-or-no values cover the share in at least 0.95 of the campaigns that have one; n = 300
    /// for each probability, share and number of scenes, seeds 1 to 300, alpha = 1e-3 for each of 24. Power: the
    /// jackknife covers 0.53 to 0.64 of rare events, as in the counter-test.
    #[test]
    fn shares_of_a_yes_or_no_are_covered() {
        let counts = |limit: f64, share: f64, scenes: usize| {
            let truth = truth(limit, share);
            let (mut estimated, mut covered, mut of_jackknife) = (0_u64, 0_u64, 0_u64);
            for seed in 1..=300 {
                let pairs: Vec<[f64; 2]> = pairs(seed, scenes, share, &normal::quantile)
                    .into_iter()
                    .map(|pair| pair.map(|value| if value > limit { 1.0 } else { 0.0 }))
                    .collect();
                let Some(found) = share_within(&pairs, 0.95).filter(|found| found.value > 0.0) else { continue };
                assert!(found.lower <= found.value && found.value <= found.upper, "{found:?}");
                estimated += 1;
                covered += u64::from(found.lower <= truth && truth <= found.upper);
                // a third value in one pair sends the others to the jackknife
                let mut other = pairs;
                other[0][0] += 1e-9;
                let found = share_within(&other, 0.95).expect("values differ");
                of_jackknife += u64::from(found.lower <= truth && truth <= found.upper);
            }
            (estimated, covered, of_jackknife)
        };
        for scenes in [32, 256] {
            for limit in [2.05, 1.28, 0.0] {
                for share in [0.1, 0.5, 0.8, 0.95] {
                    let (estimated, covered, _) = counts(limit, share, scenes);
                    let is_rare = |missed: u64| binomial::at_least(missed, estimated, 0.05) < 1e-3;
                    assert!(!is_rare(estimated - covered), "{scenes} {limit} {share}: {covered} of {estimated}");
                }
            }
        }
        let (estimated, _, of_jackknife) = counts(2.05, 0.8, 256);
        assert!(of_jackknife < estimated * 8 / 10, "the counter-test: {of_jackknife} of {estimated}");
    }

    /// Law: there is no share with fewer than ten other values or without two pairs, unless nothing differs within
    /// pairs: then it is zero.
    #[test]
    fn few_events_have_no_share() {
        let pairs = |one: usize, both: usize| -> Vec<[f64; 2]> {
            (0..200).map(|k| [if k < one + both { 1.0 } else { 0.0 }, if k < both { 1.0 } else { 0.0 }]).collect()
        };
        assert_eq!((others(&pairs(3, 3)), share_within(&pairs(3, 3), 0.95)), (9, None));
        let found = share_within(&pairs(10, 0), 0.95).expect("ten events");
        assert!(found.value == 1.0 && found.upper == 1.0 && found.lower < 0.6, "{found:?}");
        assert_eq!(share_within(&pairs(0, 2), 0.95).map(|found| found.value), Some(0.0));
        assert_eq!(others(&[[1.0, 2.0], [1.0, 3.0]]), 2);
        let none = Estimate { value: 0.0, lower: 0.0, upper: 0.0 };
        assert_eq!(share_within(&[[1.0, 1.0], [2.0, 2.0], [4.0, 4.0]], 0.95), Some(none));
        assert_eq!([&[[1.0, 2.0]][..], &[[3.0; 2]; 2]].map(|pairs| share_within(pairs, 0.95)), [None; 2]);
    }
}
