//! `empirical`: as a `column` of a `file`, with `interpolation` between its values or none.

use super::target::Target;
use super::traits::{NumberWords, Quantile, Scalar};
use crate::sampling::error::DispersionError;
use crate::sampling::keys::{Kind, Row, Value};
use std::sync::Arc;

/// What lies between the values of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interpolation {
    /// Nothing: each draw is a value of the file, each as likely as the others.
    None,
    /// A uniform distribution between neighbours.
    Linear,
}

#[derive(Clone, Copy, Debug)]
pub struct Empirical;

/// Ready to be drawn: as the values of a list, each with the same weight.
#[derive(Clone, Debug, PartialEq)]
pub struct EmpiricalQuantile {
    /// Ascending, at least one.
    values: Arc<[f64]>,
    interpolation: Interpolation,
}

impl EmpiricalQuantile {
    /// The distribution of `values`, at least one.
    pub fn new(values: &[f64], interpolation: Interpolation) -> Self {
        let mut values = values.to_vec();
        values.sort_by(f64::total_cmp);
        EmpiricalQuantile { values: values.into(), interpolation }
    }
}

impl Scalar for Empirical {
    const NAME: &'static str = "empirical";
    const KEYS: &'static [Row] = &[
        Row::new("file", Kind::Column, "File of numbers, with `column`, and `sha256`, the checksum of the file"),
        Row::new("interpolation", Kind::Word(&["none", "linear"]), "How to interpolate between the values of the file"),
    ];
    type Quantile = EmpiricalQuantile;

    fn quantiles(target: &Target<'_>) -> Result<Vec<EmpiricalQuantile>, DispersionError> {
        let Some(Value::Column(data)) = target.written.get("file") else {
            return target.refused("file", String::new(), "given", "name a file");
        };
        let is_linear = target.written.get("interpolation") == Some(&Value::Word("linear"));
        let interpolation = if is_linear { Interpolation::Linear } else { Interpolation::None };
        let quantile = EmpiricalQuantile::new(&data.values, interpolation);
        target.all(|_| Ok(quantile.clone()))
    }
}

impl Quantile for EmpiricalQuantile {
    /// The value at `u`: the smallest with at least the fraction u of the values at or below it, or with linear
    /// interpolation that at position u (n - 1), counted from zero (R. J. Hyndman & Y. Fan, *Am. Stat.* 50 (1996) 361,
    /// types 1 and 7).
    fn quantile(&self, u: f64) -> f64 {
        let last = self.values.len() - 1;
        match self.interpolation {
            Interpolation::None => self.values[((u * self.values.len() as f64) as usize).min(last)],
            Interpolation::Linear => {
                let position = u * last as f64;
                let below = (position as usize).min(last);
                let above = (below + 1).min(last);
                let part = position - below as f64;
                let (low, high) = (self.values[below], self.values[above]);
                let width = high - low;
                if width.is_finite() { low + part * width } else { (1.0 - part) * low + part * high }
            }
        }
    }

    fn steps(&self) -> Option<Vec<f64>> {
        let last = |k: &usize| self.values.get(k + 1) != Some(&self.values[*k]);
        let count = self.values.len();
        let below = (0..count).filter(last).map(|k| (k + 1) as f64 / count as f64);
        (self.interpolation == Interpolation::None).then(|| below.collect())
    }

    fn text(&self, words: NumberWords<'_>) -> String {
        let [low, high] = [f64::EPSILON, 1.0 - f64::EPSILON].map(|u| (words.amount)(self.quantile(u)));
        format!("as {} values of a file, {low} to {high}", self.values.len())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_empirical_distribution_gives_its_values_back() {
        let steps = EmpiricalQuantile::new(&[5.0, 1.0, 2.0], Interpolation::None);
        assert_eq!([0.01, 0.33, 0.34, 0.66, 0.67, 0.99].map(|u| steps.quantile(u)), [1.0, 1.0, 2.0, 2.0, 5.0, 5.0]);
        let lines = EmpiricalQuantile::new(&[5.0, 1.0, 2.0], Interpolation::Linear);
        assert_eq!([0.25, 0.5, 0.75].map(|u| lines.quantile(u)), [1.5, 2.0, 3.5]);
        let wide = EmpiricalQuantile::new(&[-1.7e308, 1.7e308], Interpolation::Linear);
        // half an ulp of numbers of this size, 1e292; measured: exactly that
        assert!((wide.quantile(0.75) - 0.85e308).abs() < 2e292, "a width beyond the largest number");
        assert_eq!(EmpiricalQuantile::new(&[4.0], Interpolation::Linear).quantile(0.3), 4.0);
    }
}
