//! Quantiles of a column and their intervals by order statistics, from the values of few rows or sketches of many.

use super::population::Population;
use crate::campaign::Plan;
use crate::statistics::binomial::interval;
use crate::statistics::gate::GateLimit;
use crate::statistics::quantile::{
    OrderStatistics, Ranks as IntervalRanks, interval_ranks, percent, runs_for_bound, runs_for_interval,
};
use crate::statistics::replicates::Step;
use crate::statistics::sketch::Ranks;

#[derive(Clone, Debug, PartialEq)]
pub struct QuantileStatistic {
    pub p: f64,
    pub confidence: f64,
    /// The sample quantile (type 7).
    pub value: Option<f64>,
    /// Ends of the interval, rounded outward; `None` for an open end, or without an interval.
    pub interval: [Option<f64>; 2],
    /// Why an end is open: too few or lost runs; for a requirement, that missing values count.
    pub note: Option<String>,
}

impl QuantileStatistic {
    /// Probability, quantile, and ends of the interval; NaN for none.
    pub fn numbers(&self) -> [f64; 4] {
        let [value, low, high] = [self.value, self.interval[0], self.interval[1]].map(|end| end.unwrap_or(f64::NAN));
        [self.p, value, low, high]
    }
}

pub enum Order {
    Exact(OrderStatistics),
    Sketched(Ranks),
}

impl Order {
    pub fn quantile(&self, p: f64) -> Option<f64> {
        match self {
            Order::Exact(values) => values.quantile(p),
            Order::Sketched(ranks) => ranks.quantile(p),
        }
    }

    /// Bounds of the value of `rank`, from 1.
    pub fn bounds(&self, rank: u64) -> Option<[f64; 2]> {
        match self {
            Order::Exact(values) => values.at(rank as usize - 1).map(|value| [value; 2]),
            Order::Sketched(ranks) => ranks.bounds(rank),
        }
    }

    pub fn steps(&self, replicate: usize) -> Vec<Step> {
        match self {
            Order::Exact(values) => {
                let step = |value: &f64| Step { value: *value, lower: *value, replicate, count: 1 };
                values.values().iter().map(step).collect()
            }
            Order::Sketched(ranks) => {
                let counts = std::iter::once(0).chain(ranks.buckets.iter().map(|bucket| bucket.up_to));
                let steps = ranks.buckets.iter().zip(counts);
                // a bucket has the ends of its group's, or the widest group's, values
                steps
                    .map(|(bucket, before)| Step {
                        value: bucket.high,
                        lower: bucket.low,
                        replicate,
                        count: bucket.up_to - before,
                    })
                    .collect()
            }
        }
    }
}

/// Interval ranks of all quantiles for the usual number of values.
pub struct CommonRanks {
    count: u64,
    confidence: f64,
    ranks: Vec<(f64, IntervalRanks)>,
}

impl CommonRanks {
    pub fn new(plan: &Plan, population: Population, count: u64) -> Self {
        let quantiles = plan.analysis.quantiles.iter().filter(|_| population.has_intervals());
        let ranks = quantiles.map(|p| (*p, interval_ranks(count, *p, plan.analysis.confidence)));
        CommonRanks { count, confidence: plan.analysis.confidence, ranks: ranks.collect() }
    }

    pub fn of(&self, count: u64, p: f64, confidence: f64) -> IntervalRanks {
        let mut known = self.ranks.iter().filter(|_| count == self.count && confidence == self.confidence);
        let known = known.find(|(of, _)| *of == p).map(|(_, ranks)| *ranks);
        known.unwrap_or_else(|| interval_ranks(count, p, confidence))
    }
}

#[derive(Clone, Copy)]
pub struct AskedQuantile {
    pub p: f64,
    pub confidence: f64,
    /// Ranks of its interval, if the population has intervals.
    pub ranks: Option<IntervalRanks>,
    /// The corresponding quantile of the known values; `None` if it is a missing one.
    of_values: Option<f64>,
    /// Runs without a value, beyond all others on the wrong side of a limit.
    pub missing: u64,
    /// Runs not computed, anywhere.
    lost: u64,
}

/// The quantile of `count` values that equals the `p`-quantile (type 7) of these and `missing` ones beyond `limit` and
/// all others; `None` if that is a missing one.
pub fn among_values(p: f64, count: u64, missing: u64, limit: GateLimit) -> Option<f64> {
    if missing == 0 {
        return Some(p);
    }
    let place = p * (count + missing - 1) as f64;
    let place = match limit {
        GateLimit::AtMost(_) => place,
        GateLimit::AtLeast(_) => place - missing as f64,
    };
    let last = count.checked_sub(1)? as f64;
    (0.0..=last).contains(&place).then(|| if last > 0.0 { place / last } else { 0.5 })
}

impl AskedQuantile {
    pub fn new(p: f64, confidence: f64, ranks: Option<IntervalRanks>) -> Self {
        AskedQuantile { p, confidence, ranks, of_values: Some(p), missing: 0, lost: 0 }
    }

    /// Counts `lost` runs among the ranks: the interval is the hull over all their possible values, below all others
    /// for its lower end, above for its upper.
    #[must_use]
    pub fn with_lost(self, count: u64, lost: u64) -> Self {
        let kept = |rank: u64| Some(rank).filter(|rank| (1..=count).contains(rank));
        let ranks = self.ranks.map(|ranks| IntervalRanks {
            lower: ranks.lower.and_then(|rank| kept(rank.checked_sub(lost)?)),
            upper: ranks.upper.and_then(kept),
        });
        AskedQuantile { ranks, lost, ..self }
    }

