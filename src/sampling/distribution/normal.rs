//! `normal`: normal about the nominal value, with standard deviation `std` or `relative_std`, or a third of `three_sigma`.

use super::target::{Numbers, Target};
use super::traits::{NumberWords, Quantile, Scalar, each_score};
use crate::math::normal::{quantile, quantiles};
use crate::sampling::error::DispersionError;
use crate::sampling::keys::{KeyReader, KeyWriter, Values};

/// A standard deviation as written.
#[derive(Clone, Debug, PartialEq)]
pub enum Spread {
    /// In the parameter's unit (`std`).
    Absolute(Values),
    /// As a fraction of the nominal's absolute value (`relative_std`).
    Relative(Values),
}

impl Spread {
    /// Reads `std`, `relative_std` or `three_sigma`, three times the standard deviation.
    pub(super) fn read(keys: &mut dyn KeyReader) -> Option<Self> {
        let one = keys.is_one_of(&["std", "relative_std", "three_sigma"], "0.1");
        let (absolute, relative) = (keys.values("std"), keys.values("relative_std"));
        let absolute = absolute.or(keys.values("three_sigma").map(|three| match three {
            Values::All(value) => Values::All(value / 3.0),
            Values::Each(list) => Values::Each(list.into_iter().map(|value| value / 3.0).collect()),
        }));
        if one { absolute.map(Spread::Absolute).or(relative.map(Spread::Relative)) } else { None }
    }

    /// Writes it.
    pub(super) fn write(&self, keys: &mut dyn KeyWriter) {
        match self {
            Spread::Absolute(values) => keys.values("std", values),
            Spread::Relative(values) => keys.values("relative_std", values),
        }
    }

    /// Standard deviations in the parameter's unit.
    pub(super) fn deviations(&self, target: &Target<'_>) -> Numbers {
        match self {
            Spread::Absolute(values) => target.widths("std", values, None),
            Spread::Relative(values) => target.widths("relative_std", values, Some("std")),
        }
    }
}

/// As written.
#[derive(Clone, Debug, PartialEq)]
pub struct Normal(pub Spread);

/// Ready to be drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NormalQuantile {
    /// Mean.
    pub mean: f64,
    /// Standard deviation, >= 0.
    pub std: f64,
}

impl Scalar for Normal {
    const NAME: &'static str = "normal";
    type Quantile = NormalQuantile;

    fn read(keys: &mut dyn KeyReader) -> Option<Self> {
        Spread::read(keys).map(Normal)
    }

    fn write(&self, keys: &mut dyn KeyWriter) {
        self.0.write(keys);
    }

    fn quantiles(&self, target: &Target<'_>) -> Result<Vec<NormalQuantile>, DispersionError> {
        let stds = self.0.deviations(target)?;
        target.all(|k| Ok(NormalQuantile { mean: target.nominals[k], std: stds[k] }))
    }
}

impl Quantile for NormalQuantile {
    #[inline]
    fn quantile(&self, u: f64) -> f64 {
        self.mean + self.std * quantile(u)
    }

    #[inline]
    fn quantiles(&self, u: &[f64; 8], values: &mut [f64; 8]) {
        quantiles(u, values);
        for value in values {
            *value = self.mean + self.std * *value;
        }
    }

    #[inline]
    fn of_scores(&self, z: &[f64; 8], values: &mut [f64; 8]) -> bool {
        each_score(z, values, |z| self.mean + self.std * z)
    }

    fn normal_std(&self) -> Option<f64> {
        Some(self.std)
    }

    fn text(&self, words: NumberWords<'_>) -> String {
        format!("normal, std {}", (words.amount)(self.std))
    }
}
