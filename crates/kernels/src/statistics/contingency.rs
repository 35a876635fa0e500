//! Tables of two groups of runs and an event.
//!
//! - Exact test: R. A. Fisher, *J. Roy. Stat. Soc.* 98 (1935) 39; two-sided as R's `fisher.test`.
//! - Interval of the risk ratio, also for counts of zero: P. A. R. Koopman, *Biometrics* 40 (1984) 513, the ratios that
//!   the score test does not reject.

use super::jackknife::Estimate;
use crate::math::normal;

/// Occurrences of an event in a group of runs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Occurrence {
    /// Runs with the event.
    pub events: u64,
    /// All runs of the group.
    pub runs: u64,
}

/// Relative difference of probabilities that counts as rounding, as in R.
const SAME: f64 = 1e-7;

/// Two-sided p-value if the event does not depend on the group: the sum over all tables with these margins that are at
/// most as likely. The time grows with the number of events.
pub fn fisher(one: Occurrence, other: Occurrence) -> f64 {
    let events = one.events + other.events;
    let (first, last) = (events.saturating_sub(other.runs), events.min(one.runs));
    // P(k + 1)/P(k) of the hypergeometric distribution
    let step = |k: u64| {
        let up = (events - k) as f64 * (one.runs - k) as f64;
        up / ((k + 1) as f64 * (other.runs + k + 1 - events) as f64)
    };
    // relative to the most likely table, so that no term overflows
    let mode = (u128::from(events + 1) * u128::from(one.runs + 1) / u128::from(one.runs + other.runs + 2)) as u64;
    let mode = mode.clamp(first, last);
    let mut terms = vec![0.0; (last - first + 1) as usize];
    terms[(mode - first) as usize] = 1.0;
    for k in mode..last {
        terms[(k + 1 - first) as usize] = terms[(k - first) as usize] * step(k);
    }
    for k in (first..mode).rev() {
        terms[(k - first) as usize] = terms[(k + 1 - first) as usize] / step(k);
    }
    let seen = terms[(one.events - first) as usize] * (1.0 + SAME);
    let unlikely: f64 = terms.iter().filter(|term| **term <= seen).sum();
    (unlikely / terms.iter().sum::<f64>()).min(1.0)
}

