//! `exponential`: from `min` (0 where it is not written) on, with density proportional to exp(-x/`scale`): a delay, the time to an
//! event. Mean `min` + `scale`.

use super::target::Target;
use super::traits::{NumberWords, Quantile, Scalar};
use crate::sampling::error::DispersionError;
use crate::sampling::keys::{KeyReader, KeyWriter, Values};

/// As written.
#[derive(Clone, Debug, PartialEq)]
pub struct Exponential {
    /// Mean above `min`, in the parameter's unit.
    pub scale: Values,
    /// Lower end.
    pub min: Option<Values>,
}

/// Ready to be drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExponentialQuantile {
    /// Mean above `min`, > 0.
    pub scale: f64,
    /// Lower end.
    pub min: f64,
}

impl Scalar for Exponential {
    const NAME: &'static str = "exponential";
    type Quantile = ExponentialQuantile;

    fn read(keys: &mut dyn KeyReader) -> Option<Self> {
        let (scale, min) = (keys.required("scale", "0.1"), keys.optional("min"));
        scale.zip(min).map(|(scale, min)| Exponential { scale, min })
    }

    fn write(&self, keys: &mut dyn KeyWriter) {
        keys.values("scale", &self.scale);
        keys.optional("min", self.min.as_ref());
    }

    fn quantiles(&self, target: &Target<'_>) -> Result<Vec<ExponentialQuantile>, DispersionError> {
        let scale = target.scales("scale", &self.scale)?;
        let min = target.each_or("min", &self.min, 0.0)?;
        target.all(|k| Ok(ExponentialQuantile { scale: scale[k], min: min[k] }))
    }
}

impl Quantile for ExponentialQuantile {
    /// min - scale ln(1 - u).
    fn quantile(&self, u: f64) -> f64 {
        self.min - self.scale * libm::log1p(-u)
    }

    fn text(&self, words: NumberWords<'_>) -> String {
        format!("exponential, scale {}, from {}", (words.amount)(self.scale), (words.amount)(self.min))
    }
}
