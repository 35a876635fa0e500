//! The classical Runge-Kutta method of order 4 with a fixed step.

use super::super::error_model::Remainder;
use super::super::explicit::{Carried, Step, fill_stages, poison, weighted};
use super::super::fixed::{Advance, FixedStep};
use super::super::system::{System, Tolerance};
use super::super::tableau::{RungeKutta4Tableau, Tableau};
use crate::math::Real;

/// The classical Runge-Kutta method of order 4.
#[derive(Clone, Copy, Debug)]
pub struct RungeKutta4;

impl FixedStep for RungeKutta4 {
    const REMAINDER: Remainder = Remainder { order: 4, factor: 1.0 };

    /// The derivative at the start.
    type Memory<R: Real, const N: usize> = [R; N];

    #[inline(always)]
    fn memory<R: Real, const N: usize>(zero: R) -> [R; N] {
        [zero; N]
    }

    #[inline(always)]
    fn step<R: Real, Q: System<R, N>, const N: usize>(
        system: &Q,
        step: Step<R>,
        start: &Carried<R, N>,
        _first: R::Mask,
        tolerance: Tolerance,
        memory: &mut [R; N],
    ) -> Advance<R, N> {
        *memory = system.derivative(step.time, &start.state);
        let advance = Self::inside(system, step, step.length, start, tolerance, memory);
        Advance { evaluations: step.length.splat(4.0), ..advance }
    }

    #[inline(always)]
    fn inside<R: Real, Q: System<R, N>, const N: usize>(
        system: &Q,
        part: Step<R>,
        _s: R,
        start: &Carried<R, N>,
        _tolerance: Tolerance,
        memory: &[R; N],
    ) -> Advance<R, N> {
        let mut k = [*memory; 4];
        fill_stages::<RungeKutta4Tableau, R, Q, N, 4>(system, part, start, &mut k, (1, 4, 4));
        let end = start.advanced(part.length, &weighted(&k, &RungeKutta4Tableau::B));
        let poison = poison(&end.state, part.length.zero());
        Advance { end, poison, evaluations: part.length.splat(3.0) }
    }
}
