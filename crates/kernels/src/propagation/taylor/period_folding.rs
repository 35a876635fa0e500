//! Points of waiting runs with a known period: folded, evaluated together, unfolded.
//!
//! Folded points are scattered over the few steps of a period: sorted by series and evaluated eight at a time for all
//! waiting lanes, so that a series stays in the first-level cache.

use fearless_simd::Simd;

use super::dense::{Segment, value_at};
use super::fold_buffer::FoldBuffer;
use super::lane_state::SeriesLane;
use super::lane_vectors::si_factors;
use super::period::Period;
use super::series_ring::SeriesRing;
use crate::dynamics::gyrostat::{ANGLE, ATTITUDE, WITH_ANGLES, WITH_ATTITUDE};
use crate::math::lanes::TWO_52;
use crate::math::prelude::*;
use crate::math::{Lanes, Real};
use crate::run::{Grid, Trajectory};

/// Largest number of steps that a lane waits beyond those of its period.
const SLACK: usize = 8;

#[derive(Clone, Copy, Debug)]
pub struct FoldedLane {
    pub lane: usize,
    pub state: SeriesLane,
    pub period: Option<Period>,
    pub end: usize,
    /// Number of points of the arc.
    pub points: usize,
}

pub type FoldedLanes = [Option<FoldedLane>; WIDEST];

/// True if the waiting lanes should be evaluated after step `clock`, with the series of the last `kept` steps. An
/// evaluation costs the same for one lane as for all: it waits a little for lanes in search of their period.
pub fn is_due(lanes: &[Option<SeriesLane>; WIDEST], clock: usize, kept: usize) -> bool {
    let (mut waiting, mut searching) = (0, 0);
    let (mut patient, mut now) = (true, false);
    for state in lanes.iter().flatten() {
        match &state.waiting {
            Some(wait) => {
                waiting += 1;
                patient &= clock < state.patience(wait);
                let steps = wait.since - state.begun;
                now |= clock >= wait.since + steps + SLACK;
                now |= clock - state.begun >= kept;
            }
            None if state.is_searching => searching += 1,
            None => {}
        }
    }
    waiting > 0 && (now || searching == 0 || (!patient && waiting >= 3 * searching))
}

/// The waiting lanes with the points of their arcs.
pub fn folded_lanes(lanes: &[Option<SeriesLane>; WIDEST], grid: &Grid) -> FoldedLanes {
    let mut folded = [None; WIDEST];
    for (lane, state) in lanes.iter().enumerate() {
        if let Some(state) = state
            && let Some(wait) = state.waiting
        {
            let times = &grid.times()[state.point..];
            let points = if state.is_last { times.len() } else { times.partition_point(|time| *time <= state.end) };
            folded[lane] = Some(FoldedLane { lane, state: *state, period: wait.period, end: wait.since, points });
        }
    }
    folded
}

pub struct PeriodFolding<'a, S, R, const J: usize> {
    pub simd: S,
    pub grid: &'a Grid,
    pub ring: &'a SeriesRing<R, J>,
    pub folds: &'a mut FoldBuffer,
    pub trajectories: &'a mut [Trajectory],
}

