//! `weibull`: above `min` (default 0) with distribution function 1 - exp(-(x/`scale`)^`shape`) (W. Weibull, *J. Appl.
//! Mech.* 18 (1951) 293): times to failure, extremes.

use super::prelude::*;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Weibull {
    /// Shape, > 0.
    pub shape: f64,
    /// Scale, > 0.
    pub scale: f64,
    pub min: f64,
}

/// Allowed shapes: below, most values vanish or overflow; above, all equal the scale.
const SHAPES: Range = between(0.05, 1e4);

impl Scalar for Weibull {
    const NAME: &'static str = "weibull";
    const KEYS: &'static [Row] =
        &[
            Row::values("shape", "Shape; 1 is the exponential distribution, 2 that of Rayleigh")
                .required("2.0")
                .within("a number from 0.05 to 1e4", "1 is the exponential distribution", SHAPES),
            Row::amounts("scale", "Scale above `min`: 63% of the values are below").required("0.1").scale(),
            MIN.or(Presence::Or(0.0)),
        ];
    type Quantile = Self;

    fn of(target: &Target<'_>) -> Result<Vec<Self>> {
        target.of_numbers(["shape", "scale", "min"], |[shape, scale, min]| Weibull { shape, scale, min })
    }
}

impl Quantile for Weibull {
    /// min + scale (-ln(1 - u))^(1/shape).
    fn quantile(&self, u: f64) -> f64 {
        self.min + self.scale * libm::pow(-libm::log1p(-u), 1.0 / self.shape)
    }

    fn text(&self, words: NumberWords<'_>) -> String {
        format!(
            "Weibull, shape {}, scale {}, from {}",
            (words.number)(self.shape),
            (words.amount)(self.scale),
            (words.amount)(self.min)
        )
    }
}
