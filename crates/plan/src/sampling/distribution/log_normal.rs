//! `log_normal`: normal in the natural logarithm, with standard deviation `log_std` about `median` (default: nominal).

use super::prelude::*;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LogNormal {
    /// Median, > 0.
    pub median: f64,
    /// Standard deviation of the natural logarithm, >= 0.
    pub log_std: f64,
}

impl Scalar for LogNormal {
    const NAME: &'static str = "log_normal";
    const KEYS: &'static [Row] = &[
        Row::values("log_std", "Standard deviation of the natural logarithm").required("0.1").not_negative(),
        Row::amounts("median", "Median").or(Presence::OrNominal).within("> 0", LOGARITHM, above(0.0)),
    ];
    type Quantile = Self;

    fn of(target: &Target<'_>) -> Result<Vec<Self>> {
        let log_std = target.each("log_std")?;
        let medians = target.positive_or_nominal("median")?;
        target.all(|k| Ok(Self { median: medians[k], log_std: log_std[k] }))
    }
}

impl Quantile for LogNormal {
    #[inline]
    fn at_score(&self, z: f64) -> Option<f64> {
        Some(self.median * libm::exp(self.log_std * z))
    }

    fn text(&self, words: NumberWords<'_>) -> String {
        format!("log-normal, std of the logarithm {}", (words.number)(self.log_std))
    }
}