impl<S: Simd, R: Real, const J: usize> PeriodFolding<'_, S, R, J> {
    /// Fills the first `J` columns of the trajectories of `folded`. Not inlined: compiled once for all `N`.
    #[inline(never)]
    pub fn evaluate(&mut self, folded: &FoldedLanes) {
        self.simd.vectorize(
            #[inline(always)]
            || self.evaluate_vectorized(folded),
        );
    }

    #[inline(always)]
    fn evaluate_vectorized(&mut self, folded: &FoldedLanes) {
        let Some(oldest) = folded.iter().flatten().map(|share| share.state.begun).min() else { return };
        let series = folded.iter().flatten().map(|share| share.end).max().unwrap_or(oldest) - oldest;
        let (ring, simd) = (self.ring, self.simd);
        self.folds.note_starts(series, |number| ring.segment(oldest + number));
        for share in folded.iter().flatten() {
            self.assign(share, oldest);
            self.folds.sort::<R>(share.lane, share.points, share.state.begun - oldest..share.end - oldest);
        }
        for number in 0..series {
            let jet = &ring.segment(oldest + number).jet;
            for share in folded.iter().flatten() {
                if (share.state.begun - oldest..share.end - oldest).contains(&number) {
                    self.folds.evaluate(simd, share.lane, number, jet);
                }
            }
        }
        for share in folded.iter().flatten() {
            self.unfold(share);
        }
    }

    /// Folds the points of a lane by its period, and counts them by series.
    #[inline(always)]
    fn assign(&mut self, share: &FoldedLane, oldest: usize) {
        let FoldedLane { lane, state, period, end, points } = share;
        let lanes = R::LANES;
        let simd = self.simd;
        let padded = self.grid.padded_times();
        let start = Lanes::broadcast(simd, state.start);
        let inverse = Lanes::broadcast(simd, 1.0 / state.unit);
        let FoldBuffer { stride, rest, whole, segment, place, count, start: [starts, _], .. } = &mut *self.folds;
        let row = lane * *stride;
        // slices, so that the compiler knows that stores do not change them
        let (starts, count) = (starts.as_slice(), &mut count[*lane..]);
        let row_end = row + points.next_multiple_of(WIDTH);
        let (rest, whole) = (&mut rest[row..row_end], &mut whole[row..row_end]);
        let (segment, place) = (&mut segment[row..row_end], &mut place[row..row_end]);
        let (first_series, end_series) = (state.begun - oldest, end - oldest);
        for first in (0..*points).step_by(WIDTH) {
            let time = times_from(simd, padded, state.point + first);
            let local = (time - start) * inverse;
            let (turns, folded) = match period {
                Some(period) => period.fold(local),
                None => (local.zero(), local),
            };
            turns.store(&mut whole[first..]);
            folded.store(&mut rest[first..]);
            // the last series minus those that start after the point; the low bits of 2^52 + n are n
            let mut number = Lanes::broadcast(simd, TWO_52 + (end_series - 1) as f64);
            for later in first_series + 1..end_series {
                let before = folded.lt(Lanes::broadcast(simd, starts[later * lanes + lane]));
                number -= number.indicator(before);
            }
            let number = number.to_array();
            for (entry, number) in segment[first..first + WIDTH].iter_mut().zip(number) {
                *entry = number.to_bits() as u32;
            }
        }
        for (number, entry) in segment[..*points].iter().zip(&mut place[..*points]) {
            let count = &mut count[*number as usize * lanes];
            *entry = *count;
            *count += 1;
        }
    }

    /// Brings a lane's points into order of time, in SI, rotated and grown by whole periods.
    #[inline(always)]
    fn unfold(&mut self, share: &FoldedLane) {
        let FoldedLane { lane, state, period, end, points } = share;
        let simd = self.simd;
        let ring = self.ring;
        let per_unit = 1.0 / state.unit;
        let factors = si_factors::<f64, J>(per_unit);
        let growth = match period {
            Some(period) => angle_growth(ring.segment(state.begun), ring.segment(end - 1), *lane, period),
            None => [0.0; 3],
        };
        let folds = &*self.folds;
        let trajectory = &mut self.trajectories[*lane];
        let row = lane * folds.stride;
        for first in (0..*points).step_by(WIDTH) {
            let numbers = &folds.place[row + first..row + first + WIDTH];
            let left = points - first;
            let mut places = [0; WIDTH];
            for k in 0..WIDTH {
                places[k] = numbers[if k < left { k } else { 0 }];
            }
            let whole = Lanes::from_slice(simd, &folds.whole[row + first..]);
            let mut components: [Lanes<S>; J] = folds.at_places(simd, *lane, &places);
            for i in 0..3 {
                components[i] = components[i] * Lanes::broadcast(simd, factors[i]);
            }
            if J >= WITH_ATTITUDE
                && let Some(period) = period
            {
                let turned = hamilton(period.turn(whole), four(&components, ATTITUDE));
                components[ATTITUDE..WITH_ATTITUDE].copy_from_slice(&turned);
            }
            if J >= WITH_ANGLES {
                for i in 0..3 {
                    components[ANGLE + i] = whole.mul_add(Lanes::broadcast(simd, growth[i]), components[ANGLE + i]);
                }
            }
            for i in 0..J {
                write_points(trajectory, i, state.point + first, left, components[i]);
            }
        }
    }

    /// Fills the quadrature states, the columns `J` to `N` of the trajectory of `share`.
    #[inline(always)]
    pub fn fill_quadratures<const N: usize>(&mut self, share: &FoldedLane) {
        let FoldedLane { lane, state, points, .. } = share;
        let per_unit = 1.0 / state.unit;
        let factors = si_factors::<f64, N>(per_unit);
        let trajectory = &mut self.trajectories[*lane];
        for point in state.point..state.point + points {
            let time = (self.grid.times()[point] - state.start) * per_unit;
            let quadratures = state.quadratures_after::<N, J>(time);
            for i in J..N {
                trajectory.column_mut(i)[point] = quadratures[i - J] * factors[i];
            }
        }
    }

    #[inline(always)]
    pub fn state_at_end<const N: usize>(&self, share: &FoldedLane, period: &Period) -> [f64; N] {
        let FoldedLane { lane, state, end, .. } = share;
        let lane = *lane;
        let (whole, rest) = period.fold(Lanes::broadcast(self.simd, state.length));
        let (turns, rest) = (whole.lane(0), rest.lane(0));
        let ring = self.ring;
        let mut step = end - 1;
        while step > state.begun && ring.segment(step).start.lane(lane) > rest {
            step -= 1;
        }
        let segment = ring.segment(step);
        let x = (rest - segment.start.lane(lane)) - segment.start_low.lane(lane);
        let mut at_end = [0.0; N];
        for i in 0..J {
            at_end[i] = value_at(&segment.jet, i, lane, x);
        }
        if J >= WITH_ATTITUDE {
            let turn = lane_of(&period.turn(whole), 0);
            let q = hamilton(turn, four(&at_end, ATTITUDE));
            at_end[ATTITUDE..WITH_ATTITUDE].copy_from_slice(&q);
        }
        if J >= WITH_ANGLES {
            let growth = angle_growth(ring.segment(state.begun), ring.segment(end - 1), lane, period);
            for i in 0..3 {
                at_end[ANGLE + i] = turns.mul_add(growth[i], at_end[ANGLE + i]);
            }
        }
        let quadratures = state.quadratures_after::<N, J>(state.length);
        at_end[J..N].copy_from_slice(&quadratures[..N - J]);
        at_end
    }
}

