//! [`FoldBuffer`]: the folded observation points of several lanes, sorted by series and evaluated together.
#![expect(clippy::needless_range_loop, reason = "components are numbered alike in several arrays")]

use super::dense::{Segment, values};
use super::series_ring::LARGEST;
use crate::math::Real;
use crate::math::lanes::{WIDEST, WIDTH};

/// Observation points of the runs in the lanes that wait with a known period: the time of each within the period, and
/// the components there. Rows are per lane or per vector, as documented.
#[derive(Clone, Debug)]
pub struct FoldBuffer {
    /// Points of a lane with padding: the length of a row of `rest`, `whole`, `segment`, `vector`.
    pub stride: usize,
    /// Largest number of vectors of `x` and `values`.
    pub capacity: usize,
    /// Time since the start of the arc minus whole periods, a row per lane.
    pub rest: Vec<f64>,
    /// Whole periods before each point, a row per lane.
    pub whole: Vec<f64>,
    /// The series of a point, counted from the oldest of all lanes, a row per lane.
    pub segment: Vec<u32>,
    /// The vector of `values` with a point (before numbering: its number within its series), a row per lane.
    pub vector: Vec<u32>,
    /// Points of a lane in a series, series by series.
    pub count: Vec<u32>,
    /// First vector of each series.
    pub first: Vec<u32>,
    /// Starts of the series, high and low part, series by series.
    pub start: [Vec<f64>; 2],
    /// Time since the start of the series, vector by vector.
    pub x: Vec<f64>,
    /// Components, lane by lane, vector by vector.
    pub values: Vec<f64>,
}

impl FoldBuffer {
    /// Memory for `lanes` lanes of `components` components at `points` points.
    pub fn new(lanes: usize, components: usize, points: usize) -> Self {
        let stride = points.next_multiple_of(WIDTH) + WIDTH;
        // one lane alone never needs more than a vector a point
        let capacity = 2 * points + 64;
        let series = 2 * LARGEST;
        FoldBuffer {
            stride,
            capacity,
            rest: vec![0.0; lanes * stride],
            whole: vec![0.0; lanes * stride],
            segment: vec![0; lanes * stride],
            vector: vec![0; lanes * stride],
            count: vec![0; lanes * series],
            first: vec![0; series + 1],
            start: [vec![0.0; lanes * series], vec![0.0; lanes * series]],
            x: vec![0.0; lanes * capacity],
            values: vec![0.0; lanes * capacity * components],
        }
    }
}

impl FoldBuffer {
    /// Notes when `series` series start, and clears all counts.
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

    /// Numbers the vectors: as many for a series as the lane with the most points in it has. `None` where they exceed the capacity.
    #[inline(always)]
    pub(super) fn number_vectors<R: Real>(&mut self, series: usize) -> Option<usize> {
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
    pub(super) fn assign_points<R: Real>(&mut self, lane: usize, points: usize) {
        let range = lane * self.stride..lane * self.stride + points;
        // slices: the compiler then knows that a store does not change them
        let (first, x) = (self.first.as_slice(), self.x.as_mut_slice());
        let (start, start_low) = (&self.start[0][lane..], &self.start[1][lane..]);
        let entries = self.vector[range.clone()].iter_mut().zip(&self.segment[range.clone()]).zip(&self.rest[range]);
        for ((vector, number), rest) in entries {
            let number = *number as usize;
            let index = (first[number] + *vector) as usize;
            x[index * R::LANES + lane] = (rest - start[number * R::LANES]) - start_low[number * R::LANES];
            *vector = index as u32;
        }
    }

    /// Evaluates series `number`, which is `jet`, at its vectors of points, two at a time.
    #[inline(always)]
    pub(super) fn evaluate<R: Real, const J: usize>(&mut self, zero: R, number: usize, jet: &[[R; J]]) {
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

    /// Writes a vector of components lane by lane, so that the values which one run reads later are adjacent.
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
