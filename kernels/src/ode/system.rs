//! What an integrator needs of a problem: the right-hand side, in lanes, and a norm of errors.

use crate::math::Real;

/// A first-order system y' = f(t, y) of `N` components, in lanes.
pub trait System<R: Real, const N: usize> {
    /// f(t, y).
    fn derivative(&self, time: R, state: &[R; N]) -> [R; N];

    /// The norm of a step's local error in units of the tolerance: the step is accepted if it is at most one.
    ///
    /// `error` is the difference of the embedded solutions, `old` and `new` are the states at both ends. Each kernel scales its
    /// components by their meaning. The norm must be homogeneous in `error` (twice the error, twice the ratio): the choice of
    /// the first step also asks for the norm of a derivative or of a state.
    fn error_ratio(&self, error: &[R; N], old: &[R; N], new: &[R; N], tolerance: Tolerance) -> R;
}

/// Relative and absolute tolerance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerance {
    /// Relative to the magnitude of the component (or of the vector that it belongs to).
    pub relative: f64,
    /// Absolute, in the unit of the component (or in units of the vector's natural scale).
    pub absolute: f64,
}
