//! Laws of listed values: [`Choice`] with weights, [`Empirical`] as a file's column. Values are sorted, so that quantiles rise
//! with u and a rank correlation means what it says.

use super::law::Interpolation;
use std::sync::Arc;

/// One of a list of values.
#[derive(Clone, Debug, PartialEq)]
pub struct Choice {
    /// Ascending.
    values: Arc<[f64]>,
    /// Probability of this value or a smaller one.
    cumulative: Arc<[f64]>,
}

impl Choice {
    /// `values` with `weights` in proportion; at least one is above zero.
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

    /// The values that can be drawn, ascending.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// The smallest value whose cumulative probability reaches `u`.
    pub fn quantile(&self, u: f64) -> f64 {
        let place = self.cumulative.partition_point(|below| *below < u);
        // rounding may leave the last sum below one
        self.values[place.min(self.values.len() - 1)]
    }
}

/// As the values of a list, each with the same weight.
#[derive(Clone, Debug, PartialEq)]
pub struct Empirical {
    /// Ascending, at least one.
    values: Arc<[f64]>,
    interpolation: Interpolation,
}

impl Empirical {
    /// The distribution of `values`, at least one.
    pub fn new(values: &[f64], interpolation: Interpolation) -> Self {
        let mut values = values.to_vec();
        values.sort_by(f64::total_cmp);
        Empirical { values: values.into(), interpolation }
    }

    /// How many values there are.
    pub fn count(&self) -> usize {
        self.values.len()
    }

    /// The value at `u`: the smallest with at least the fraction u of the values at or below it, or with linear interpolation
    /// that at place u (n - 1), counted from zero (R. J. Hyndman & Y. Fan, *Am. Stat.* 50 (1996) 361, types 1 and 7).
    pub fn quantile(&self, u: f64) -> f64 {
        let last = self.values.len() - 1;
        match self.interpolation {
            Interpolation::None => self.values[((u * self.values.len() as f64) as usize).min(last)],
            Interpolation::Linear => {
                let place = u * last as f64;
                let below = (place as usize).min(last);
                let above = (below + 1).min(last);
                let part = place - below as f64;
                self.values[below] + part * (self.values[above] - self.values[below])
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_choice_takes_each_value_in_its_share_of_u() {
        let choice = Choice::new(&[3.0, 1.0, 2.0, 9.0], &[1.0, 2.0, 1.0, 0.0]);
        assert_eq!(
            [0.0001, 0.4999, 0.5001, 0.7499, 0.7501, 0.9999].map(|u| choice.quantile(u)),
            [1., 1., 2., 2., 3., 3.]
        );
        assert_eq!(choice.values(), [1.0, 2.0, 3.0], "what has no weight is never drawn");
    }

    #[test]
    fn an_empirical_law_gives_its_values_back() {
        let steps = Empirical::new(&[5.0, 1.0, 2.0], Interpolation::None);
        assert_eq!([0.01, 0.33, 0.34, 0.66, 0.67, 0.99].map(|u| steps.quantile(u)), [1.0, 1.0, 2.0, 2.0, 5.0, 5.0]);
        let lines = Empirical::new(&[5.0, 1.0, 2.0], Interpolation::Linear);
        assert_eq!([0.25, 0.5, 0.75].map(|u| lines.quantile(u)), [1.5, 2.0, 3.5]);
        assert_eq!(Empirical::new(&[4.0], Interpolation::Linear).quantile(0.3), 4.0);
    }
}
