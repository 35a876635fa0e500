//! [`FoldBuffer`]: folded observation points of several lanes, sorted by series and evaluated.

use fearless_simd::Simd;

use super::dense::{Segment, values_in_lane};
use super::series_ring::LARGEST;
use crate::math::lanes::WIDTH;
use crate::math::{Lanes, Real};

/// Observation points of waiting lanes with a known period; rows per lane.
#[derive(Clone, Debug)]
pub struct FoldBuffer {
    /// Points of a lane with padding: row length of `rest`, `whole`, `segment`, `place`.
    pub stride: usize,
    /// Row length of `x`: the points of each series are padded to whole vectors.
    capacity: usize,
    /// Used length of `x` per lane: the length of a component in a row of `values`.
    used: Vec<usize>,
    /// Time since the start of the arc minus whole periods.
    pub rest: Vec<f64>,
    /// Whole periods before each point.
    pub whole: Vec<f64>,
    /// Series of a point, counted from the oldest of all lanes.
    pub segment: Vec<u32>,
    /// Position of a point in `x` and `values` (before `FoldBuffer::sort` its number within its series).
    pub place: Vec<u32>,
    /// Points per series of a lane.
    pub count: Vec<u32>,
    /// First position of each series.
    first: Vec<u32>,
    /// Starts of the series, high and low part.
    pub start: [Vec<f64>; 2],
    /// Time since the start of the series.
    x: Vec<f64>,
    /// Components, one after another.
    values: Vec<f64>,
}

/// Limit of series of all lanes together.
const SERIES: usize = 2 * LARGEST;

impl FoldBuffer {
    pub fn new(lanes: usize, components: usize, points: usize) -> Self {
        let stride = points.next_multiple_of(WIDTH) + WIDTH;
        let capacity = stride + LARGEST * WIDTH;
        FoldBuffer {
            stride,
            capacity,
            used: vec![0; lanes],
            rest: vec![0.0; lanes * stride],
            whole: vec![0.0; lanes * stride],
            segment: vec![0; lanes * stride],
            place: vec![0; lanes * stride],
            count: vec![0; lanes * SERIES],
            first: vec![0; lanes * (SERIES + 1)],
            start: [vec![0.0; lanes * SERIES], vec![0.0; lanes * SERIES]],
            x: vec![0.0; lanes * capacity],
            values: vec![0.0; lanes * capacity * components],
        }
    }

    /// Records the starts of `series` series and clears all counts.
    #[inline(always)]
    pub(super) fn note_starts<'a, R: Real + 'a, const J: usize>(
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

    /// Assigns adjacent positions to the points of each of the `series` (numbers) of `lane`, which has `points` points.
    #[inline(always)]
    pub(super) fn sort<R: Real>(&mut self, lane: usize, points: usize, series: core::ops::Range<usize>) {
        let first = &mut self.first[lane * (SERIES + 1)..];
        let mut next = 0;
        for number in series.clone() {
            first[number] = next;
            next += self.count[number * R::LANES + lane].next_multiple_of(WIDTH as u32);
        }
        first[series.end] = next;
        self.used[lane] = next as usize;
        // slices, so that the compiler knows that stores do not change them
        let first = &first[..=series.end];
        let x = &mut self.x[lane * self.capacity..][..next as usize];
        x.fill(0.0);
        let (start, start_low) = (&self.start[0][lane..], &self.start[1][lane..]);
        let range = lane * self.stride..lane * self.stride + points;
        let entries = self.place[range.clone()].iter_mut().zip(&self.segment[range.clone()]).zip(&self.rest[range]);
        for ((place, number), rest) in entries {
            let number = *number as usize;
            *place += first[number];
            x[*place as usize] = (rest - start[number * R::LANES]) - start_low[number * R::LANES];
        }
    }

    /// Evaluates series `number` of `lane` at its points: two vectors of eight share a coefficient.
    #[inline(always)]
    pub(super) fn evaluate<S: Simd, R: Real, const J: usize>(
        &mut self,
        simd: S,
        lane: usize,
        number: usize,
        jet: &[[R; J]],
    ) {
        let first = &self.first[lane * (SERIES + 1)..];
        let (mut at, end) = (first[number] as usize, first[number + 1] as usize);
        let used = self.used[lane];
        let x = &self.x[lane * self.capacity..][..used];
        let values = &mut self.values[lane * self.capacity * J..][..used * J];
        while at + 2 * WIDTH <= end {
            let x = [Lanes::from_slice(simd, &x[at..]), Lanes::from_slice(simd, &x[at + WIDTH..])];
            let found = values_in_lane::<S, R, J, 2>(jet, lane, x);
            note(values, used, at, &found[0]);
            note(values, used, at + WIDTH, &found[1]);
            at += 2 * WIDTH;
        }
        if at < end {
            let [found] = values_in_lane::<S, R, J, 1>(jet, lane, [Lanes::from_slice(simd, &x[at..])]);
            note(values, used, at, &found);
        }
    }

    /// Components of the eight points of `lane` at `places`.
    #[inline(always)]
    pub(super) fn at_places<S: Simd, const J: usize>(
        &self,
        simd: S,
        lane: usize,
        places: &[u32; WIDTH],
    ) -> [Lanes<S>; J] {
        let used = self.used[lane];
        let values = &self.values[lane * self.capacity * J..][..used * J];
        let mut found = [Lanes::broadcast(simd, 0.0); J];
        for (component, found) in found.iter_mut().enumerate() {
            let column = &values[component * used..][..used];
            let mut gathered = [0.0; WIDTH];
            for (value, place) in gathered.iter_mut().zip(places) {
                *value = column[*place as usize];
            }
            *found = Lanes::load(simd, &gathered);
        }
        found
    }
}

#[inline(always)]
fn note<S: Simd, const J: usize>(values: &mut [f64], used: usize, at: usize, found: &[Lanes<S>; J]) {
    for (component, value) in found.iter().enumerate() {
        value.store(&mut values[component * used + at..]);
    }
}
