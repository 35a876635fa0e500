//! `triangular`: between `min` and `max`, most likely at `mode`, else at the nominal value.

use super::target::Target;
use super::traits::{Quantile, Scalar};
use crate::sampling::error::DispersionError;
use crate::sampling::keys::{KeyReader, KeyWriter, Values};

/// As written.
#[derive(Clone, Debug, PartialEq)]
pub struct Triangular {
    /// Lower end.
    pub min: Values,
    /// Upper end.
    pub max: Values,
    /// Most likely value; the nominal where it is not written.
    pub mode: Option<Values>,
}

/// Ready to be drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TriangularQuantile {
    /// Lower bound.
    pub min: f64,
    /// Most likely value.
    pub mode: f64,
    /// Upper bound.
    pub max: f64,
}

impl Scalar for Triangular {
    const NAME: &'static str = "triangular";
    type Quantile = TriangularQuantile;

    fn read(keys: &mut dyn KeyReader) -> Option<Self> {
        let (ends, mode) = (keys.ends(), keys.optional("mode"));
        ends.zip(mode).map(|((min, max), mode)| Triangular { min, max, mode })
    }

    fn write(&self, keys: &mut dyn KeyWriter) {
        keys.ends(&self.min, &self.max);
        keys.optional("mode", self.mode.as_ref());
    }

    fn quantiles(&self, target: &Target<'_>) -> Result<Vec<TriangularQuantile>, DispersionError> {
        let (min, max) = target.ends(&self.min, &self.max)?;
        let mode = target.mode(&self.mode, &min, &max)?;
        target.all(|k| Ok(TriangularQuantile { min: min[k], mode: mode[k], max: max[k] }))
    }
}

impl Quantile for TriangularQuantile {
    fn quantile(&self, u: f64) -> f64 {
        let (rise, fall, width) = (self.mode - self.min, self.max - self.mode, self.max - self.min);
        if u * width < rise {
            self.min + (u * width * rise).sqrt()
        } else {
            self.max - ((1.0 - u) * width * fall).sqrt()
        }
    }

    fn text(&self, short: &dyn Fn(f64) -> String) -> String {
        format!("triangular, {} to {}, mode {}", short(self.min), short(self.max), short(self.mode))
    }
}
