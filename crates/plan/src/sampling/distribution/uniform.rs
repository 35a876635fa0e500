//! `uniform`: between `min` and `max`, or about the nominal value by `half_width` or `relative_half_width`.

use super::prelude::*;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Uniform {
    pub min: f64,
    /// Upper bound, >= min.
    pub max: f64,
}

impl Scalar for Uniform {
    const NAME: &'static str = "uniform";
    const KEYS: &'static [Row] = &[
        Row::amounts("half_width", "Distance from the nominal value to either end").not_negative(),
        Row::values("relative_half_width", "The same as a fraction of the nominal value").not_negative(),
        MIN,
        MAX,
    ];
    const RULES: &'static [Rule] = &[
        Rule::One(&[&["half_width"], &["relative_half_width"], &["min", "max"]], "0.1", ALL_BUT_ONE),
        Rule::Together([("min", "0.0"), ("max", "1.0")]),
    ];
    type Quantile = Self;

    fn of(target: &Target<'_>) -> Result<Vec<Self>> {
        if target.written.has("min") {
            let (min, max) = target.ends()?;
            return target.all(|k| Ok(Self { min: min[k], max: max[k] }));
        }
        let half = target.amounts("half_width", "relative_half_width")?;
        target.all(|k| {
            let nominal = target.nominals[k];
            if !(nominal.abs() + half[k]).is_finite() && nominal.is_finite() {
                let key = if target.written.has("half_width") { "half_width" } else { "relative_half_width" };
                let allowed = "such that its ends are finite numbers";
                return target.refused(key, format!("{:?}", half[k]), allowed, "write a smaller one");
            }
            Ok(Self { min: nominal - half[k], max: nominal + half[k] })
        })
    }
}

impl Quantile for Uniform {
    #[inline]
    fn quantile(&self, u: f64) -> f64 {
        let width = self.max - self.min;
        if width.is_finite() { self.min + u * width } else { (1.0 - u) * self.min + u * self.max }
    }

    fn text(&self, words: NumberWords<'_>) -> String {
        format!("uniform, {} to {}", (words.amount)(self.min), (words.amount)(self.max))
    }
}