/// Ratio of the event's frequencies, first over second group, with Koopman's interval; infinite if the second has no
/// event. `None` if neither has, or a group is empty.
pub fn risk_ratio(one: Occurrence, other: Occurrence, confidence: f64) -> Option<Estimate> {
    /// Ratios of counts of 64 bits are within e^±60.
    const REACH: f64 = 60.0;
    /// Halvings of that range, to the last digit.
    const HALVINGS: usize = 64;
    if one.events + other.events == 0 || one.runs == 0 || other.runs == 0 {
        return None;
    }
    let [x1, n1, x0, n0] = [one.events, one.runs, other.events, other.runs].map(|count| count as f64);
    let value = (x1 / n1) / (x0 / n0);
    let z = normal::quantile(0.5 + 0.5 * confidence);
    let is_rejected = |logarithm: f64| {
        let ratio = libm::exp(logarithm);
        // the likeliest share of the first group at this ratio
        let sum = ratio * (n1 + x0) + x1 + n0;
        let p1 =
            2.0 * ratio * (x1 + x0) / (sum + libm::sqrt((sum * sum - 4.0 * ratio * (n1 + n0) * (x1 + x0)).max(0.0)));
        let part = |x: f64, n: f64, p: f64| {
            let off = x - n * p;
            if off == 0.0 { 0.0 } else { off * off / (n * p * (1.0 - p)) }
        };
        part(x1, n1, p1) + part(x0, n0, p1 / ratio) > z * z
    };
    let centre = libm::log(value).clamp(-REACH, REACH);
    let end = |far: f64| {
        let [mut inside, mut outside] = [centre, far];
        for _ in 0..HALVINGS {
            let middle = 0.5 * (inside + outside);
            *(if is_rejected(middle) { &mut outside } else { &mut inside }) = middle;
        }
        libm::exp(outside)
    };
    let lower = if one.events == 0 { 0.0 } else { end(-2.0 * REACH) };
    let upper = if other.events == 0 { f64::INFINITY } else { end(2.0 * REACH) };
    Some(Estimate { value, lower, upper })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{close, near};

    fn of(events: u64, runs: u64) -> Occurrence {
        Occurrence { events, runs }
    }

    fn choose(n: u64, k: u64) -> f64 {
        (0..k).fold(1.0, |product, i| product * (n - i) as f64 / (i + 1) as f64)
    }

    #[test]
    fn fisher_is_the_sum_over_tables() {
        for (a, m, b, n) in [(3, 4, 1, 4), (14, 14, 2, 20), (0, 5, 7, 9), (2, 30, 9, 25), (1, 1, 0, 40), (6, 12, 6, 12)]
        {
            let probability = |k: u64| choose(m, k) * choose(n, a + b - k) / choose(m + n, a + b);
            let tables = (a + b).saturating_sub(n)..=(a + b).min(m);
            let expected: f64 = tables.map(probability).filter(|p| *p <= probability(a) * (1.0 + 1e-7)).sum();
            let found = fisher(of(a, m), of(b, n));
            near(found, expected, 8e-14);
            near(fisher(of(b, n), of(a, m)), found, 8e-14);
        }
        // published: the lady tasting tea (Fisher 1935), three of four cups: 34/70
        close(fisher(of(3, 4), of(1, 4)), 34.0 / 70.0, 1e-14);
        // no overflow far in the tail
        assert!(fisher(of(30_000, 30_000), of(0, 30_000)) == 0.0);
        assert!(fisher(of(0, 10), of(0, 20)) == 1.0);
    }

    /// Published: 36 of 40 against 16 of 80 have the interval 2.94 to 7.15 (Koopman 1984). Digits from statsmodels
    /// 0.14, `confint_proportions_2indep(compare="ratio", method="score", correction=False)`.
    #[test]
    fn the_interval_is_koopmans() {
        for (one, other, lower, upper) in [
            (of(36, 40), of(16, 80), 2.939_569_192_214_996_5, 7.152_223_434_866_03),
            (of(14, 14), of(2, 985), 135.631_027_373_377_8, 1_795.328_207_212_550_3),
            (of(7, 14), of(7, 985), 27.837_122_217_941_555, 164.619_011_079_979_54),
            (of(3, 50), of(9, 70), 0.140_862_524_970_540_22, 1.494_918_514_443_081),
        ] {
            let found = risk_ratio(one, other, 0.95).expect("a ratio");
            // measured 7.4e-11, and 4e-15 of the others
            assert!((found.lower / lower - 1.0).abs() < 1e-9 && (found.upper / upper - 1.0).abs() < 1e-9, "{found:?}");
        }
    }

    /// Law: exchanged groups have inverse ratios and ends; a group without the event bounds the ratio on one side.
    #[test]
    fn exchanged_groups_have_the_inverse_ratio() {
        for (one, other) in
            [(of(14, 14), of(2, 985)), (of(3, 50), of(9, 70)), (of(5, 5), of(5, 9)), (of(1, 1000), of(1, 10))]
        {
            let [found, back] = [(one, other), (other, one)].map(|(a, b)| risk_ratio(a, b, 0.95).expect("a ratio"));
            // measured 2e-15, and 1e-12 of ends next to a share of 1
            for (end, inverse) in [(found.value, back.value), (found.lower, back.upper), (found.upper, back.lower)] {
                close(end * inverse, 1.0, 1e-10);
            }
            assert!(found.lower < found.value && found.value < found.upper);
        }
        let never = risk_ratio(of(7, 9), of(0, 300), 0.95).expect("a ratio");
        assert!(never.value == f64::INFINITY && never.upper == f64::INFINITY && never.lower > 20.0, "{never:?}");
        let only = risk_ratio(of(0, 9), of(30, 300), 0.95).expect("a ratio");
        assert!(only.value == 0.0 && only.lower == 0.0 && only.upper > 0.5, "{only:?}");
        assert_eq!(risk_ratio(of(0, 9), of(0, 8), 0.95), None);
        assert_eq!(risk_ratio(of(0, 0), of(1, 8), 0.95), None);
    }
}
