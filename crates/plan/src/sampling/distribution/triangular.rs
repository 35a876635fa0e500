//! `triangular`: between `min` and `max`, most likely at `mode` (default: the nominal value).

use super::prelude::*;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triangular {
    pub min: f64,
    pub mode: f64,
    pub max: f64,
}

impl Scalar for Triangular {
    const NAME: &'static str = "triangular";
    const KEYS: &'static [Row] =
        &[MIN.required("0.0"), MAX.required("1.0"), Row::amounts("mode", "Most likely value").or(Presence::OrNominal)];
    type Quantile = Self;

    fn of(target: &Target<'_>) -> Result<Vec<Self>> {
        target.check_mode()?;
        target.of_numbers(["min", "mode", "max"], |[min, mode, max]| Triangular { min, mode, max })
    }
}

impl Quantile for Triangular {
    fn quantile(&self, u: f64) -> f64 {
        if !(self.max - self.min).is_finite() {
            let [min, mode, max] = [self.min, self.mode, self.max].map(|x| 0.25 * x);
            return 4.0 * Triangular { min, mode, max }.quantile(u);
        }
        let (rise, fall, width) = (self.mode - self.min, self.max - self.mode, self.max - self.min);
        // the product of two finite lengths may overflow
        let mean = |part: f64, side: f64| {
            let product = part * width * side;
            if product.is_finite() { product.sqrt() } else { (part * width).sqrt() * side.sqrt() }
        };
        if u * width < rise { self.min + mean(u, rise) } else { self.max - mean(1.0 - u, fall) }
    }

    fn text(&self, words: NumberWords<'_>) -> String {
        format!(
            "triangular, {} to {}, mode {}",
            (words.amount)(self.min),
            (words.amount)(self.max),
            (words.amount)(self.mode)
        )
    }
}
