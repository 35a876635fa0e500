//! `beta`: between `min` and `max`, with density proportional to x^(`alpha` - 1) (1 - x)^(`beta` - 1). Tabulated
//! ([`super::of_score`]) as ln(x/(1 - x)), which is smooth and loses digits at neither end.

use super::of_score::OfScore;
use super::prelude::*;
use crate::math::incomplete_beta::logit_quantile;

/// Allowed shape parameters: outside, the distribution is one spike or two.
const SHAPES: Range = between(0.01, 1e4);

const fn shape(key: &'static str, meaning: &'static str) -> Row {
    let remedy = "1 is a uniform distribution";
    Row::values(key, meaning).within("a number from 0.01 to 1e4", remedy, SHAPES)
}

impl Scalar for Beta {
    const NAME: &'static str = "beta";
    const KEYS: &'static [Row] = &[
        shape("alpha", "First shape parameter").required("2.0"),
        shape("beta", "Second shape parameter").required("5.0"),
        MIN.required("0.0"),
        MAX.required("1.0"),
    ];
    type Quantile = Self;

    fn of(target: &Target<'_>) -> Result<Vec<Self>> {
        target.each("alpha").and(target.each("beta")).and(target.ends())?;
        let of = |[alpha, beta, min, max]: [f64; 4]| Beta::new(alpha, beta, min, max);
        target.of_numbers(["alpha", "beta", "min", "max"], of)
    }
}

#[derive(Clone, Debug, PartialEq)]
pub struct Beta {
    alpha: f64,
    beta: f64,
    min: f64,
    max: f64,
    /// ln(x/(1 - x)) of the place x in the interval.
    logit: OfScore,
}

impl Beta {
    /// With shapes from 0.01 to 1e4.
    pub fn new(alpha: f64, beta: f64, min: f64, max: f64) -> Self {
        let logit = OfScore::new(&|p, q| logit_quantile(p, q, alpha, beta), alpha.min(beta));
        Beta { alpha, beta, min, max, logit }
    }
}

impl Quantile for Beta {
    /// The relative error of its distance from the nearer end is below 1e-12 (test
    /// `quantiles_are_those_of_mpmath`).
    fn at_score(&self, z: f64) -> Option<f64> {
        let logit = self.logit.value(z);
        let odds = libm::exp(-logit.abs());
        let place = odds / (1.0 + odds);
        let width = self.max - self.min;
        let (near, far) = if logit <= 0.0 { (self.min, self.max) } else { (self.max, self.min) };
        let value = if width.is_finite() {
            if logit <= 0.0 { near + width * place } else { near - width * place }
        } else {
            (1.0 - place) * near + place * far
        };
        Some(value.clamp(self.min, self.max))
    }

    fn text(&self, words: NumberWords<'_>) -> String {
        let [alpha, beta] = [self.alpha, self.beta].map(words.number);
        let [min, max] = [self.min, self.max].map(words.amount);
        format!("beta({alpha}, {beta}), {min} to {max}")
    }
}