    /// Counts `missing` runs that violate `limit` among the ranks.
    #[must_use]
    pub fn with_missing(self, count: u64, missing: u64, limit: GateLimit) -> Self {
        let shift = if matches!(limit, GateLimit::AtLeast(_)) { missing } else { 0 };
        let kept =
            |rank: Option<u64>| rank.and_then(|rank| rank.checked_sub(shift)).filter(|rank| (1..=count).contains(rank));
        let ranks = self.ranks.map(|ranks| IntervalRanks { lower: kept(ranks.lower), upper: kept(ranks.upper) });
        AskedQuantile { ranks, of_values: among_values(self.p, count, missing, limit), missing, ..self }
    }

    /// Places, from zero, of its order statistics among `count` values; some may be beyond the last.
    pub fn places(&self, count: usize) -> impl Iterator<Item = usize> {
        let below = (count as f64 * self.of_values.unwrap_or(self.p)) as usize;
        // (count - 1) p, rounded, is between below - 1 and below + 1
        let ends = self.ranks.into_iter().flat_map(|ranks| [ranks.lower, ranks.upper]).flatten();
        (below.saturating_sub(1)..=below + 1).chain(ends.map(|rank| rank as usize - 1))
    }
}

/// Interval of the share `successes` of `count`, wherever `lost` others are.
pub fn share_interval(successes: u64, [count, lost]: [u64; 2], confidence: f64) -> [f64; 2] {
    let of = |successes: u64| interval(successes, count + lost, confidence);
    if lost == 0 { of(successes) } else { [of(successes)[0], of(successes + lost)[1]] }
}

pub fn without_value(missing: &str) -> String {
    match missing {
        "1" => "1 run without a value counts as a violation".to_owned(),
        _ => format!("{missing} runs without a value count as violations"),
    }
}

pub fn of_quantile(order: &Order, asked: &AskedQuantile) -> QuantileStatistic {
    let AskedQuantile { p, confidence, ranks, of_values, missing, lost } = *asked;
    let value = of_values.and_then(|p| order.quantile(p));
    let mut found = QuantileStatistic { p, confidence, value, interval: [None; 2], note: None };
    if missing > 0 {
        found.note = Some(without_value(&missing.to_string()));
    }
    let Some(ranks) = ranks else { return found };
    let end = |rank: Option<u64>, which: usize| rank.and_then(|rank| order.bounds(rank)).map(|bounds| bounds[which]);
    found.interval = [end(ranks.lower, 0), end(ranks.upper, 1)];
    if found.note.is_none() && found.interval.contains(&None) {
        found.note = Some(match lost {
            0 => too_few(p, confidence),
            _ => format!("p{} has no bound on a side where too many of {lost} lost runs may be", percent(p)),
        });
    }
    found
}

fn too_few(p: f64, confidence: f64) -> String {
    format!(
        "p{} with {}% confidence needs {} runs ({} for a bound on one side)",
        percent(p),
        percent(confidence),
        runs_for_interval(p, confidence),
        runs_for_bound(p, confidence),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::quantile::quantile;

    /// Law: a quantile with missing values, and its interval, equal those with these values infinite on the wrong side
    /// of the limit; none if it is missing. Counter-test: among the values alone it differs.
    #[test]
    fn missing_values_violate() {
        let values: Vec<f64> = (1..=40).map(f64::from).collect();
        for (limit, wrong) in [(GateLimit::AtMost(0.0), f64::INFINITY), (GateLimit::AtLeast(0.0), f64::NEG_INFINITY)] {
            for missing in [0, 1, 7, 25, 60] {
                let mut all: Vec<f64> = values.iter().copied().chain(vec![wrong; missing as usize]).collect();
                all.sort_by(f64::total_cmp);
                for p in [0.01, 0.05, 0.3, 0.5, 0.8, 0.95] {
                    let ranks = interval_ranks(40 + missing, p, 0.9);
                    let asked = AskedQuantile::new(p, 0.9, Some(ranks)).with_missing(40, missing, limit);
                    let found = of_quantile(&Order::Exact(OrderStatistics::new(values.clone(), [])), &asked);
                    let known = quantile(&all, p).filter(|value| value.is_finite());
                    let is_same = match (found.value, known) {
                        (Some(a), Some(b)) => (a - b).abs() < 1e-12,
                        (a, b) => a == b,
                    };
                    assert!(is_same, "{limit:?} {missing} {p}: {found:?} for {known:?}");
                    let end = |rank: Option<u64>| rank.map(|rank| all[rank as usize - 1]).filter(|end| end.is_finite());
                    assert_eq!(found.interval, [end(ranks.lower), end(ranks.upper)], "{limit:?} {missing} {p}");
                }
            }
            assert_ne!(among_values(0.5, 40, 7, limit), Some(0.5));
        }
        assert_eq!(
            (among_values(0.5, 0, 3, GateLimit::AtMost(0.0)), among_values(0.5, 1, 0, GateLimit::AtMost(0.0))),
            (None, Some(0.5))
        );
    }
}
