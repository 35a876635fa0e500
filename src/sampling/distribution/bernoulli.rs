//! `bernoulli`: another `value` with some `probability`, else the nominal value.

use super::choice::ChoiceQuantile;
use super::target::Target;
use super::traits::Scalar;
use crate::sampling::error::DispersionError;
use crate::sampling::keys::{KeyReader, KeyWriter, Values};

/// As written.
#[derive(Clone, Debug, PartialEq)]
pub struct Bernoulli {
    /// The other value.
    pub value: Values,
    /// Its probability.
    pub probability: Values,
}

impl Scalar for Bernoulli {
    const NAME: &'static str = "bernoulli";
    type Quantile = ChoiceQuantile;

    fn read(keys: &mut dyn KeyReader) -> Option<Self> {
        let (value, probability) = (keys.required("value", "0.0"), keys.required("probability", "0.05"));
        value.zip(probability).map(|(value, probability)| Bernoulli { value, probability })
    }

    fn write(&self, keys: &mut dyn KeyWriter) {
        keys.values("value", &self.value);
        keys.values("probability", &self.probability);
    }

    fn quantiles(&self, target: &Target<'_>) -> Result<Vec<ChoiceQuantile>, DispersionError> {
        let is_probability = |x| (0.0..=1.0).contains(&x);
        let remedy = "0.05 is one in twenty";
        let p = target.passing("probability", &self.probability, is_probability, "from 0 to 1", remedy)?;
        let value = target.each("value", &self.value)?;
        target.all(|k| Ok(ChoiceQuantile::new(&[target.nominals[k], value[k]], &[1.0 - p[k], p[k]])))
    }
}
