//! Series of steps and their evaluation, each lane at its own time.

use core::convert::identity;

use fearless_simd::Simd;

use crate::math::{Lanes, Real};

/// The series of one step in lanes, and its start since the start of the arc as an unevaluated sum.
#[derive(Clone, Debug)]
pub struct Segment<R, const J: usize> {
    /// Taylor coefficients, order by order.
    pub jet: Vec<[R; J]>,
    /// Start of the step in each lane, high part.
    pub start: R,
    /// Start of the step in each lane, low part.
    pub start_low: R,
}

impl<R: Real, const J: usize> Segment<R, J> {
    pub fn new(zero: R, order: usize) -> Self {
        Segment { jet: vec![[zero; J]; order + 1], start: zero, start_low: zero }
    }
}

/// All components of `jet` at the `U` times `x`, in groups whose sums stay in registers.
#[inline(always)]
pub fn values<R: Real, const J: usize, const U: usize>(jet: &[[R; J]], x: [R; U]) -> [[R; J]; U] {
    let mut all = [jet[0]; U];
    // rate alone, quaternion two by two, angle alone
    group::<_, _, J, 3, U>(jet, 0, identity, x, &mut all);
    if J > 3 {
        group::<_, _, J, 2, U>(jet, 3, identity, x, &mut all);
        group::<_, _, J, 2, U>(jet, 5, identity, x, &mut all);
    }
    if J > 7 {
        group::<_, _, J, 3, U>(jet, 7, identity, x, &mut all);
    }
    // integrals of effects, if they have series
    for first in 10..J {
        group::<_, _, J, 1, U>(jet, first, identity, x, &mut all);
    }
    all
}

/// Horner's scheme for `G` components from `first` on, with coefficients in the type of `x` by `spread`.
#[inline(always)]
fn group<R: Real, X: Real, const J: usize, const G: usize, const U: usize>(
    jet: &[[R; J]],
    first: usize,
    spread: impl Fn(R) -> X,
    x: [X; U],
    all: &mut [[X; J]; U],
) {
    let Some((last, lower)) = jet.split_last() else { return };
    let mut sums = [[x[0]; G]; U];
    for i in 0..G {
        let coefficient = spread(last[first + i]);
        for u in 0..U {
            sums[u][i] = coefficient;
        }
    }
    for coefficients in lower.iter().rev() {
        for i in 0..G {
            let coefficient = spread(coefficients[first + i]);
            for u in 0..U {
                sums[u][i] = sums[u][i].mul_add(x[u], coefficient);
            }
        }
    }
    for u in 0..U {
        for i in 0..G {
            all[u][first + i] = sums[u][i];
        }
    }
}

#[inline(always)]
pub fn value_at<R: Real, const J: usize>(jet: &[[R; J]], component: usize, lane: usize, x: f64) -> f64 {
    let order = jet.len() - 1;
    let mut sum = jet[order][component].lane(lane);
    for n in (0..order).rev() {
        sum = sum.mul_add(x, jet[n][component].lane(lane));
    }
    sum
}

/// All components in lane `lane` at eight times per vector of `x`, by the operations of [`values`].
#[inline(always)]
pub fn values_in_lane<S: Simd, R: Real, const J: usize, const U: usize>(
    jet: &[[R; J]],
    lane: usize,
    x: [Lanes<S>; U],
) -> [[Lanes<S>; J]; U] {
    let mut all = [[x[0]; J]; U];
    macro_rules! group {
        ($count:literal, $first:literal) => {
            group::<_, _, J, $count, U>(
                jet,
                $first,
                #[inline(always)]
                |coefficient: R| Lanes::broadcast(x[0].simd(), coefficient.lane(lane)),
                x,
                &mut all,
            )
        };
    }
    group!(3, 0);
    if J > 3 {
        group!(4, 3);
    }
    if J > 7 {
        group!(3, 7);
    }
    all
}
