//! Stages of explicit Runge-Kutta methods, and the compensated step y' = y + h sum_i b_i k_i of all methods, which
//! carries its rounding error to the next step (Kahan 1965).

use core::marker::PhantomData;
use core::ops::Range;

pub use super::step::Step;
use super::system::System;
use super::tableau::Tableau;
use crate::math::real::Real;
use crate::math::sums::two_sum;

/// Row `I` of a tableau as a constant, so that its sum is unrolled and zeros vanish at compile time.
struct Row<T, const S: usize, const I: usize>(PhantomData<T>);

impl<T: Tableau<S>, const S: usize, const I: usize> Row<T, S, I> {
    const WEIGHTS: [f64; S] = if I < S { T::A[I] } else { [0.0; S] };
}

/// A vector by its components. `core::array::from_fn` and `map` are not always inlined, and then lack the instruction
/// set (measured: thirty times slower).
macro_rules! each {
    ($like:expr, |$n:ident| $component:expr) => {
        $crate::ode::explicit::vector(
            $like,
            #[inline(always)]
            |$n| $component,
        )
    };
}
pub(super) use each;

#[inline(always)]
pub(super) fn vector<R: Copy, const N: usize>(like: R, component: impl Fn(usize) -> R) -> [R; N] {
    let mut vector = [like; N];
    for n in 0..N {
        vector[n] = component(n);
    }
    vector
}

#[inline(always)]
pub(super) fn scaled<R: Real, const N: usize>(length: R, slope: &[R; N]) -> [R; N] {
    each!(length, |n| length * slope[n])
}

/// sum_j w_j k_j.
#[inline(always)]
pub(super) fn weighted<R: Real, const N: usize, const S: usize>(k: &[[R; N]; S], weights: &[f64; S]) -> [R; N] {
    each!(k[0][0], |n| {
        let mut sum = k[0][n].zero();
        for j in 0..S {
            if weights[j] != 0.0 {
                sum = sum.splat(weights[j]).mul_add(k[j][n], sum);
            }
        }
        sum
    })
}

/// sum_j a_ij k_j for stage i. With arms the derivative is called in a loop and inlined once, not per stage.
#[inline(always)]
fn stage_slope<T, R, const N: usize, const S: usize>(stage: usize, k: &[[R; N]; S]) -> [R; N]
where
    T: Tableau<S>,
    R: Real,
{
    macro_rules! arms {
        ($($i:literal)*) => {
            match stage {
                $($i => weighted(k, &Row::<T, S, $i>::WEIGHTS),)*
                _ => [k[0][0].zero(); N],
            }
        };
    }
    arms!(1 2 3 4 5 6 7 8 9 10 11 12 13 14 15)
}

/// A state `state` + `carry`.
#[derive(Clone, Copy)]
pub struct Carried<R, const N: usize> {
    /// The rounded state.
    pub state: [R; N],
    /// Its rounding error.
    pub carry: [R; N],
}

impl<R: Real, const N: usize> Carried<R, N> {
    #[inline(always)]
    pub(super) fn advance_into(&self, length: R, slope: &[R; N], end: &mut Self) {
        for n in 0..N {
            let increment = length.mul_add(slope[n], self.carry[n]);
            (end.state[n], end.carry[n]) = two_sum(self.state[n], increment);
        }
    }

    /// Argument of a stage: the state advanced by `length * slope`, without the carry.
    #[inline(always)]
    pub(super) fn shifted(&self, length: R, slope: &[R; N]) -> [R; N] {
        each!(length, |n| length.mul_add(slope[n], self.state[n]))
    }

    #[inline(always)]
    pub(super) fn select(mask: R::Mask, yes: &Self, no: &Self) -> Self {
        Carried { state: chosen(mask, &yes.state, &no.state), carry: chosen(mask, &yes.carry, &no.carry) }
    }
}

/// `yes` in the lanes where `mask` is true, else `no`.
#[inline(always)]
pub(super) fn chosen<R: Real, const N: usize>(mask: R::Mask, yes: &[R; N], no: &[R; N]) -> [R; N] {
    each!(yes[0], |n| R::select(mask, yes[n], no[n]))
}

/// Zero if all components are finite, else NaN.
#[inline(always)]
pub(super) fn poison<R: Real, const N: usize>(values: &[R; N], sum: R) -> R {
    let mut sum = sum;
    for n in 0..N {
        sum = sum.zero().mul_add(values[n], sum);
    }
    sum
}

/// Fills `stages` of `k`, whose stage zero is given. The argument of stage `closing` is the `end` of the step; with
/// `closing` = `S` the caller takes the step.
#[inline(always)]
pub(super) fn fill_stages<T, R, Q, const N: usize, const S: usize>(
    system: &Q,
    step: Step<R>,
    start: &Carried<R, N>,
    k: &mut [[R; N]; S],
    stages: Range<usize>,
    closing: usize,
    end: &mut Carried<R, N>,
) where
    T: Tableau<S>,
    R: Real,
    Q: System<R, N>,
{
    for i in stages {
        let slope = stage_slope::<T, R, N, S>(i, k);
        let argument = if i == closing {
            start.advance_into(step.length, &slope, end);
            end.state
        } else {
            start.shifted(step.length, &slope)
        };
        k[i] = system.derivative(step.at(T::C[i]), &argument);
    }
}
