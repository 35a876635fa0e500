//! The points of runs that wait with a known period: folded into it, evaluated in company, unfolded.
//!
//! A run's points, folded by its period, lie scattered over the few steps of that period. All lanes that wait are evaluated
//! together, series by series, each lane at its own points: a coefficient of all lanes is one load, and serves several points.
//! What follows is one run at a time again, eight points to a vector in order of time: the turn of the whole periods
//! and the growth of the integrals.
#![expect(clippy::needless_range_loop, reason = "components are numbered alike in several arrays")]

use fearless_simd::Simd;

use super::dense::{Segment, value_at, values};
use super::driver::{CompletionCallback, Driver};
use super::lane_state::LaneState;
use super::period::Period;
use super::points::factors;
use super::workspace::PeriodFolding;
use crate::dynamics::gyrostat::{ANGLE, ATTITUDE, WITH_ANGLES, WITH_ATTITUDE};
use crate::math::lanes::{TWO_52, WIDEST, WIDTH};
use crate::math::vector::hamilton;
use crate::math::{Lanes, Real};
use crate::run::Trajectory;

/// Steps that a lane waits at most beyond as many as its period took.
const SLACK: usize = 8;

/// A lane's share of a pass.
#[derive(Clone, Copy, Debug)]
struct FoldedLane {
    lane: usize,
    place: LaneState,
    period: Option<Period>,
    /// The step of the march after the last series.
    end: usize,
    /// Number of points of the stretch.
    points: usize,
}

