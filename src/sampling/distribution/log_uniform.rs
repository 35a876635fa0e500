//! `log_uniform`: uniform in the logarithm, between `min` and `max`, or about the nominal value by `factor`.

use super::target::Target;
use super::traits::{NumberWords, Quantile, Scalar};
use crate::sampling::error::DispersionError;
use crate::sampling::keys::{KeyReader, KeyWriter, Values};

/// As written.
#[derive(Clone, Debug, PartialEq)]
pub enum LogUniform {
    /// Between two positive numbers in the parameter's unit (`min`, `max`).
    Between {
        /// Lower end.
        min: Values,
        /// Upper end.
        max: Values,
    },
    /// From the nominal divided by a factor to the nominal times it (`factor`).
    Around(Values),
}

/// Ready to be drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LogUniformQuantile {
    min: f64,
    max: f64,
    /// ln(max/min).
    log_ratio: f64,
}

impl LogUniformQuantile {
    /// From `min` > 0 to `max` > `min`.
    pub fn new(min: f64, max: f64) -> Self {
        let ratio = max / min;
        let log_ratio = if ratio.is_finite() { libm::log(ratio) } else { libm::log(max) - libm::log(min) };
        LogUniformQuantile { min, max, log_ratio }
    }
}

impl Scalar for LogUniform {
    const NAME: &'static str = "log_uniform";
    type Quantile = LogUniformQuantile;

    fn read(keys: &mut dyn KeyReader) -> Option<Self> {
        let first = if keys.has("max") && !keys.has("min") { "max" } else { "min" };
        let one = keys.is_one_of(&["factor", first], "2.0");
        let factor = keys.values("factor");
        let ends = if one { keys.ends_together(["0.1", "10.0"]) } else { keys.values("min").zip(keys.values("max")) };
        match (one, factor, ends) {
            (true, Some(factor), _) => Some(LogUniform::Around(factor)),
            (true, None, Some((min, max))) => Some(LogUniform::Between { min, max }),
            _ => None,
        }
    }

    fn write(&self, keys: &mut dyn KeyWriter) {
        match self {
            LogUniform::Between { min, max } => keys.ends(min, max),
            LogUniform::Around(factor) => keys.values("factor", factor),
        }
    }

    fn quantiles(&self, target: &Target<'_>) -> Result<Vec<LogUniformQuantile>, DispersionError> {
        match self {
            LogUniform::Between { min, max } => {
                target.positive("min", min)?;
                let (min, max) = target.ends(min, max)?;
                target.all(|k| Ok(LogUniformQuantile::new(min[k], max[k])))
            }
            LogUniform::Around(factor) => {
                let remedy = "2 means from half to twice the nominal";
                let factor = target.passing("factor", factor, |x| x > 1.0, "> 1", remedy)?;
                let middle = target.positive_or_nominal("factor", &None)?;
                target.all(|k| {
                    let (min, max) = (middle[k] / factor[k], middle[k] * factor[k]);
                    if min > 0.0 && max.is_finite() {
                        return Ok(LogUniformQuantile::new(min, max));
                    }
                    let allowed = "such that the ends are positive finite numbers";
                    target.refused("factor", format!("{:?}", factor[k]), allowed, "write a smaller one")
                })
            }
        }
    }
}

impl Quantile for LogUniformQuantile {
    #[inline]
    fn quantile(&self, u: f64) -> f64 {
        let factor = libm::exp(u * self.log_ratio);
        // a ratio beyond the largest number: the logarithm of the value is still a number
        let value =
            if factor.is_finite() { self.min * factor } else { libm::exp(libm::log(self.min) + u * self.log_ratio) };
        value.clamp(self.min, self.max)
    }

    fn text(&self, words: NumberWords<'_>) -> String {
        format!("log-uniform, {} to {}", (words.amount)(self.min), (words.amount)(self.max))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ratio_beyond_the_largest_number_is_uniform_in_the_logarithm() {
        let quantile = LogUniformQuantile::new(1e-300, 1e300);
        for (u, expected) in [(0.25, 1e-150), (0.5, 1.0), (0.75, 1e150)] {
            // an ulp of the logarithm, 345, is worth 5.7e-14 of the value; measured: 4.5e-14
            assert!((quantile.quantile(u) / expected - 1.0).abs() < 2e-13, "{u} {}", quantile.quantile(u));
        }
    }
}
