//! Return of omega to the start of an arc, and the period that follows from it, in one lane.

use super::dense::value_at;
use super::lane_state::SeriesLane;
use super::period::{Period, PoincareSection};
use super::series_ring::SeriesRing;
use super::workspace::Workspace;
use crate::dynamics::gyrostat::{ATTITUDE, Gyrostat, OMEGA, WITH_ATTITUDE};
use crate::math::prelude::*;

/// Section across the motion of `omega` in a free arc, per unit of time, for the moments' `ratio` and `inverse`.
pub fn section(ratio: [f64; 3], inverse: [f64; 3], momentum: [f64; 3], omega: [f64; 3]) -> Option<PoincareSection> {
    let [x, y, z] = momentum;
    let linear = [y * omega[2] - z * omega[1], z * omega[0] - x * omega[2], x * omega[1] - y * omega[0]];
    let mut rate = [0.0; 3];
    for i in 0..3 {
        // not fused: this is not compiled for an instruction set
        rate[i] = ratio[i] * omega[(i + 1) % 3] * omega[(i + 2) % 3] + inverse[i] * linear[i];
    }
    PoincareSection::new(omega, rate)
}

/// Time of the return within the last step, if the step may have `crossed` back through `section`.
#[inline(always)]
pub fn return_time<R: Real, const J: usize>(
    section: &PoincareSection,
    work: &Workspace<R, J>,
    state: &SeriesLane,
    lane: usize,
    crossed: bool,
    length: f64,
) -> Option<f64> {
    if section.direction == [0.0; 3] {
        // omega does not move: any time is a period
        return (work.ring.clock - state.begun == 1).then_some(length);
    }
    if !crossed {
        return None;
    }
    section.crossing(&work.ring.last().jet, lane, work.rule.order, length, work.settings.tolerance)
}

/// Period of the arc, whose last step returns after `within` units; `momentum_b` is the wheels'.
#[inline(always)]
pub fn period<R: Real, const J: usize>(
    run: &Gyrostat<f64>,
    ring: &SeriesRing<R, J>,
    state: &SeriesLane,
    lane: usize,
    within: f64,
    mut momentum_b: [f64; 3],
) -> Option<Period> {
    let segment = ring.last();
    let start = segment.start.lane(lane);
    let sum = start + within;
    let length = [sum, (within - (sum - start)) + segment.start_low.lane(lane)];
    if J < WITH_ATTITUDE {
        return Some(Period { length, half_turns: 0.0, axis_e: [0.0; 3] });
    }
    let first = &ring.segment(state.begun).jet[0];
    let (mut start, mut end) = ([0.0; 4], [0.0; 4]);
    for i in 0..4 {
        start[i] = first[ATTITUDE + i].lane(lane);
        end[i] = value_at(&segment.jet, ATTITUDE + i, lane, within);
    }
    let mut scale = 0.0_f64;
    for i in 0..3 {
        let body = run.moments[i] * first[OMEGA + i].lane(lane);
        momentum_b[i] += body;
        scale = scale.max(body.abs());
    }
    Period::new(length, start, end, product(dcm_from_quaternion(start), momentum_b), scale)
}