impl<S: Simd, R: Real, const N: usize, const J: usize, const FORCED: bool> Driver<'_, S, R, N, J, FORCED> {
    /// Whether the lanes that wait should be evaluated now.
    ///
    /// A pass costs the same for one lane as for all, so it waits for those that still look for their period, but not for
    /// long, and not beyond the series that are kept.
    pub(super) fn should_fold(&self) -> bool {
        let (mut waiting, mut searching) = (0, 0);
        let (mut patient, mut now) = (true, false);
        for place in self.places.iter().flatten() {
            match &place.waits {
                Some(wait) => {
                    waiting += 1;
                    patient &= self.clock < place.patience(wait);
                    let own = wait.since - place.begun;
                    now |= self.clock >= wait.since + own + SLACK;
                    now |= self.clock - place.begun >= self.work.ring.len();
                }
                None if place.watching => searching += 1,
                None => {}
            }
        }
        waiting > 0 && (now || searching == 0 || (!patient && waiting >= 3 * searching))
    }

    /// Evaluates all points of the stretches in the lanes that wait, and sends those lanes on.
    #[inline(never)]
    pub(super) fn fold(&mut self, finish: &mut CompletionCallback<'_>) {
        let mut shares = [None; WIDEST];
        for lane in 0..R::LANES {
            if let Some(place) = self.places[lane]
                && let Some(wait) = place.waits
            {
                let run = &self.runs[place.run];
                let times = &self.grid.times()[place.point..];
                let last = place.stretch + 1 == run.stretches.len();
                let bound = run.stretches[place.stretch].end;
                let points = if last { times.len() } else { times.partition_point(|time| *time <= bound) };
                shares[lane] = Some(FoldedLane { lane, place, period: wait.period, end: wait.since, points });
            }
        }
        let simd = self.simd;
        let together = simd.vectorize(
            #[inline(always)]
            || self.evaluate_shares(&shares),
        );
        if !together {
            for lane in 0..R::LANES {
                let mut alone = [None; WIDEST];
                alone[lane] = shares[lane];
                simd.vectorize(
                    #[inline(always)]
                    || self.evaluate_shares(&alone),
                );
            }
        }
        for share in shares.iter().flatten() {
            if let Some(place) = &mut self.places[share.lane] {
                place.point += share.points;
            }
            if share.place.stretch + 1 < self.runs[share.place.run].stretches.len()
                && let Some(period) = &share.period
            {
                simd.vectorize(
                    #[inline(always)]
                    || self.jump_to_end(share, period),
                );
            }
            self.end_stretch(share.lane, finish);
        }
    }

    /// Fills the trajectories of `shares`; false, with nothing done, where they take more vectors together than there is room
    /// for, which one lane alone never does.
    #[inline(always)]
    fn evaluate_shares(&mut self, shares: &[Option<FoldedLane>; WIDEST]) -> bool {
        let Some(oldest) = shares.iter().flatten().map(|share| share.place.begun).min() else { return true };
        let series = shares.iter().flatten().map(|share| share.end).max().unwrap_or(oldest) - oldest;
        let ring = self.work.ring.len();
        self.work.folds.note_starts(series, |number| &self.work.ring[(oldest + number) % ring]);
        for share in shares.iter().flatten() {
            self.assign(share, oldest);
        }
        let folds = &mut self.work.folds;
        let Some(vectors) = folds.number_vectors::<R>(series) else { return false };
        folds.x[..vectors * R::LANES].fill(0.0);
        for share in shares.iter().flatten() {
            folds.place_points::<R>(share.lane, share.points);
        }
        let zero = self.state[0].zero();
        for number in 0..series {
            let jet = &self.work.ring[(oldest + number) % ring].jet;
            folds.evaluate(zero, number, jet);
        }
        for share in shares.iter().flatten() {
            self.unfold(share);
        }
        true
    }

    /// PeriodFolding the points of a lane by its period, and counts them by series.
    #[inline(always)]
    fn assign(&mut self, share: &FoldedLane, oldest: usize) {
        let FoldedLane { lane, place, period, end, points } = share;
        let lanes = R::LANES;
        let bounds = &self.runs[place.run].stretches[place.stretch];
        let simd = self.simd;
        let padded = self.grid.padded_times();
        let start = Lanes::broadcast(simd, bounds.start);
        let inverse = Lanes::broadcast(simd, 1.0 / place.unit);
        let one = Lanes::broadcast(simd, 1.0);
        let PeriodFolding { stride, rest, whole, segment, vector, count, start: [starts, _], .. } =
            &mut self.work.folds;
        let row = lane * *stride;
        // slices, so that no store can be suspected to move the memory behind
        let (starts, count) = (starts.as_slice(), &mut count[*lane..]);
        let row_end = row + points.next_multiple_of(WIDTH);
        let (rest, whole) = (&mut rest[row..row_end], &mut whole[row..row_end]);
        let (segment, vector) = (&mut segment[row..row_end], &mut vector[row..row_end]);
        let (own_first, own_end) = (place.begun - oldest, end - oldest);
        for first in (0..*points).step_by(WIDTH) {
            let time = times_from(simd, padded, place.point + first);
            let local = (time - start) * inverse;
            let (turns, folded) = match period {
                Some(period) => period.fold(local),
                None => (local.zero(), local),
            };
            turns.store(&mut whole[first..]);
            folded.store(&mut rest[first..]);
            // the last series but those that start after the point; the low bits of 2^52 + n are n
            let mut number = Lanes::broadcast(simd, TWO_52 + (own_end - 1) as f64);
            for later in own_first + 1..own_end {
                let before = folded.lt(Lanes::broadcast(simd, starts[later * lanes + lane]));
                number -= Real::select(before, one, one.zero());
            }
            let number = number.to_array();
            for (entry, number) in segment[first..first + WIDTH].iter_mut().zip(number) {
                *entry = number.to_bits() as u32;
            }
        }
        for (number, entry) in segment[..*points].iter().zip(&mut vector[..*points]) {
            let count = &mut count[*number as usize * lanes];
            *entry = *count;
            *count += 1;
        }
    }

    /// Brings the values of a lane's points into order of time, SI, turned and grown by whole periods.
    #[inline(always)]
    fn unfold(&mut self, share: &FoldedLane) {
        let FoldedLane { lane, place, period, end, points } = share;
        let simd = self.simd;
        let ring = &self.work.ring;
        let per_unit = 1.0 / place.unit;
        let factors = factors::<f64, N>(per_unit);
        let growth = match period {
            Some(period) => angle_growth(&ring[place.begun % ring.len()], &ring[(end - 1) % ring.len()], *lane, period),
            None => [0.0; 3],
        };
        let folds = &self.work.folds;
        let trajectory = &mut self.work.trajectories[*lane];
        let row = lane * folds.stride;
        for first in (0..*points).step_by(WIDTH) {
            let mut gathered = [[0.0; WIDTH]; J];
            let numbers = &folds.vector[row + first..row + first + WIDTH];
            let left = points - first;
            for k in 0..WIDTH {
                let vector = numbers[if k < left { k } else { 0 }] as usize;
                let at = (lane * folds.capacity + vector) * J;
                let values = &folds.values[at..at + J];
                for i in 0..J {
                    gathered[i][k] = values[i];
                }
            }
            let whole = Lanes::from_slice(simd, &folds.whole[row + first..]);
            let mut components = [whole; J];
            for i in 0..J {
                components[i] = Lanes::load(simd, &gathered[i]);
            }
            for i in 0..3 {
                components[i] = components[i] * Lanes::broadcast(simd, factors[i]);
            }
            if J >= WITH_ATTITUDE
                && let Some(period) = period
            {
                let q = [components[3], components[4], components[5], components[6]];
                let turned = hamilton(period.turn(whole), q);
                components[ATTITUDE..WITH_ATTITUDE].copy_from_slice(&turned);
            }
            if J >= WITH_ANGLES {
                for i in 0..3 {
                    components[ANGLE + i] = whole.mul_add(Lanes::broadcast(simd, growth[i]), components[ANGLE + i]);
                }
            }
            for i in 0..J {
                write_points(trajectory, i, place.point + first, left, components[i]);
            }
        }
        if N > J {
            let bounds = &self.runs[place.run].stretches[place.stretch];
            for point in place.point..place.point + points {
                let time = (self.grid.times()[point] - bounds.start) * per_unit;
                let riders = place.riders_after::<N, J>(time);
                for i in J..N {
                    trajectory.column_mut(i)[point] = riders[i - J] * factors[i];
                }
            }
        }
    }

    /// Sets the state of a lane to that at the end of its stretch, by folding.
    #[inline(always)]
    fn jump_to_end(&mut self, share: &FoldedLane, period: &Period) {
        let FoldedLane { lane, place, end, .. } = share;
        let lane = *lane;
        let (whole, rest) = period.fold(Lanes::broadcast(self.simd, place.length));
        let (turns, rest) = (whole.lane(0), rest.lane(0));
        let ring = &self.work.ring;
        let mut step = end - 1;
        while step > place.begun && ring[step % ring.len()].start.lane(lane) > rest {
            step -= 1;
        }
        let segment = &ring[step % ring.len()];
        let x = (rest - segment.start.lane(lane)) - segment.start_low.lane(lane);
        let mut at_end = [0.0; N];
        for i in 0..J {
            at_end[i] = value_at(&segment.jet, i, lane, x);
        }
        if J >= WITH_ATTITUDE {
            let turn = period.turn(whole);
            let turn = [turn[0].lane(0), turn[1].lane(0), turn[2].lane(0), turn[3].lane(0)];
            let q = hamilton(turn, [at_end[3], at_end[4], at_end[5], at_end[6]]);
            at_end[ATTITUDE..WITH_ATTITUDE].copy_from_slice(&q);
        }
        if J >= WITH_ANGLES {
            let growth = angle_growth(&ring[place.begun % ring.len()], &ring[(end - 1) % ring.len()], lane, period);
            for i in 0..3 {
                at_end[ANGLE + i] = turns.mul_add(growth[i], at_end[ANGLE + i]);
            }
        }
        let riders = place.riders_after::<N, J>(place.length);
        at_end[J..N].copy_from_slice(&riders[..N - J]);
        for i in 0..N {
            self.state[i].set_lane(lane, at_end[i]);
            self.state_low[i].set_lane(lane, 0.0);
        }
    }
}

