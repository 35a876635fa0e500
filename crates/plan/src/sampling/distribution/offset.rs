//! `offset`: a fixed difference from the nominal value in every sample but the nominal one, `offset` or
//! `relative_offset`.

use super::prelude::*;

/// Always this value; takes no u.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Offset(pub f64);

impl Scalar for Offset {
    const NAME: &'static str = "offset";
    const KEYS: &'static [Row] = &[
        Row::amounts("offset", "Difference from the nominal value"),
        Row::values("relative_offset", "The same as a fraction of the nominal value"),
    ];
    const RULES: &'static [Rule] = &[Rule::One(&[&["offset"], &["relative_offset"]], "0.1", ALL_BUT_ONE)];
    type Quantile = Self;

    fn of(target: &Target<'_>) -> Result<Vec<Self>> {
        let offsets = target.amounts("offset", "relative_offset")?;
        target.all(|k| Ok(Self(target.nominals[k] + offsets[k])))
    }
}

impl Quantile for Offset {
    #[inline]
    fn quantile(&self, _u: f64) -> f64 {
        self.0
    }

    #[inline]
    fn dimensions(&self) -> usize {
        0
    }

    fn text(&self, _words: NumberWords<'_>) -> String {
        "fixed".to_owned()
    }
}
