//! [`Step`]: start, end and length of a step.

use crate::math::real::Real;

/// Start, end and length of a step.
#[derive(Clone, Copy)]
pub struct Step<R> {
    /// Time at the start, s.
    pub time: R,
    /// Time at the end, s: the node one, to the last bit.
    pub end: R,
    /// Length, s.
    pub length: R,
}

impl<R: Real> Step<R> {
    /// The first part of the step, of `length`, s.
    #[inline(always)]
    pub fn part(&self, length: R) -> Self {
        Step { time: self.time, end: self.time + length, length }
    }

    /// Time at the fraction `node` of the step.
    #[inline(always)]
    pub(super) fn at(&self, node: f64) -> R {
        if node == 1.0 { self.end } else { self.length.mul_add(self.length.splat(node), self.time) }
    }
}
