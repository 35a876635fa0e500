//! `choice`: one of `values`, with `weights` or equal ones. They are sorted, so that u and values have equal rank
//! correlations.

use super::prelude::*;
use std::sync::Arc;

#[derive(Clone, Debug, PartialEq)]
pub struct Choice {
    values: Arc<[f64]>,
    /// Up to and including each value.
    cumulative: Arc<[f64]>,
}

impl Choice {
    /// At least one weight is above zero.
    pub fn new(values: &[f64], weights: &[f64]) -> Self {
        let mut pairs: Vec<(f64, f64)> = values.iter().copied().zip(weights.iter().copied()).collect();
        pairs.retain(|(_, weight)| *weight > 0.0);
        pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
        let sum: f64 = pairs.iter().map(|(_, weight)| weight).sum();
        let mut below = 0.0;
        let cumulative = pairs.iter().map(|(_, weight)| {
            below += weight;
            below / sum
        });
        Choice { cumulative: cumulative.collect(), values: pairs.iter().map(|(value, _)| *value).collect() }
    }
}

const LISTED: usize = 4;

impl Choice {
    fn shares(&self) -> Vec<(f64, f64)> {
        let mut shares: Vec<(f64, f64)> = Vec::new();
        let mut before = 0.0;
        for (value, below) in self.values.iter().zip(self.cumulative.iter()) {
            let share = below - before;
            before = *below;
            match shares.last_mut().filter(|(last, _)| last == value) {
                Some((_, sum)) => *sum += share,
                None => shares.push((*value, share)),
            }
        }
        shares
    }
}

impl Scalar for Choice {
    const NAME: &'static str = "choice";
    const KEYS: &'static [Row] = &[
        Row::new("values", Kind::AmountList, "The values").required_as("an array of finite numbers", "[1.0, 2.0]"),
        Row::new("weights", Kind::List, "Their relative weights; default: equal"),
    ];
    type Quantile = Self;

    fn of(target: &Target<'_>) -> Result<Vec<Self>> {
        let shown = |list: &[f64]| format!("{list:?}");
        let values = target.written.numbers("values").unwrap_or_default();
        if values.is_empty() || values.iter().any(|x| !x.is_finite()) {
            return target.refused("values", shown(values), "at least one finite number", "write them as [1.0, 2.0]");
        }
        let equal = vec![1.0; values.len()];
        let weights = target.written.numbers("weights").unwrap_or(&equal);
        if weights.len() != values.len() {
            let allowed = format!("as many numbers as values ({})", values.len());
            return target.refused("weights", shown(weights), allowed, "give one for each value");
        }
        let sum: f64 = weights.iter().sum();
        if weights.iter().any(|x| !x.is_finite() || *x < 0.0) || sum <= 0.0 {
            let allowed = "numbers >= 0, not all 0";
            return target.refused("weights", shown(weights), allowed, "their proportions count, not their sum");
        }
        if !sum.is_finite() {
            let remedy = "divide all by the same number: their proportions count";
            return target.refused("weights", shown(weights), "numbers with a finite sum", remedy);
        }
        let choice = Choice::new(values, weights);
        target.all(|_| Ok(choice.clone()))
    }
}

impl Quantile for Choice {
    /// The smallest value whose cumulative probability reaches u.
    fn quantile(&self, u: f64) -> f64 {
        let place = self.cumulative.partition_point(|below| *below < u);
        // rounding may leave the last sum below one
        self.values[place.min(self.values.len() - 1)]
    }

    fn steps(&self) -> Option<Vec<f64>> {
        let last = |k: &usize| self.values.get(k + 1) != Some(&self.values[*k]);
        Some((0..self.values.len()).filter(last).map(|k| self.cumulative[k]).collect())
    }

    fn text(&self, words: NumberWords<'_>) -> String {
        let shares = self.shares();
        let amount = |value: f64| (words.amount)(value);
        let percent = |share: f64| format!("{}%", (words.number)(100.0 * share));
        match shares[..] {
            [(value, _)] => format!("always {}", amount(value)),
            [low, high] => {
                let (rare, other) = if high.1 < low.1 { (high, low) } else { (low, high) };
                format!("{} with probability {}, else {}", amount(rare.0), percent(rare.1), amount(other.0))
            }
            [ref some @ .., (last, share)] if some.len() < LISTED => {
                let each = some.iter().map(|(value, share)| format!("{} ({})", amount(*value), percent(*share)));
                format!("{} or {} ({})", each.collect::<Vec<_>>().join(", "), amount(last), percent(share))
            }
            [(low, _), .., (high, _)] => {
                format!("one of {} values, {} to {}", shares.len(), amount(low), amount(high))
            }
            [] => String::new(),
        }
    }
}
