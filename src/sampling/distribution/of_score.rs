//! [`OfScore`]: a quantile function without closed form, tabulated once as a smooth function of the normal score.
//!
//! Newton's method for each draw was rejected: beta(1e4, 1e4) takes three evaluations of a fraction of 300 terms, some
//! 10 us, a table a tenth of a microsecond after some milliseconds.

use crate::math::chebyshev::Pieces;
use crate::math::normal::probability;
use std::sync::Arc;

/// Bound of the scores of all u, 2^-53 to 1 - 2^-53.
const FARTHEST: f64 = 8.3;
/// Absolute error of a piece relative to the larger of 1 and the value: below the 1e-12 of the distributions.
const TOLERANCE: f64 = 1e-13;

/// A function of the normal score.
#[derive(Clone, Debug, PartialEq)]
pub struct OfScore(Arc<Pieces>);

impl OfScore {
    /// `of` is a function of a probability and its complement. `shape` is the smallest shape parameter: values have an
    /// error of some rounding units divided by it.
    pub fn new(of: &dyn Fn(f64, f64) -> f64, shape: f64) -> Self {
        let noise = 8.0 * f64::EPSILON / shape.min(1.0);
        // values in the tails are half a square of the score and round as the probability does, divided by the shape
        let tolerance = |value: f64| TOLERANCE.max(noise).max(16.0 * f64::EPSILON * value);
        OfScore(Arc::new(Pieces::new(&|z| of(probability(z), probability(-z)), -FARTHEST, FARTHEST, &tolerance)))
    }

    /// The value at `z`, clamped to the scores of draws.
    #[inline]
    pub fn value(&self, z: f64) -> f64 {
        self.0.value(z)
    }
}
