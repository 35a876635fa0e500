//! [`Spread`]: order statistics of a growing number of values, exact for few, by a sketch for many.

use super::quantile::quantile;
use super::sketch::Sketch;

/// Most values with exact quantiles.
pub const EXACT: usize = 10_000;

/// Values with quantiles, independent of their order.
#[derive(Clone, Debug, Default)]
pub struct Spread {
    /// Up to one more than [`EXACT`], which marks that there are more.
    values: Vec<f64>,
    sketch: Sketch,
}

impl Spread {
    /// Counts one number, unless it is NaN.
    pub fn add(&mut self, value: f64) {
        if !value.is_nan() && self.values.len() <= EXACT {
            self.values.push(value);
        }
        self.sketch.add(value);
    }

    /// Number of counted numbers.
    pub fn count(&self) -> u64 {
        self.sketch.count()
    }

    /// The largest number, if any.
    pub fn max(&self) -> Option<f64> {
        self.sketch.max()
    }

    /// The `p`-quantile of type 7, 0 <= p <= 1, if any: exact for at most [`EXACT`] values, else within
    /// [`super::sketch::RELATIVE_ERROR`].
    pub fn quantile(&self, p: f64) -> Option<f64> {
        if self.values.len() > EXACT {
            return self.sketch.quantile(p);
        }
        let mut values = self.values.clone();
        values.sort_by(f64::total_cmp);
        quantile(&values, p)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::sketch::RELATIVE_ERROR;

    /// Law: quantiles of few values are exact in any order, those of many as accurate as a sketch.
    #[test]
    fn quantiles_of_few_values_are_exact() {
        let mut few = Spread::default();
        assert_eq!((few.quantile(0.5), few.count()), (None, 0));
        [1024.75, f64::NAN, 1024.25, 1024.5].into_iter().for_each(|value| few.add(value));
        assert_eq!((few.quantile(0.25), few.max(), few.count()), (Some(1024.375), Some(1024.75), 3));
        let mut many = Spread::default();
        (0..=2 * EXACT).rev().for_each(|k| many.add(1.0 + k as f64));
        let median = many.quantile(0.5).expect("values");
        assert!((median / (1.0 + EXACT as f64) - 1.0).abs() <= RELATIVE_ERROR, "{median}");
        assert_eq!(many.count(), 2 * EXACT as u64 + 1);
    }
}
