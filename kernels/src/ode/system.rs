//! What an integrator needs of a problem: the right-hand side, in lanes, and a norm of errors.

use super::step::Step;
use crate::math::real::Real;

/// A first-order system y' = f(t, y) of `N` components, in lanes.
pub trait System<R: Real, const N: usize> {
    /// f(t, y).
    fn derivative(&self, time: R, state: &[R; N]) -> [R; N];

    /// The norm of a step's local error in units of the tolerance: the step is accepted if it is at most one.
    ///
    /// `error` is the difference of the embedded solutions, `old` and `new` are the states at both ends. Each kernel
    /// scales its components by their meaning. The norm must be homogeneous in `error` (twice the error, twice the
    /// ratio): the choice of the first step also asks for the norm of a derivative or of a state.
    fn error_ratio(&self, error: &[R; N], old: &[R; N], new: &[R; N], tolerance: Tolerance) -> R;

    /// Whether f has branches ([`super::switches`]); all that follows is asked only then.
    #[inline(always)]
    fn has_switches(&self) -> bool {
        false
    }

    /// The smallest of the switch functions, each positive where its branch is right: below zero a branch has ended.
    #[inline(always)]
    fn margin(&self, time: R, _state: &[R; N]) -> R {
        time.splat(f64::INFINITY)
    }

    /// Where f is not smooth even within its branches, as at the edge of one where it begins with a fractional power:
    /// there a formula of higher order is no more accurate than one of lower order.
    #[inline(always)]
    fn is_rough(&self, zero: R) -> R::Mask {
        zero.never()
    }

    /// The fraction of `step` at which a switch function may be below zero that is above at both `ends`, states with
    /// their derivatives ([`super::switches::dip`]); infinite where there is none.
    #[inline(always)]
    fn dip(&self, step: Step<R>, _ends: [[&[R; N]; 2]; 2]) -> R {
        step.time.splat(f64::INFINITY)
    }
}

/// Relative and absolute tolerance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerance {
    /// Relative to the magnitude of the component (or of the vector that it belongs to).
    pub relative: f64,
    /// Absolute, in the unit of the component (or in units of the vector's natural scale).
    pub absolute: f64,
}