#[inline(always)]
fn angle_growth<R: Real, const J: usize>(
    first: &Segment<R, J>,
    last: &Segment<R, J>,
    lane: usize,
    period: &Period,
) -> [f64; 3] {
    let mut growth = [0.0; 3];
    if J >= WITH_ANGLES {
        let within = (period.length[0] - last.start.lane(lane)) + (period.length[1] - last.start_low.lane(lane));
        for i in 0..3 {
            growth[i] = value_at(&last.jet, ANGLE + i, lane, within) - first.jet[0][ANGLE + i].lane(lane);
        }
    }
    growth
}

/// Eight times from point `first` on; the last one is repeated after the end.
#[inline(always)]
fn times_from<S: Simd>(simd: S, padded: &[f64], first: usize) -> Lanes<S> {
    if first + WIDTH <= padded.len() {
        return Lanes::from_slice(simd, &padded[first..]);
    }
    let mut times = [0.0; WIDTH];
    for (k, time) in times.iter_mut().enumerate() {
        *time = padded[(first + k).min(padded.len() - 1)];
    }
    Lanes::load(simd, &times)
}

/// Writes up to eight points of a component; all eight if the column is long enough, as later points overwrite them.
#[inline(always)]
fn write_points<S: Simd>(trajectory: &mut Trajectory, component: usize, first: usize, count: usize, values: Lanes<S>) {
    let column = &mut trajectory.column_mut(component)[first..];
    if column.len() >= WIDTH {
        values.store(column);
    } else {
        let count = count.min(WIDTH);
        column[..count].copy_from_slice(&values.to_array()[..count]);
    }
}
