//! From one period to the whole horizon: attitudes turned by their whole periods, integrals grown by them.
#![expect(clippy::needless_range_loop, reason = "components are numbered alike in several arrays")]

use fearless_simd::Simd;

use super::dense::Segment;
use super::period::Period;
use crate::dynamics::gyrostat::{ATTITUDE, WITH_ATTITUDE};
use crate::dynamics::table::Trajectory;
use crate::math::lanes::WIDTH;
use crate::math::vector::hamilton;
use crate::math::{Lanes, Real};

/// Growth over one period of the components that are integrals of periodic functions; zero for the periodic ones.
#[inline(always)]
pub(super) fn growth<R: Real, const N: usize>(
    first: &[R; N],
    last: &Segment<R, N>,
    lane: usize,
    order: usize,
    period: &Period,
) -> [f64; N] {
    let within = (period.length[0] - last.start.lane(lane)) + (period.length[1] - last.start_low.lane(lane));
    let mut growth = [0.0; N];
    for (i, value) in growth.iter_mut().enumerate().skip(WITH_ATTITUDE) {
        *value = value_at(&last.jet, i, lane, order, within) - first[i].lane(lane);
    }
    growth
}

/// One component of a series, in lane `lane`, at `x`.
#[inline(always)]
pub(super) fn value_at<R: Real, const N: usize>(
    jet: &[[R; N]],
    component: usize,
    lane: usize,
    order: usize,
    x: f64,
) -> f64 {
    let mut sum = jet[order][component].lane(lane);
    for n in (0..order).rev() {
        sum = sum.mul_add(x, jet[n][component].lane(lane));
    }
    sum
}

/// Turns the attitudes by their whole periods and adds what the integrals grew.
#[inline(always)]
pub(super) fn unfold<S: Simd, const N: usize>(
    simd: S,
    period: &Period,
    growth: &[f64; N],
    whole: &[f64],
    offset: usize,
    trajectory: &mut Trajectory,
) {
    if N < WITH_ATTITUDE {
        return;
    }
    for first in (0..whole.len()).step_by(WIDTH) {
        let count = WIDTH.min(whole.len() - first);
        let mut turns = [0.0; WIDTH];
        turns[..count].copy_from_slice(&whole[first..first + count]);
        let turns = Lanes::load(simd, &turns);
        let at = offset + first;
        let q = [
            load_part(simd, &trajectory.column(ATTITUDE)[at..at + count]),
            load_part(simd, &trajectory.column(ATTITUDE + 1)[at..at + count]),
            load_part(simd, &trajectory.column(ATTITUDE + 2)[at..at + count]),
            load_part(simd, &trajectory.column(ATTITUDE + 3)[at..at + count]),
        ];
        let turned = hamilton(period.turn(turns), q);
        for (i, component) in turned.into_iter().enumerate() {
            let values = component.to_array();
            trajectory.column_mut(ATTITUDE + i)[at..at + count].copy_from_slice(&values[..count]);
        }
        for i in WITH_ATTITUDE..N {
            let start = load_part(simd, &trajectory.column(i)[at..at + count]);
            let grown = turns.mul_add(Lanes::broadcast(simd, growth[i]), start).to_array();
            trajectory.column_mut(i)[at..at + count].copy_from_slice(&grown[..count]);
        }
    }
}

/// Up to eight values, zeros behind them.
#[inline(always)]
fn load_part<S: Simd>(simd: S, part: &[f64]) -> Lanes<S> {
    let mut values = [0.0; WIDTH];
    values[..part.len()].copy_from_slice(part);
    Lanes::load(simd, &values)
}
