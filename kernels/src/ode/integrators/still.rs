//! A system with a right-hand side of zero, for tests of dense output.

use crate::ode::system::{System, Tolerance};

/// Unused right-hand side: stages are set by hand.
pub struct Still;
impl<const N: usize> System<f64, N> for Still {
    fn derivative(&self, _time: f64, _state: &[f64; N]) -> [f64; N] {
        [0.0; N]
    }
    fn error_ratio(&self, _: &[f64; N], _: &[f64; N], _: &[f64; N], _: Tolerance) -> f64 {
        0.0
    }
}
