//! [`System`]: the right-hand side in lanes, and a norm of errors.

use super::step::Step;
use crate::math::real::Real;

/// A first-order system y' = f(t, y) of `N` components, in lanes.
pub trait System<R: Real, const N: usize> {
    /// f(t, y).
    fn derivative(&self, time: R, state: &[R; N]) -> [R; N];

    /// Norm of the local error of a step in units of the tolerance; accepted if at most one.
    ///
    /// `error` is the difference of the embedded solutions, `old` and `new` the states at both ends. The norm must be
    /// homogeneous in `error`, since the choice of the first step also applies it to derivatives and states.
    fn error_ratio(&self, error: &[R; N], old: &[R; N], new: &[R; N], tolerance: Tolerance) -> R;

    /// True if an arc continues the motion of the one before, as under a control loop: its first step is that which the
    /// controller proposed last, at most the arc.
    #[inline(always)]
    fn continues(&self) -> bool {
        false
    }

    /// True if f has branches ([`super::switches`]), for which the following methods are.
    #[inline(always)]
    fn has_switches(&self) -> bool {
        false
    }

    /// Smallest switch function; negative once a branch has ended.
    #[inline(always)]
    fn margin(&self, time: R, _state: &[R; N]) -> R {
        time.splat(f64::INFINITY)
    }

    /// Upper bound of the change of a switch function over `length` s, from the states at both ends.
    #[inline(always)]
    fn sway(&self, length: R, _ends: [&[R; N]; 2]) -> R {
        length.splat(f64::INFINITY)
    }

    /// Lanes in which f is not smooth within its branches, as near a fractional power: high order gains nothing.
    #[inline(always)]
    fn is_rough(&self, zero: R) -> R::Mask {
        zero.never()
    }

    /// [`super::switches::dip`] of all switch functions, from states and derivatives at both `ends`.
    #[inline(always)]
    fn dip(&self, step: Step<R>, _ends: [[&[R; N]; 2]; 2]) -> R {
        step.time.splat(f64::INFINITY)
    }
}

/// Relative and absolute tolerance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerance {
    /// Relative to the magnitude of the component, or of its vector.
    pub relative: f64,
    /// In the unit of the component, or in units of the natural scale of its vector.
    pub absolute: f64,
}
