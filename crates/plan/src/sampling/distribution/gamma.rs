//! `gamma`: above `min` (default 0) with density proportional to x^(`shape` - 1) exp(-x/`scale`). Mean `min` + `shape`
//! `scale`. Tabulated ([`super::of_score`]) as ln x.

use super::of_score::OfScore;
use super::prelude::*;
use crate::math::incomplete_gamma::log_quantile;

#[derive(Clone, Debug, PartialEq)]
pub struct Gamma {
    shape: f64,
    scale: f64,
    min: f64,
    /// ln of the value above `min` in units of the scale.
    log: OfScore,
}

/// Allowed shapes: below, the distribution is a spike at its end; above, it is normal.
const SHAPES: Range = between(0.01, 1e4);

impl Gamma {
    /// With `shape` from 0.01 to 1e4 and `scale` > 0.
    pub fn new(shape: f64, scale: f64, min: f64) -> Self {
        let log = OfScore::new(&|p, q| log_quantile(p, q, shape), shape);
        Gamma { shape, scale, min, log }
    }
}

impl Scalar for Gamma {
    const NAME: &'static str = "gamma";
    const KEYS: &'static [Row] = &[
        Row::values("shape", "Shape; 1 is the exponential distribution").required("2.0").within(
            "a number from 0.01 to 1e4",
            "1 is the exponential distribution",
            SHAPES,
        ),
        Row::amounts("scale", "Scale above `min`").required("0.1").scale(),
        MIN.or(Presence::Or(0.0)),
    ];
    type Quantile = Self;

    fn of(target: &Target<'_>) -> Result<Vec<Self>> {
        target.of_numbers(["shape", "scale", "min"], |[shape, scale, min]| Gamma::new(shape, scale, min))
    }
}

impl Quantile for Gamma {
    /// The relative error above `min` is below 1e-12 (test `quantiles_are_those_of_mpmath`).
    fn at_score(&self, z: f64) -> Option<f64> {
        Some(self.min + self.scale * libm::exp(self.log.value(z)))
    }

    fn text(&self, words: NumberWords<'_>) -> String {
        format!(
            "gamma, shape {}, scale {}, from {}",
            (words.number)(self.shape),
            (words.amount)(self.scale),
            (words.amount)(self.min)
        )
    }
}
