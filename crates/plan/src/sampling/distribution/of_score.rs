//! [`OfScore`]: a tabulated smooth function of the normal score.
//!
//! A table takes some milliseconds once and a tenth of a microsecond per draw; Newton's method for beta(1e4, 1e4) takes
//! 10 us a draw.

use crate::math::chebyshev::Pieces;
use crate::math::normal::probability;
use std::sync::Arc;

/// Scores of u from 2^-53 to 1 - 2^-53.
const FARTHEST: f64 = 8.3;
/// Error relative to the larger of 1 and the value: below the distributions' 1e-12.
const TOLERANCE: f64 = 1e-13;

#[derive(Clone, Debug, PartialEq)]
pub struct OfScore(Arc<Pieces>);

impl OfScore {
    /// `of` takes a probability and its complement; `shape` is the smallest shape parameter, by which rounding errors
    /// are divided.
    pub fn new(of: &dyn Fn(f64, f64) -> f64, shape: f64) -> Self {
        let noise = 8.0 * f64::EPSILON / shape.min(1.0);
        // tails are half a square of the score
        let tolerance = |value: f64| TOLERANCE.max(noise).max(16.0 * f64::EPSILON * value);
        OfScore(Arc::new(Pieces::new(&|z| of(probability(z), probability(-z)), -FARTHEST, FARTHEST, &tolerance)))
    }

    #[inline]
    pub fn value(&self, z: f64) -> f64 {
        self.0.value(z)
    }
}
