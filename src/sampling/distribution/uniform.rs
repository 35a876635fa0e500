//! `uniform`: between `min` and `max`, or about the nominal value by `half_width` or `relative_half_width`.

use super::target::Target;
use super::traits::{NumberWords, Quantile, Scalar};
use crate::sampling::error::DispersionError;
use crate::sampling::keys::{KeyReader, KeyWriter, Values};

/// As written.
#[derive(Clone, Debug, PartialEq)]
pub enum Uniform {
    /// Between two numbers in the parameter's unit (`min`, `max`).
    Between {
        /// Lower end.
        min: Values,
        /// Upper end.
        max: Values,
    },
    /// So far on both sides of the nominal, in the parameter's unit (`half_width`).
    Around(Values),
    /// So far on both sides, as a fraction of the nominal's absolute value (`relative_half_width`).
    AroundRelative(Values),
}

/// Ready to be drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UniformQuantile {
    /// Lower bound.
    pub min: f64,
    /// Upper bound, >= min.
    pub max: f64,
}

impl Scalar for Uniform {
    const NAME: &'static str = "uniform";
    type Quantile = UniformQuantile;

    fn read(keys: &mut dyn KeyReader) -> Option<Self> {
        let first = if keys.has("max") && !keys.has("min") { "max" } else { "min" };
        let one = keys.is_one_of(&["half_width", "relative_half_width", first], "0.1");
        let (half, relative) = (keys.values("half_width"), keys.values("relative_half_width"));
        let ends = if one { keys.ends_together(["0.0", "1.0"]) } else { keys.values("min").zip(keys.values("max")) };
        match (half, relative, ends) {
            _ if !one => None,
            (Some(half), ..) => Some(Uniform::Around(half)),
            (_, Some(relative), _) => Some(Uniform::AroundRelative(relative)),
            (.., Some((min, max))) => Some(Uniform::Between { min, max }),
            _ => None,
        }
    }

    fn write(&self, keys: &mut dyn KeyWriter) {
        match self {
            Uniform::Between { min, max } => keys.ends(min, max),
            Uniform::Around(half) => keys.values("half_width", half),
            Uniform::AroundRelative(half) => keys.values("relative_half_width", half),
        }
    }

    fn quantiles(&self, target: &Target<'_>) -> Result<Vec<UniformQuantile>, DispersionError> {
        let half = match self {
            Uniform::Between { min, max } => {
                let (min, max) = target.ends(min, max)?;
                return target.all(|k| Ok(UniformQuantile { min: min[k], max: max[k] }));
            }
            Uniform::Around(half) => target.widths("half_width", half, None)?,
            Uniform::AroundRelative(half) => target.widths("relative_half_width", half, Some("half_width"))?,
        };
        target.all(|k| {
            let nominal = target.nominals[k];
            if !(nominal.abs() + half[k]).is_finite() && nominal.is_finite() {
                let key = if matches!(self, Uniform::Around(_)) { "half_width" } else { "relative_half_width" };
                let allowed = "such that its ends are finite numbers";
                return target.refused(key, format!("{:?}", half[k]), allowed, "write a smaller one");
            }
            Ok(UniformQuantile { min: nominal - half[k], max: nominal + half[k] })
        })
    }
}

impl Quantile for UniformQuantile {
    #[inline]
    fn quantile(&self, u: f64) -> f64 {
        let width = self.max - self.min;
        if width.is_finite() { self.min + u * width } else { (1.0 - u) * self.min + u * self.max }
    }

    fn text(&self, words: NumberWords<'_>) -> String {
        format!("uniform, {} to {}", (words.amount)(self.min), (words.amount)(self.max))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_width_beyond_the_largest_number_gives_finite_values() {
        let quantile = UniformQuantile { min: -1.7e308, max: 1.7e308 };
        for (u, expected) in [(0.25, -0.85e308), (0.5, 0.0), (0.75, 0.85e308)] {
            // half an ulp of numbers of this size, 1e292; measured: exactly that
            assert!((quantile.quantile(u) - expected).abs() < 2e292, "{u}");
        }
    }
}
