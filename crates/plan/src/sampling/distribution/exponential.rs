//! `exponential`: above `min` (default 0) with density proportional to exp(-x/`scale`), such as a delay. Mean `min` +
//! `scale`.

use super::prelude::*;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exponential {
    /// Mean above `min`, > 0.
    pub scale: f64,
    pub min: f64,
}

impl Scalar for Exponential {
    const NAME: &'static str = "exponential";
    const KEYS: &'static [Row] =
        &[Row::amounts("scale", "Mean above `min`").required("0.1").scale(), MIN.or(Presence::Or(0.0))];
    type Quantile = Self;

    fn of(target: &Target<'_>) -> Result<Vec<Self>> {
        target.of_numbers(["scale", "min"], |[scale, min]| Exponential { scale, min })
    }
}

impl Quantile for Exponential {
    /// min - scale ln(1 - u).
    fn quantile(&self, u: f64) -> f64 {
        self.min - self.scale * libm::log1p(-u)
    }

    fn text(&self, words: NumberWords<'_>) -> String {
        format!("exponential, scale {}, from {}", (words.amount)(self.scale), (words.amount)(self.min))
    }
}
