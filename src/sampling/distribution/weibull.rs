//! `weibull`: from `min` (0 where it is not written) on, with distribution function 1 - exp(-(x/`scale`)^`shape`) (W. Weibull, *J. Appl.
//! Mech.* 18 (1951) 293): times to failure, extremes.

use super::target::Target;
use super::traits::{NumberWords, Quantile, Scalar};
use crate::sampling::error::DispersionError;
use crate::sampling::keys::{KeyReader, KeyWriter, Values};

/// As written.
#[derive(Clone, Debug, PartialEq)]
pub struct Weibull {
    /// Shape, pure; 1 is the exponential distribution, 2 that of Rayleigh.
    pub shape: Values,
    /// Scale above `min`, in the parameter's unit: 63% of the values are below.
    pub scale: Values,
    /// Lower end.
    pub min: Option<Values>,
}

/// Ready to be drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WeibullQuantile {
    /// Shape, > 0.
    pub shape: f64,
    /// Scale, > 0.
    pub scale: f64,
    /// Lower end.
    pub min: f64,
}

/// Allowed shapes: below, most values vanish or overflow; above, all are the scale.
const SHAPES: std::ops::RangeInclusive<f64> = 0.05..=1e4;

impl Scalar for Weibull {
    const NAME: &'static str = "weibull";
    type Quantile = WeibullQuantile;

    fn read(keys: &mut dyn KeyReader) -> Option<Self> {
        let (shape, scale) = (keys.required("shape", "2.0"), keys.required("scale", "0.1"));
        let min = keys.optional("min");
        let (shape, scale) = shape.zip(scale)?;
        min.map(|min| Weibull { shape, scale, min })
    }

    fn write(&self, keys: &mut dyn KeyWriter) {
        keys.values("shape", &self.shape);
        keys.values("scale", &self.scale);
        keys.optional("min", self.min.as_ref());
    }

    fn quantiles(&self, target: &Target<'_>) -> Result<Vec<WeibullQuantile>, DispersionError> {
        let remedy = "1 is the exponential distribution";
        let shape =
            target.passing("shape", &self.shape, |x| SHAPES.contains(&x), "a number from 0.05 to 1e4", remedy)?;
        let scale = target.scales("scale", &self.scale)?;
        let min = target.each_or("min", &self.min, 0.0)?;
        target.all(|k| Ok(WeibullQuantile { shape: shape[k], scale: scale[k], min: min[k] }))
    }
}

impl Quantile for WeibullQuantile {
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
