//! `offset`: the same difference from the nominal value in every sample but the nominal one, `offset` or `relative_offset`.

use super::target::Target;
use super::traits::{NumberWords, Quantile, Scalar};
use crate::sampling::error::DispersionError;
use crate::sampling::keys::{KeyReader, KeyWriter, Values};

/// As written.
#[derive(Clone, Debug, PartialEq)]
pub enum Offset {
    /// In the parameter's unit (`offset`).
    Absolute(Values),
    /// As a fraction of the nominal's absolute value (`relative_offset`).
    Relative(Values),
}

/// Ready to be drawn: always this value; takes no u.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fixed(pub f64);

impl Scalar for Offset {
    const NAME: &'static str = "offset";
    type Quantile = Fixed;

    fn read(keys: &mut dyn KeyReader) -> Option<Self> {
        let one = keys.is_one_of(&["offset", "relative_offset"], "0.1");
        let (absolute, relative) = (keys.values("offset"), keys.values("relative_offset"));
        let offset = absolute.map(Offset::Absolute).or(relative.map(Offset::Relative));
        if one { offset } else { None }
    }

    fn write(&self, keys: &mut dyn KeyWriter) {
        match self {
            Offset::Absolute(values) => keys.values("offset", values),
            Offset::Relative(values) => keys.values("relative_offset", values),
        }
    }

    fn quantiles(&self, target: &Target<'_>) -> Result<Vec<Fixed>, DispersionError> {
        let offsets = match self {
            Offset::Absolute(values) => target.each("offset", values)?,
            Offset::Relative(values) => {
                let fractions = target.each("relative_offset", values)?;
                target.relative("relative_offset", values, fractions, "offset")?
            }
        };
        target.all(|k| Ok(Fixed(target.nominals[k] + offsets[k])))
    }
}

impl Quantile for Fixed {
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
