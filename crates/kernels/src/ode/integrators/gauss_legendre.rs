//! Gauss-Legendre collocation of order 6 with a fixed step: symmetric, exact in quadratic invariants up to rounding.
//!
//! In each lane by itself, stages are iterated until the change is zero or stops decreasing (Hairer, McLachlan &
//! Razakarivony 2008). Rotations are not stiff: a few sweeps cost less than the Jacobian of Newton's method.

use super::super::error_model::Remainder;
use super::super::explicit::{Carried, Step, chosen, each, poison, scaled, weighted};
use super::super::fixed::{Advance, FixedStep};
use super::super::system::{System, Tolerance};
use super::super::tableau::{GaussLegendreTableau, Tableau};
use crate::math::real::{Mask, Real};

/// Sweeps after which the step is too long: a contraction by one half reaches round-off in 52.
const MOST_SWEEPS: usize = 60;

/// Relative change of the stages below which the iteration ends once the change stops decreasing: far above rounding,
/// far below any tolerance.
const NEAR_ROUND_OFF: f64 = 1e-12;

/// Gauss-Legendre collocation of order 6.
#[derive(Clone, Copy, Debug)]
pub struct GaussLegendre;

type Stages<R, const N: usize> = [[R; N]; 3];

#[inline(always)]
fn lagrange<R: Real>(x: R, i: usize, j: usize, l: usize) -> R {
    let c = GaussLegendreTableau::C;
    let scale = 1.0 / ((c[i] - c[j]) * (c[i] - c[l]));
    x.splat(scale) * ((x - x.splat(c[j])) * (x - x.splat(c[l])))
}

/// Interpolation of the derivatives `k` at the fraction `x` of a step.
#[inline(always)]
fn derivative_at<R: Real, const N: usize>(k: &Stages<R, N>, x: R) -> [R; N] {
    let w = [lagrange(x, 0, 1, 2), lagrange(x, 1, 0, 2), lagrange(x, 2, 0, 1)];
    each!(x, |n| w[0].mul_add(k[0][n], w[1].mul_add(k[1][n], w[2] * k[2][n])))
}

/// Iterates the stages from the guess `k` and takes the step.
#[inline(always)]
fn solved<R: Real, Q: System<R, N>, const N: usize>(
    system: &Q,
    step: Step<R>,
    start: &Carried<R, N>,
    tolerance: Tolerance,
    k: &mut Stages<R, N>,
    end: &mut Carried<R, N>,
) -> Advance<R> {
    let zero = step.length.zero();
    let state = &start.state;
    let mut open = !zero.never();
    let mut former = zero.splat(f64::INFINITY);
    let mut evaluations = zero;
    let mut sweeps = 0;
    while sweeps < MOST_SWEEPS && open.any() {
        let mut change = zero;
        for i in 0..3 {
            let slope = weighted(k, &GaussLegendreTableau::A[i]);
            let found = system.derivative(step.at(GaussLegendreTableau::C[i]), &start.shifted(step.length, &slope));
            let moved = each!(zero, |n| step.length * (found[n] - k[i][n]));
            change = system.error_ratio(&moved, state, state, tolerance).larger(change);
            // Gauss-Seidel: later stages already use it
            k[i] = chosen(open, &found, &k[i]);
        }
        evaluations += R::select(open, zero.splat(3.0), zero);
        let way = scaled(step.length, &k[1]);
        let size =
            system.error_ratio(state, state, state, tolerance) + system.error_ratio(&way, state, state, tolerance);
        let near = change.lt(size * zero.splat(NEAR_ROUND_OFF));
        let still = !zero.lt(change);
        open = open & !(still | (near & !change.lt(former)));
        former = change;
        sweeps += 1;
    }
    start.advance_into(step.length, &weighted(k, &GaussLegendreTableau::B), end);
    let nan = R::select(open, zero.splat(f64::NAN), zero);
    Advance { poison: poison(&end.state, nan), evaluations }
}

impl FixedStep for GaussLegendre {
    const REMAINDER: Remainder = Remainder { order: 6, factor: 0.05 };

    type Memory<R: Real, const N: usize> = Stages<R, N>;

    #[inline(always)]
    fn memory<R: Real, const N: usize>(zero: R) -> Stages<R, N> {
        [[zero; N]; 3]
    }

    /// Initial guess: the polynomial of the previous step, or the derivative at the start of an arc.
    #[inline(always)]
    fn step<R: Real, Q: System<R, N>, const N: usize>(
        system: &Q,
        step: Step<R>,
        start: &Carried<R, N>,
        first: R::Mask,
        tolerance: Tolerance,
        memory: &mut Stages<R, N>,
        end: &mut Carried<R, N>,
    ) -> Advance<R> {
        let previous = *memory;
        for i in 0..3 {
            memory[i] = derivative_at(&previous, step.time.splat(1.0 + GaussLegendreTableau::C[i]));
        }
        if first.any() {
            let slope = system.derivative(step.time, &start.state);
            for i in 0..3 {
                memory[i] = chosen(first, &slope, &memory[i]);
            }
        }
        let advance = solved(system, step, start, tolerance, memory, end);
        Advance { evaluations: advance.evaluations + step.time.indicator(first), ..advance }
    }

    #[inline(always)]
    fn inside<R: Real, Q: System<R, N>, const N: usize>(
        system: &Q,
        part: Step<R>,
        s: R,
        start: &Carried<R, N>,
        tolerance: Tolerance,
        memory: &Stages<R, N>,
        end: &mut Carried<R, N>,
    ) -> Advance<R> {
        let mut k = *memory;
        for i in 0..3 {
            k[i] = derivative_at(memory, s * s.splat(GaussLegendreTableau::C[i]));
        }
        solved(system, part, start, tolerance, &mut k, end)
    }
}
