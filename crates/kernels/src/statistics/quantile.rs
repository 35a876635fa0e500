//! Sample quantiles, and distribution-free confidence intervals for quantiles from independent runs.
//!
//! Quantiles are of type 7 of R. J. Hyndman & Y. Fan, *Am. Stat.* 50 (1996) 361, the default of R, NumPy, polars and
//! DuckDB (`quantile_cont`). Intervals are [x_(r), x_(s)], with ranks from the binomial distribution of the number of
//! values below the quantile (S. S. Wilks, *Bull. Am. Math. Soc.* 54 (1948) 6); they cover discrete distributions at
//! least as often.

use super::binomial::{at_least, at_most, lower_rank, upper_rank};

/// The `p`-quantile, 0 <= p <= 1, of ascending values, if any.
pub fn quantile(ascending: &[f64], p: f64) -> Option<f64> {
    quantile_of(ascending.len(), p, |place| ascending[place])
}

/// The `p`-quantile of `count` values, whose order statistics, from zero, are `at`: with (n-1) p = k - 1 + t, x_(k) + t
/// (x_(k+1) - x_(k)), from the nearer end.
fn quantile_of(count: usize, p: f64, at: impl Fn(usize) -> f64) -> Option<f64> {
    let last = count.checked_sub(1)?;
    let place = last as f64 * p;
    let below = (place.floor() as usize).min(last);
    let (low, high) = (at(below), at((below + 1).min(last)));
    let part = place - below as f64;
    if low == high {
        return Some(low);
    }
    let width = high - low;
    Some(if part < 0.5 { low + part * width } else { high - (1.0 - part) * width })
}

/// Values with their order statistics ([`f64::total_cmp`]): a few are announced and found together in a third of the
/// time of a sort.
#[derive(Clone, Debug)]
pub struct OrderStatistics {
    /// Partitioned at each of `places`.
    values: Vec<f64>,
    /// Ascending.
    places: Vec<usize>,
}

impl OrderStatistics {
    /// Announces order statistics at `places`, from zero; those out of range are ignored.
    pub fn new(mut values: Vec<f64>, places: impl IntoIterator<Item = usize>) -> Self {
        let mut places: Vec<usize> = places.into_iter().filter(|place| *place < values.len()).collect();
        places.sort_unstable();
        places.dedup();
        place_ascending(&mut values, 0, &places);
        OrderStatistics { values, places }
    }

    /// The values, in any order.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// The order statistic at `place`, from zero, if any.
    pub fn at(&self, place: usize) -> Option<f64> {
        if place >= self.values.len() || self.places.binary_search(&place).is_ok() {
            return self.values.get(place).copied();
        }
        let mut copy = self.values.clone();
        place_ascending(&mut copy, 0, &[place]);
        Some(copy[place])
    }

    /// [`quantile`].
    pub fn quantile(&self, p: f64) -> Option<f64> {
        quantile_of(self.values.len(), p, |place| self.at(place).unwrap_or(f64::NAN))
    }
}

/// Puts the order statistics at ascending `places` into place; `values` start at place `first`.
fn place_ascending(values: &mut [f64], first: usize, places: &[usize]) {
    let (before, from) = places.split_at(places.len() / 2);
    let Some((place, after)) = from.split_first() else { return };
    let (smaller, _, larger) = values.select_nth_unstable_by(place - first, f64::total_cmp);
    place_ascending(smaller, first, before);
    place_ascending(larger, place + 1, after);
}

/// `p` in percent, with the digits of `p`: "99.9" for 0.999.
pub fn percent(p: f64) -> String {
    // the fewest digits that read back as p, with the point shifted by two places
    let digits = p.to_string();
    let (whole, fraction) = digits.split_once('.').unwrap_or((&digits, ""));
    let shifted = format!("{whole}{fraction:0<2}");
    let (whole, fraction) = shifted.split_at(whole.len() + 2);
    let whole = match whole.trim_start_matches('0') {
        "" => "0",
        whole => whole,
    };
    format!("{whole}.{fraction}").trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// Ranks, from 1, of the ends of an interval; `None` if the sample is too small.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ranks {
    /// Rank r of the lower end.
    pub lower: Option<u64>,
    /// Rank s of the upper end.
    pub upper: Option<u64>,
}

/// Ranks of the equal-tailed interval for the `p`-quantile, 0 < p < 1, of `count` independent values. With X values
/// below the quantile, the ends miss with P(X <= r - 1) and P(X >= s), each at most (1 - `confidence`)/2.
pub fn interval_ranks(count: u64, p: f64, confidence: f64) -> Ranks {
    let risk = 0.5 * (1.0 - confidence);
    Ranks { lower: lower_rank(count, p, risk), upper: upper_rank(count, p, risk) }
}

/// P(r <= X <= s - 1), the probability that [x_(r), x_(s)] covers the `p`-quantile of a continuous distribution; a
/// missing end is infinite.
pub fn coverage(count: u64, p: f64, ranks: Ranks) -> f64 {
    let below = ranks.lower.map_or(0.0, |rank| at_most(rank - 1, count, p));
    let above = ranks.upper.map_or(0.0, |rank| at_least(rank, count, p));
    1.0 - below - above
}

