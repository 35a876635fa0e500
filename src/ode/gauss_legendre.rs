//! Gauss-Legendre collocation of order 6 with a fixed step: symmetric, and it keeps every quadratic invariant to round-off.
//!
//! The stages are found by fixed-point iteration to round-off, as Hairer, McLachlan & Razakarivony 2008, *Achieving Brouwer's
//! law with implicit Runge-Kutta methods*, have it: until the change is zero or stops falling. Not Newton's method: the
//! rotations here are not stiff, and a few sweeps cost less than a Jacobian. Each lane stops for itself.

#![allow(
    clippy::needless_range_loop,
    reason = "iterators over lanes are not inlined always, see `super::explicit::each`"
)]

use super::explicit::{Carried, Step, chosen, each, poison, scaled, weighted};
use super::fixed::{Advance, FixedStep};
use super::step_control::{flag, raised};
use super::tableau::{GaussLegendreTableau, Tableau};
use super::{System, Tolerance};
use crate::math::{Mask, Real};
use crate::propagation::local_error::Remainder;

/// Sweeps after which a step counts as too long for the iteration; a contraction by one half gets to round-off in 52.
const MOST_SWEEPS: usize = 60;

/// A change of the stages below this share of the state is near round-off: only there may the iteration end because the
/// change stopped falling. Far above 2^-52, since the stages are sums of several roundings, and far below any accuracy asked.
const NEAR_ROUND_OFF: f64 = 1e-12;

/// The method; see the module.
#[derive(Clone, Copy, Debug)]
pub struct GaussLegendre;

/// Derivatives at the three stages.
type Stages<R, const N: usize> = [[R; N]; 3];

/// Lagrange's polynomial of node `i` among the nodes `i`, `j`, `l`, at `x`.
#[inline(always)]
fn lagrange<R: Real>(x: R, i: usize, j: usize, l: usize) -> R {
    let c = GaussLegendreTableau::C;
    let scale = 1.0 / ((c[i] - c[j]) * (c[i] - c[l]));
    x.splat(scale) * ((x - x.splat(c[j])) * (x - x.splat(c[l])))
}

/// The polynomial through the derivatives `k` of a step, at the fraction `x` of it.
#[inline(always)]
fn derivative_at<R: Real, const N: usize>(k: &Stages<R, N>, x: R) -> [R; N] {
    let w = [lagrange(x, 0, 1, 2), lagrange(x, 1, 0, 2), lagrange(x, 2, 0, 1)];
    each(
        x,
        #[inline(always)]
        |n| w[0].mul_add(k[0][n], w[1].mul_add(k[1][n], w[2] * k[2][n])),
    )
}

/// Iterates the stages from the guess `k`, and takes the step.
#[inline(always)]
fn solved<R: Real, Q: System<R, N>, const N: usize>(
    system: &Q,
    step: Step<R>,
    start: &Carried<R, N>,
    tolerance: Tolerance,
    k: &mut Stages<R, N>,
) -> Advance<R, N> {
    let zero = step.length.zero();
    let one = zero.splat(1.0);
    let state = &start.state;
    let mut open = one;
    let mut failed = one;
    let mut former = zero.splat(f64::INFINITY);
    let mut evaluations = zero;
    let mut sweeps = 0;
    while sweeps < MOST_SWEEPS && raised(open).any() {
        let mut change = zero;
        for i in 0..3 {
            let slope = weighted(k, &GaussLegendreTableau::A[i]);
            let found = system.derivative(step.at(GaussLegendreTableau::C[i]), &start.shifted(step.length, &slope));
            let moved = each(
                zero,
                #[inline(always)]
                |n| step.length * (found[n] - k[i][n]),
            );
            change = system.error_ratio(&moved, state, state, tolerance).larger(change);
            // Gauss-Seidel: later stages already use it.
            k[i] = chosen(raised(open), &found, &k[i]);
        }
        evaluations = open.mul_add(zero.splat(3.0), evaluations);
        let way = scaled(step.length, &k[1]);
        let size =
            system.error_ratio(state, state, state, tolerance) + system.error_ratio(&way, state, state, tolerance);
        let near = flag(change.lt(size * zero.splat(NEAR_ROUND_OFF)), zero);
        let falling = flag(change.lt(former), zero);
        // Not `change == 0`: there is no such question, and a change is never negative.
        let still = one - flag(zero.lt(change), zero);
        let done = open * R::select(raised(still), one, near * (one - falling));
        failed -= done;
        open -= done;
        former = change;
        sweeps += 1;
    }
    let end = start.advanced(step.length, &weighted(k, &GaussLegendreTableau::B));
    let nan = R::select(raised(failed), zero.splat(f64::NAN), zero);
    Advance { end, poison: poison(&end.state, nan), evaluations }
}

impl FixedStep for GaussLegendre {
    const REMAINDER: Remainder = Remainder { order: 6, factor: 0.05 };

    type Memory<R: Real, const N: usize> = Stages<R, N>;

    #[inline(always)]
    fn memory<R: Real, const N: usize>(zero: R) -> Stages<R, N> {
        [[zero; N]; 3]
    }

    /// The guess is the former step's polynomial, or, at the start of a stretch, the derivative there.
    #[inline(always)]
    fn step<R: Real, Q: System<R, N>, const N: usize>(
        system: &Q,
        step: Step<R>,
        start: &Carried<R, N>,
        fresh: R,
        tolerance: Tolerance,
        memory: &mut Stages<R, N>,
    ) -> Advance<R, N> {
        let mut guess = *memory;
        for i in 0..3 {
            guess[i] = derivative_at(memory, fresh.splat(1.0 + GaussLegendreTableau::C[i]));
        }
        if raised(fresh).any() {
            let slope = system.derivative(step.time, &start.state);
            for i in 0..3 {
                guess[i] = chosen(raised(fresh), &slope, &guess[i]);
            }
        }
        *memory = guess;
        let advance = solved(system, step, start, tolerance, memory);
        Advance { evaluations: advance.evaluations + fresh, ..advance }
    }

    #[inline(always)]
    fn inside<R: Real, Q: System<R, N>, const N: usize>(
        system: &Q,
        part: Step<R>,
        s: R,
        start: &Carried<R, N>,
        tolerance: Tolerance,
        memory: &Stages<R, N>,
    ) -> Advance<R, N> {
        let mut k = *memory;
        for i in 0..3 {
            k[i] = derivative_at(memory, s * s.splat(GaussLegendreTableau::C[i]));
        }
        solved(system, part, start, tolerance, &mut k)
    }
}
