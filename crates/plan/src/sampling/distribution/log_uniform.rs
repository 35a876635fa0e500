//! `log_uniform`: uniform in the logarithm, between `min` and `max`, or about the nominal value by `factor`.

use super::prelude::*;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LogUniform {
    min: f64,
    max: f64,
    /// ln(max/min).
    log_ratio: f64,
}

impl LogUniform {
    /// From `min` > 0 to `max` > `min`.
    pub fn new(min: f64, max: f64) -> Self {
        let ratio = max / min;
        let log_ratio = if ratio.is_finite() { libm::log(ratio) } else { libm::log(max) - libm::log(min) };
        LogUniform { min, max, log_ratio }
    }
}

impl Scalar for LogUniform {
    const NAME: &'static str = "log_uniform";
    const KEYS: &'static [Row] = &[
        MIN.within("> 0", LOGARITHM, above(0.0)),
        MAX,
        Row::values(
            "factor",
            "The range is from the nominal value divided by this factor to the nominal value times it",
        )
        .within("> 1", "2 means from half to twice the nominal", above(1.0)),
    ];
    const RULES: &'static [Rule] = &[
        Rule::One(&[&["factor"], &["min", "max"]], "2.0", ALL_BUT_ONE),
        Rule::Together([("min", "0.1"), ("max", "10.0")]),
    ];
    type Quantile = Self;

    fn of(target: &Target<'_>) -> Result<Vec<Self>> {
        if !target.written.has("factor") {
            let (min, max) = target.ends()?;
            return target.all(|k| Ok(Self::new(min[k], max[k])));
        }
        let factor = target.each("factor")?;
        let middle = target.positive_or_nominal("factor")?;
        target.all(|k| {
            let (min, max) = (middle[k] / factor[k], middle[k] * factor[k]);
            if min > 0.0 && max.is_finite() {
                return Ok(Self::new(min, max));
            }
            let allowed = "such that the ends are positive finite numbers";
            target.refused("factor", format!("{:?}", factor[k]), allowed, "write a smaller one")
        })
    }
}

impl Quantile for LogUniform {
    #[inline]
    fn quantile(&self, u: f64) -> f64 {
        let factor = libm::exp(u * self.log_ratio);
        // a ratio may overflow where the logarithm of the value does not
        let value =
            if factor.is_finite() { self.min * factor } else { libm::exp(libm::log(self.min) + u * self.log_ratio) };
        value.clamp(self.min, self.max)
    }

    fn text(&self, words: NumberWords<'_>) -> String {
        format!("log-uniform, {} to {}", (words.amount)(self.min), (words.amount)(self.max))
    }
}
