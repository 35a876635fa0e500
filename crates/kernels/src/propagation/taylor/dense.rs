//! Series of steps and their evaluation, each lane at its own time.
#![expect(
    clippy::needless_range_loop,
    clippy::manual_memcpy,
    reason = "components are numbered alike in several arrays; a copy by slices leaves the registers"
)]

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

/// All components of `jet` at the `U` times `x`, in groups whose sums stay in registers while a loaded coefficient
/// serves all times.
#[inline(always)]
pub fn values<R: Real, const J: usize, const U: usize>(jet: &[[R; J]], x: [R; U]) -> [[R; J]; U] {
    let mut all = [jet[0]; U];
    // rate alone, quaternion two by two, angle alone
    group::<R, J, 3, U>(jet, 0, x, &mut all);
    if J > 3 {
        group::<R, J, 2, U>(jet, 3, x, &mut all);
        group::<R, J, 2, U>(jet, 5, x, &mut all);
    }
    if J > 7 {
        group::<R, J, 3, U>(jet, 7, x, &mut all);
    }
    // integrals of effects, if they have series
    for first in 10..J {
        group::<R, J, 1, U>(jet, first, x, &mut all);
    }
    all
}

/// Horner's scheme for `G` components from `first` on.
#[inline(always)]
fn group<R: Real, const J: usize, const G: usize, const U: usize>(
    jet: &[[R; J]],
    first: usize,
    x: [R; U],
    all: &mut [[R; J]; U],
) {
    let Some((last, lower)) = jet.split_last() else { return };
    let mut sums = [[x[0]; G]; U];
    for u in 0..U {
        for i in 0..G {
            sums[u][i] = last[first + i];
        }
    }
    for coefficients in lower.iter().rev() {
        for i in 0..G {
            let coefficient = coefficients[first + i];
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
    group_in_lane::<S, R, J, 3, U>(jet, lane, 0, x, &mut all);
    if J > 3 {
        group_in_lane::<S, R, J, 4, U>(jet, lane, 3, x, &mut all);
    }
    if J > 7 {
        group_in_lane::<S, R, J, 3, U>(jet, lane, 7, x, &mut all);
    }
    all
}

#[inline(always)]
fn group_in_lane<S: Simd, R: Real, const J: usize, const G: usize, const U: usize>(
    jet: &[[R; J]],
    lane: usize,
    first: usize,
    x: [Lanes<S>; U],
    all: &mut [[Lanes<S>; J]; U],
) {
    let Some((last, lower)) = jet.split_last() else { return };
    let mut sums = [[x[0]; G]; U];
    for i in 0..G {
        let coefficient = Lanes::broadcast(x[0].simd(), last[first + i].lane(lane));
        for u in 0..U {
            sums[u][i] = coefficient;
        }
    }
    for coefficients in lower.iter().rev() {
        for i in 0..G {
            let coefficient = Lanes::broadcast(x[0].simd(), coefficients[first + i].lane(lane));
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
