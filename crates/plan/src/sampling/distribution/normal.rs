//! `normal`: normal about the nominal value, with standard deviation `std` or `relative_std`, or a third of
//! `three_sigma`.

use super::prelude::*;

/// The keys of a standard deviation.
pub(super) const SPREAD: [Row; 3] = [
    Row::amounts("std", "Standard deviation").not_negative(),
    Row::values("relative_std", "Standard deviation as a fraction of the nominal value").not_negative(),
    Row { multiple_of: Some(("std", 3.0)), ..Row::amounts("three_sigma", "Three times the standard deviation") },
];

pub(super) const ONE_SPREAD: Rule = Rule::One(&[&["std"], &["relative_std"], &["three_sigma"]], "0.1", ALL_BUT_ONE);

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Normal {
    pub mean: f64,
    /// Standard deviation, >= 0.
    pub std: f64,
}

impl Scalar for Normal {
    const NAME: &'static str = "normal";
    const KEYS: &'static [Row] = &SPREAD;
    const RULES: &'static [Rule] = &[ONE_SPREAD];
    type Quantile = Self;

    fn of(target: &Target<'_>) -> Result<Vec<Self>> {
        let stds = target.amounts("std", "relative_std")?;
        target.all(|k| Ok(Self { mean: target.nominals[k], std: stds[k] }))
    }
}

impl Quantile for Normal {
    #[inline]
    fn at_score(&self, z: f64) -> Option<f64> {
        Some(self.mean + self.std * z)
    }

    fn normal_std(&self) -> Option<f64> {
        Some(self.std)
    }

    fn text(&self, words: NumberWords<'_>) -> String {
        format!("normal, std {}", (words.amount)(self.std))
    }
}
