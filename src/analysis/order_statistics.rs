//! Quantiles of a column and their intervals from its order statistics: of few rows the values themselves, of many those of sketches.

use crate::analysis::population::Population;
use crate::campaign::Plan;
use crate::statistics::quantile::{
    Ranks as IntervalRanks, interval_ranks, percent, quantile, runs_for_bound, runs_for_interval,
};
use crate::statistics::replicates::Step;
use crate::statistics::sketch::Ranks;

/// A quantile of the runs.
#[derive(Clone, Debug, PartialEq)]
pub struct QuantileStatistic {
    /// Which.
    pub p: f64,
    /// Confidence of its interval.
    pub confidence: f64,
    /// The sample quantile (type 7).
    pub value: Option<f64>,
    /// Ends of its interval, rounded outward; `None` where the runs do not bound it on that side, or no interval holds.
    pub interval: [Option<f64>; 2],
    /// What it takes to bound it, where there are too few runs.
    pub note: Option<String>,
}

/// The order statistics of a group of values.
pub enum Order {
    /// The values; those that quantiles ask for are at their places in ascending order.
    Exact(Vec<f64>),
    /// Ranks of a sketch.
    Sketched(Ranks),
}

impl Order {
    /// The `p`-quantile.
    pub fn quantile(&self, p: f64) -> Option<f64> {
        match self {
            Order::Exact(values) => quantile(values, p),
            Order::Sketched(ranks) => ranks.quantile(p),
        }
    }

    /// Bounds of the number of rank `rank`, from 1.
    pub fn bounds(&self, rank: u64) -> Option<[f64; 2]> {
        match self {
            Order::Exact(values) => values.get(rank as usize - 1).map(|value| [*value; 2]),
            Order::Sketched(ranks) => ranks.bounds(rank),
        }
    }

    /// The steps of the distribution function of replicate `replicate`.
    pub fn steps(&self, replicate: usize) -> Vec<Step> {
        match self {
            Order::Exact(values) => {
                values.iter().map(|value| Step { value: *value, lower: *value, replicate, count: 1 }).collect()
            }
            Order::Sketched(ranks) => {
                let counts = std::iter::once(0).chain(ranks.buckets.iter().map(|bucket| bucket.up_to));
                let steps = ranks.buckets.iter().zip(counts);
                // a bucket has its ends from its group; of all groups they are those of the widest
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

/// The ranks of the intervals of all quantiles for one number of values: that of most columns.
pub struct CommonRanks {
    count: u64,
    confidence: f64,
    ranks: Vec<(f64, IntervalRanks)>,
}

impl CommonRanks {
    /// Those of the quantiles of `plan` for `count` values.
    pub fn new(plan: &Plan, population: Population, count: u64) -> Self {
        let quantiles = plan.analysis.quantiles.iter().filter(|_| population.has_intervals());
        let ranks = quantiles.map(|p| (*p, interval_ranks(count, *p, plan.analysis.confidence)));
        CommonRanks { count, confidence: plan.analysis.confidence, ranks: ranks.collect() }
    }

    /// Those of the `p`-quantile of `count` values.
    pub fn of(&self, count: u64, p: f64, confidence: f64) -> IntervalRanks {
        let mut known = self.ranks.iter().filter(|_| count == self.count && confidence == self.confidence);
        let known = known.find(|(of, _)| *of == p).map(|(_, ranks)| *ranks);
        known.unwrap_or_else(|| interval_ranks(count, p, confidence))
    }
}

/// A quantile that is asked for.
pub struct AskedQuantile {
    /// Its probability.
    pub p: f64,
    /// Of its interval.
    pub confidence: f64,
    /// The ranks of its interval, where the population has intervals.
    pub ranks: Option<IntervalRanks>,
}

impl AskedQuantile {
    /// The places, from zero, of the order statistics that it needs of `count` values; some may be beyond the last.
    pub fn places(&self, count: usize) -> impl Iterator<Item = usize> {
        let below = (count as f64 * self.p) as usize;
        // (count - 1) p, rounded, is between below - 1 and below + 1
        let ends = self.ranks.into_iter().flat_map(|ranks| [ranks.lower, ranks.upper]).flatten();
        (below.saturating_sub(1)..=below + 1).chain(ends.map(|rank| rank as usize - 1))
    }
}

/// A quantile with the interval of independent samples, where they are.
pub fn of_quantile(order: &Order, asked: &AskedQuantile) -> QuantileStatistic {
    let AskedQuantile { p, confidence, ranks } = *asked;
    let mut found = QuantileStatistic { p, confidence, value: order.quantile(p), interval: [None; 2], note: None };
    let Some(ranks) = ranks else { return found };
    let end = |rank: Option<u64>, which: usize| rank.and_then(|rank| order.bounds(rank)).map(|bounds| bounds[which]);
    found.interval = [end(ranks.lower, 0), end(ranks.upper, 1)];
    if found.interval.contains(&None) {
        found.note = Some(format!(
            "p{} with {}% confidence needs {} runs ({} for a bound on one side)",
            percent(p),
            percent(confidence),
            runs_for_interval(p, confidence),
            runs_for_bound(p, confidence),
        ));
    }
    found
}