impl PeriodFolding {
    /// Takes note of when `series` series start, and forgets all counts.
    #[inline(always)]
    fn note_starts<'a, R: Real + 'a, const J: usize>(
        &mut self,
        series: usize,
        segment: impl Fn(usize) -> &'a Segment<R, J>,
    ) {
        for number in 0..series {
            let segment = segment(number);
            segment.start.write(&mut self.start[0][number * R::LANES..]);
            segment.start_low.write(&mut self.start[1][number * R::LANES..]);
        }
        self.count[..series * R::LANES].fill(0);
    }

    /// Numbers the vectors: as many for a series as its fullest lane has points. `None` where there is no room.
    #[inline(always)]
    fn number_vectors<R: Real>(&mut self, series: usize) -> Option<usize> {
        let mut vectors = 0;
        for number in 0..series {
            self.first[number] = vectors as u32;
            let counts = &self.count[number * R::LANES..(number + 1) * R::LANES];
            let mut most = 0;
            for count in counts {
                most = if *count > most { *count } else { most };
            }
            vectors += most as usize;
        }
        self.first[series] = vectors as u32;
        (vectors <= self.capacity).then_some(vectors)
    }

    /// Puts the points of `lane` into their vectors.
    #[inline(always)]
    fn place_points<R: Real>(&mut self, lane: usize, points: usize) {
        let own = lane * self.stride..lane * self.stride + points;
        // slices, so that no store can be suspected to move the memory behind
        let (first, x) = (self.first.as_slice(), self.x.as_mut_slice());
        let (start, start_low) = (&self.start[0][lane..], &self.start[1][lane..]);
        let entries = self.vector[own.clone()].iter_mut().zip(&self.segment[own.clone()]).zip(&self.rest[own]);
        for ((vector, number), rest) in entries {
            let number = *number as usize;
            let place = (first[number] + *vector) as usize;
            x[place * R::LANES + lane] = (rest - start[number * R::LANES]) - start_low[number * R::LANES];
            *vector = place as u32;
        }
    }

