//! `pert`: the beta distribution between `min` and `max` with shapes 1 + 4 (mode - min)/(max - min) and
//! 1 + 4 (max - mode)/(max - min); `mode` is the nominal value where it is not written.

use super::beta::BetaQuantile;
use super::target::Target;
use super::traits::Scalar;
use crate::sampling::error::DispersionError;
use crate::sampling::keys::{KeyReader, KeyWriter, Values};

/// As written.
#[derive(Clone, Debug, PartialEq)]
pub struct Pert {
    /// Lower end.
    pub min: Values,
    /// Upper end.
    pub max: Values,
    /// Most likely value; the nominal where it is not written.
    pub mode: Option<Values>,
}

impl Scalar for Pert {
    const NAME: &'static str = "pert";
    type Quantile = BetaQuantile;

    fn read(keys: &mut dyn KeyReader) -> Option<Self> {
        let (ends, mode) = (keys.ends(), keys.optional("mode"));
        ends.zip(mode).map(|((min, max), mode)| Pert { min, max, mode })
    }

    fn write(&self, keys: &mut dyn KeyWriter) {
        keys.ends(&self.min, &self.max);
        keys.optional("mode", self.mode.as_ref());
    }

    fn quantiles(&self, target: &Target<'_>) -> Result<Vec<BetaQuantile>, DispersionError> {
        let (min, max) = target.ends(&self.min, &self.max)?;
        let mode = target.mode(&self.mode, &min, &max)?;
        target.all(|k| Ok(BetaQuantile::pert(min[k], mode[k], max[k])))
    }
}
