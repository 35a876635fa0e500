//! The classical Runge-Kutta method of order 4 with a fixed step.

use super::super::error_model::Remainder;
use super::super::explicit::{Carried, Step, fill_stages, poison, weighted};
use super::super::fixed::{Advance, FixedStep};
use super::super::system::{System, Tolerance};
use super::super::tableau::{RungeKutta4Tableau, Tableau};
use crate::math::real::Real;

/// The classical Runge-Kutta method of order 4.
#[derive(Clone, Copy, Debug)]
pub struct RungeKutta4;

impl FixedStep for RungeKutta4 {
    const REMAINDER: Remainder = Remainder { order: 4, factor: 1.0 };

    /// Derivatives at the stages; the first is that at the start.
    type Memory<R: Real, const N: usize> = [[R; N]; 4];

    #[inline(always)]
    fn memory<R: Real, const N: usize>(zero: R) -> [[R; N]; 4] {
        [[zero; N]; 4]
    }

    #[inline(always)]
    fn step<R: Real, Q: System<R, N>, const N: usize>(
        system: &Q,
        step: Step<R>,
        start: &Carried<R, N>,
        _first: R::Mask,
        _tolerance: Tolerance,
        memory: &mut [[R; N]; 4],
        end: &mut Carried<R, N>,
    ) -> Advance<R> {
        memory[0] = system.derivative(step.time, &start.state);
        let poison = finish(system, step, start, memory, end);
        Advance { poison, evaluations: step.length.splat(4.0) }
    }

    #[inline(always)]
    fn inside<R: Real, Q: System<R, N>, const N: usize>(
        system: &Q,
        part: Step<R>,
        _s: R,
        start: &Carried<R, N>,
        _tolerance: Tolerance,
        memory: &[[R; N]; 4],
        end: &mut Carried<R, N>,
    ) -> Advance<R> {
        let mut k = *memory;
        let poison = finish(system, part, start, &mut k, end);
        Advance { poison, evaluations: part.length.splat(3.0) }
    }
}

/// Fills the stages of `k` after the first and takes the step; zero if it is sound, else NaN.
#[inline(always)]
fn finish<R: Real, Q: System<R, N>, const N: usize>(
    system: &Q,
    step: Step<R>,
    start: &Carried<R, N>,
    k: &mut [[R; N]; 4],
    end: &mut Carried<R, N>,
) -> R {
    fill_stages::<RungeKutta4Tableau, R, Q, N, 4>(system, step, start, k, 1..4, 4, end);
    start.advance_into(step.length, &weighted(k, &RungeKutta4Tableau::B), end);
    poison(&end.state, step.length.zero())
}