    /// Evaluates series `number`, which is `jet`, at its vectors of points, two at a time.
    #[inline(always)]
    fn evaluate<R: Real, const J: usize>(&mut self, zero: R, number: usize, jet: &[[R; J]]) {
        let (mut vector, end) = (self.first[number] as usize, self.first[number + 1] as usize);
        while vector + 2 <= end {
            let at = vector * R::LANES;
            let found = values(jet, [zero.read(&self.x[at..]), zero.read(&self.x[at + R::LANES..])]);
            self.note_values(vector, &found[0]);
            self.note_values(vector + 1, &found[1]);
            vector += 2;
        }
        if vector < end {
            let [found] = values(jet, [zero.read(&self.x[vector * R::LANES..])]);
            self.note_values(vector, &found);
        }
    }

    /// Writes a vector of components lane by lane: what one run reads later then lies together.
    #[inline(always)]
    fn note_values<R: Real, const J: usize>(&mut self, vector: usize, found: &[R; J]) {
        let mut columns = [[0.0; WIDEST]; J];
        for i in 0..J {
            found[i].write(&mut columns[i]);
        }
        for lane in 0..R::LANES {
            let at = (lane * self.capacity + vector) * J;
            let values = &mut self.values[at..at + J];
            for i in 0..J {
                values[i] = columns[i][lane];
            }
        }
    }
}

/// Growth of the angle in `lane` over one period, given its first and last series.
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

/// Eight times from point `first` on; the last one again behind the end.
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

/// Writes up to eight points of component `component`: all eight where the column has room, since what follows comes later.
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
