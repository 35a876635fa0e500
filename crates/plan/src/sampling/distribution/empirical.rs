//! `empirical`: distributed as a `column` of a `file`, with or without `interpolation` between its values.

use super::prelude::*;
use std::sync::Arc;

/// The distribution between the values of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interpolation {
    /// Each draw is a value of the file, all equally likely.
    None,
    /// A uniform distribution between neighbours.
    Linear,
}

/// Equally likely values.
#[derive(Clone, Debug, PartialEq)]
pub struct Empirical {
    /// Ascending, at least one.
    values: Arc<[f64]>,
    interpolation: Interpolation,
}

impl Empirical {
    pub fn new(values: &[f64], interpolation: Interpolation) -> Self {
        let mut values = values.to_vec();
        values.sort_by(f64::total_cmp);
        Empirical { values: values.into(), interpolation }
    }
}

impl Scalar for Empirical {
    const NAME: &'static str = "empirical";
    const KEYS: &'static [Row] = &[
        Row::new("file", Kind::Column, "File of numbers, with `column`, and `sha256`, the checksum of the file"),
        Row::new("interpolation", Kind::Word(&["none", "linear"]), "How to interpolate between the values of the file"),
    ];
    type Quantile = Self;

    fn of(target: &Target<'_>) -> Result<Vec<Self>> {
        let Some(Value::Column(data)) = target.written.get("file") else {
            return target.refused("file", String::new(), "given", "name a file");
        };
        let interpolation = match target.written.text("interpolation") {
            Some("linear") => Interpolation::Linear,
            _ => Interpolation::None,
        };
        let quantile = Empirical::new(&data.values, interpolation);
        target.all(|_| Ok(quantile.clone()))
    }
}

impl Quantile for Empirical {
    /// The smallest value with at least the fraction u of the values at or below it, or with linear interpolation the
    /// value at position u (n - 1), from zero (R. J. Hyndman & Y. Fan, *Am. Stat.* 50 (1996) 361, types 1 and 7).
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
