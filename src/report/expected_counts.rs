//! [`Asked`]: the distribution of a column of drawn samples, and how many samples of it are expected in the bars of a
//! histogram.

use std::sync::Arc;

use crate::sampling::distribution::{Distribution, Quantile};

/// Halvings of (0, 1) in which a probability is found: beyond the resolution of a picture.
const HALVINGS: u32 = 40;

/// The distribution of a column that has one of its own.
#[derive(Clone, Debug)]
pub enum Asked<'p> {
    Number(&'p Distribution),
    /// That of many draws, ascending.
    Drawn(Arc<[f64]>),
    /// Values with their probabilities, ascending.
    Values(Arc<[(f64, f64)]>),
}

impl Asked<'_> {
    /// How many of `count` values are expected between neighbouring `edges`, ascending; a value at an edge counts in
    /// the bar above, one at the last edge in the last bar, as in the histograms.
    pub fn expected(&self, edges: &[f64], count: usize) -> Vec<f64> {
        let Some(values) = self.values() else {
            let below: Vec<f64> = edges.iter().map(|edge| self.probability_below(*edge)).collect();
            return below.windows(2).map(|pair| count as f64 * (pair[1] - pair[0])).collect();
        };
        let mut expected = vec![0.0; edges.len().saturating_sub(1)];
        let (Some(first), Some(last)) = (edges.first(), edges.last()) else { return expected };
        for (value, probability) in values.into_iter().filter(|(value, _)| (*first..=*last).contains(value)) {
            let bar = edges.partition_point(|edge| *edge <= value).saturating_sub(1);
            let bar = bar.min(expected.len().saturating_sub(1));
            if let Some(expected) = expected.get_mut(bar) {
                *expected += count as f64 * probability;
            }
        }
        expected
    }

    /// The values of a discrete distribution with their probabilities, ascending; `None` of a continuous one.
    pub fn values(&self) -> Option<Vec<(f64, f64)>> {
        let distribution = match self {
            Asked::Number(distribution) => distribution,
            Asked::Values(values) => return Some(values.to_vec()),
            Asked::Drawn(_) => return None,
        };
        let mut below = 0.0;
        let value = |upto: f64| {
            let (from, probability) = (below, upto - below);
            below = upto;
            (probability > 0.0).then(|| (distribution.quantile(0.5 * (from + upto)), probability))
        };
        Some(distribution.steps()?.into_iter().filter_map(value).collect())
    }

    /// The probability of smaller values.
    fn probability_below(&self, value: f64) -> f64 {
        match self {
            Asked::Number(distribution) => probability(distribution, value),
            Asked::Drawn(drawn) => drawn.partition_point(|one| *one < value) as f64 / drawn.len().max(1) as f64,
            Asked::Values(values) => {
                values.iter().take_while(|(one, _)| *one < value).map(|(_, probability)| probability).sum()
            }
        }
    }
}

/// The probability of smaller values, by bisection of the quantile function.
fn probability(distribution: &Distribution, value: f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if distribution.quantile(middle) < value { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::distribution::choice::ChoiceQuantile;
    use crate::sampling::distribution::uniform::UniformQuantile;

    /// The resolution of the bisection is 1e-12; closed forms are exact to rounding.
    const RESOLUTION: f64 = 1e-9;

    fn agree(found: &[f64], known: &[f64]) -> bool {
        found.len() == known.len() && found.iter().zip(known).all(|(found, known)| (found - known).abs() < RESOLUTION)
    }

    /// Law: each value of a discrete distribution counts in its bar, the first and the last at the ends of the axis
    /// too.
    #[test]
    fn every_value_of_a_discrete_distribution_counts() {
        let choice = Distribution::Choice(ChoiceQuantile::new(&[0.05, 0.01, 0.02, 7.0], &[1.0, 2.0, 1.0, 0.0]));
        let asked = Asked::Number(&choice);
        let found = asked.expected(&[0.01, 0.02, 0.03, 0.04, 0.05], 100);
        assert!(agree(&found, &[50.0, 25.0, 0.0, 25.0]), "{found:?}");
        assert_eq!(asked.values(), Some(vec![(0.01, 0.5), (0.02, 0.25), (0.05, 0.25)]));
        // a value beyond the axis is in no bar
        assert!(agree(&asked.expected(&[0.015, 0.03], 100), &[25.0]));
        let uniform = Distribution::Uniform(UniformQuantile { min: 0.0, max: 1.0 });
        assert_eq!(Asked::Number(&uniform).values(), None);
    }
}