/// Smallest number of runs whose maximum (p >= 1/2) or minimum is a one-sided bound of the `p`-quantile (Wilks 1941).
pub fn runs_for_bound(p: f64, confidence: f64) -> u64 {
    // p^n <= 1 - confidence
    let (p, risk) = (p.max(1.0 - p), 1.0 - confidence);
    smallest(libm::log(risk) / libm::log(p), |n| libm::pow(p, n as f64) <= risk)
}

/// Smallest number of runs with an equal-tailed interval for the `p`-quantile.
pub fn runs_for_interval(p: f64, confidence: f64) -> u64 {
    runs_for_bound(p, 0.5 + 0.5 * confidence)
}

/// Smallest whole number near `estimate` that is `enough`, regardless of the rounding of a logarithm.
fn smallest(estimate: f64, enough: impl Fn(u64) -> bool) -> u64 {
    let mut n = (estimate.floor() as u64).saturating_sub(1).max(1);
    while !enough(n) {
        n += 1;
    }
    n
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::close;

    /// Law: order statistics at any places, announced or not, are those of a sort, to the bit.
    #[test]
    fn order_statistics_are_those_of_a_sort() {
        let numbers = [0.0, -0.0, 1.5, f64::INFINITY, -3.0, 1e-310, 2.0];
        for count in [0, 1, 2, 7, 100, 3001] {
            let values: Vec<f64> = (0..count).map(|k| numbers[k * k % 7] * libm::sin((k % 50) as f64)).collect();
            let bits = |values: &[f64]| values.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
            let mut sorted = values.clone();
            sorted.sort_by(f64::total_cmp);
            for places in [vec![], vec![0], vec![count / 2, 0, 3, count, 4, count / 2], (0..count).collect()] {
                let order = OrderStatistics::new(values.clone(), places.iter().copied());
                for place in places.into_iter().chain([count / 3, 5, count]) {
                    let expected = sorted.get(place).map(|value| value.to_bits());
                    assert_eq!(order.at(place).map(f64::to_bits), expected, "{place} of {count}");
                }
                for p in [0.0, 0.3, 0.77, 1.0] {
                    assert_eq!(order.quantile(p).map(f64::to_bits), quantile(&sorted, p).map(f64::to_bits), "{p}");
                }
                let mut placed = order.values().to_vec();
                placed.sort_by(f64::total_cmp);
                assert_eq!(bits(&placed), bits(&sorted), "{count}");
            }
        }
    }

    #[test]
    fn type_seven_interpolates() {
        let values = [1.0, 2.0, 4.0, 8.0];
        for (p, expected) in [(0.0, 1.0), (1.0, 8.0), (0.5, 3.0), (1.0 / 3.0, 2.0), (0.25, 1.75), (0.9, 6.8)] {
            let found = quantile(&values, p).unwrap_or(f64::NAN);
            // a unit in the last place of 6.8 is 8.9e-16, measured for p = 0.9
            close(found, expected, 8e-15);
        }
        assert_eq!(quantile(&[], 0.5), None);
        assert_eq!(quantile(&[3.0], 0.99), Some(3.0));
        // 99% of 100 values is not their maximum
        let hundred: Vec<f64> = (0..100).map(f64::from).collect();
        // a unit in the last place of 98.01 is 1.4e-14
        close(quantile(&hundred, 0.99).unwrap_or(0.0), 98.01, 2e-14);
        assert_eq!(quantile(&[f64::NEG_INFINITY, f64::NEG_INFINITY, 1.0], 0.25), Some(f64::NEG_INFINITY));
    }

    /// Published ranks and numbers of runs.
    #[test]
    fn published_numbers() {
        let runs = [(0.95, 0.95), (0.05, 0.95), (0.9987, 0.9)].map(|(p, confidence)| runs_for_bound(p, confidence));
        assert_eq!((runs, runs_for_interval(0.95, 0.95)), ([59, 59, 1771], 72));
        // 93 runs: the second largest bounds p95 at 95% (second-order Wilks formula)
        let ranks = [58, 59, 93].map(|runs| upper_rank(runs, 0.95, 0.05));
        assert_eq!(ranks, [None, Some(59), Some(92)]);
        assert_eq!([71, 72].map(|runs| interval_ranks(runs, 0.95, 0.95).upper), [None, Some(72)]);
        // the median of ten: x_(2) to x_(9), 97.9% (David & Nagaraja, table of section 7.1)
        let ranks = interval_ranks(10, 0.5, 0.95);
        assert_eq!(ranks, Ranks { lower: Some(2), upper: Some(9) });
        close(coverage(10, 0.5, ranks), 1.0 - 2.0 * 11.0 / 1024.0, 2.0 * f64::EPSILON);
    }

    /// Law: no ranks are tighter at the risk of each end.
    #[test]
    fn ranks_are_as_tight_as_the_risk_allows() {
        for count in [5, 59, 100, 1000, 123_457] {
            for p in [0.01, 0.25, 0.5, 0.95, 0.999] {
                for confidence in [0.5, 0.9, 0.95, 0.999] {
                    let risk = 0.5 * (1.0 - confidence);
                    let ranks = interval_ranks(count, p, confidence);
                    if let Some(rank) = ranks.lower {
                        assert!(at_most(rank - 1, count, p) <= risk && at_most(rank, count, p) > risk);
                    }
                    if let Some(rank) = ranks.upper {
                        assert!(at_least(rank, count, p) <= risk && at_least(rank - 1, count, p) > risk);
                    }
                    assert!(coverage(count, p, ranks) >= confidence - 1e-12);
                }
            }
        }
    }
}
