//! Evaluating stored series at observation points: the coefficients of one run broadcast, eight points at a time.

use fearless_simd::Simd;

use crate::dynamics::table::Trajectory;
use crate::math::lanes::WIDTH;
use crate::math::{Lanes, Real};

/// The series of one step in lanes, and when it began: time since the start of the stretch as an unevaluated sum.
#[derive(Clone, Debug)]
pub struct Segment<R, const N: usize> {
    /// Taylor coefficients, order by order.
    pub jet: Vec<[R; N]>,
    /// Start of the step in each lane, high part.
    pub start: R,
    /// Start of the step in each lane, low part.
    pub start_low: R,
}

impl<R: Real, const N: usize> Segment<R, N> {
    /// Room for a series of order `order`.
    pub fn new(zero: R, order: usize) -> Self {
        Segment { jet: vec![[zero; N]; order + 1], start: zero, start_low: zero }
    }
}

/// Observation points of one run that wait to be evaluated, sorted into the segments they lie in.
#[derive(Clone, Debug, Default)]
pub struct Buckets {
    /// Time since the start of the stretch less whole periods, point by point in order of time.
    pub rest: Vec<f64>,
    /// Whole periods before each point.
    pub whole: Vec<f64>,
    /// Index of the segment each point lies in.
    segment: Vec<u32>,
    /// First entry of each segment in `sorted`.
    first: Vec<u32>,
    /// Point numbers, by segment.
    sorted: Vec<u32>,
    /// `rest` in the order of `sorted`.
    sorted_rest: Vec<f64>,
}

impl Buckets {
    /// Room for `points` points and `segments` segments.
    pub fn new(points: usize, segments: usize) -> Self {
        let padded = points.next_multiple_of(WIDTH) + WIDTH;
        Buckets {
            rest: vec![0.0; padded],
            whole: vec![0.0; padded],
            segment: vec![0; padded],
            first: vec![0; segments + 2],
            sorted: vec![0; padded],
            sorted_rest: vec![0.0; padded],
        }
    }

    /// Sorts the first `points` points into segments that start at `starts` (ascending, the first is zero).
    #[inline(always)]
    pub fn sort<S: Simd>(&mut self, simd: S, points: usize, starts: &[f64]) {
        let segments = starts.len();
        if self.first.len() < segments + 2 {
            self.first.resize(segments + 2, 0);
        }
        let one = Lanes::broadcast(simd, 1.0);
        let zero = one.zero();
        for first in (0..points).step_by(WIDTH) {
            let rest = Lanes::from_slice(simd, &self.rest[first..]);
            // how many later segments start at or before the point
            let mut count = zero;
            for start in &starts[1..] {
                let before = rest.lt(Lanes::broadcast(simd, *start));
                count += Real::select(before, zero, one);
            }
            let count = count.to_array();
            for (slot, count) in self.segment[first..first + WIDTH].iter_mut().zip(count) {
                *slot = count as u32;
            }
        }
        self.first[..segments + 2].fill(0);
        for segment in &self.segment[..points] {
            self.first[*segment as usize + 2] += 1;
        }
        for i in 2..segments + 2 {
            self.first[i] += self.first[i - 1];
        }
        // first[s + 1] walks from the start of segment s to its end
        for point in 0..points {
            let place = &mut self.first[self.segment[point] as usize + 1];
            self.sorted[*place as usize] = point as u32;
            self.sorted_rest[*place as usize] = self.rest[point];
            *place += 1;
        }
    }

    /// The places in sorted order of the points in segment `segment`.
    #[inline(always)]
    fn range(&self, segment: usize) -> core::ops::Range<usize> {
        self.first[segment] as usize..self.first[segment + 1] as usize
    }

    /// Evaluates segment `number`, whose series is `segment`, in lane `lane` at its points, and writes them to
    /// `trajectory` from point `offset` on; component `i` is multiplied by `factors[i]`.
    #[inline(always)]
    #[expect(clippy::too_many_arguments, reason = "a hot inner function: one struct more would be taken apart at once")]
    pub fn evaluate<S: Simd, R: Real, const N: usize>(
        &self,
        simd: S,
        number: usize,
        segment: &Segment<R, N>,
        lane: usize,
        order: usize,
        factors: &[f64; N],
        offset: usize,
        trajectory: &mut Trajectory,
    ) {
        let start = Lanes::broadcast(simd, segment.start.lane(lane));
        let start_low = Lanes::broadcast(simd, segment.start_low.lane(lane));
        let range = self.range(number);
        let mut place = range.start;
        while place < range.end {
            let rest = Lanes::from_slice(simd, &self.sorted_rest[place..]);
            let x = (rest - start) - start_low;
            let count = WIDTH.min(range.end - place);
            let points = &self.sorted[place..place + count];
            // components in groups that fit the registers: each group is a set of chains of its own
            let mut component = 0;
            while component + 4 <= N {
                let values = horner::<S, R, N, 4>(simd, &segment.jet, component, lane, order, x);
                scatter(simd, &values, points, &factors[component..], component, offset, trajectory);
                component += 4;
            }
            if component + 3 == N {
                let values = horner::<S, R, N, 3>(simd, &segment.jet, component, lane, order, x);
                scatter(simd, &values, points, &factors[component..], component, offset, trajectory);
                component += 3;
            }
            while component < N {
                let values = horner::<S, R, N, 1>(simd, &segment.jet, component, lane, order, x);
                scatter(simd, &values, points, &factors[component..], component, offset, trajectory);
                component += 1;
            }
            place += WIDTH;
        }
    }
}

/// The series of lane `lane` at eight times, of `G` components from `first` on.
#[inline(always)]
fn horner<S: Simd, R: Real, const N: usize, const G: usize>(
    simd: S,
    jet: &[[R; N]],
    first: usize,
    lane: usize,
    order: usize,
    x: Lanes<S>,
) -> [Lanes<S>; G] {
    let mut sums = [Lanes::broadcast(simd, 0.0); G];
    for coefficients in jet[..=order].iter().rev() {
        for i in 0..G {
            sums[i] = sums[i].mul_add(x, Lanes::broadcast(simd, coefficients[first + i].lane(lane)));
        }
    }
    sums
}

/// Writes the values of up to eight points to their places.
#[inline(always)]
fn scatter<S: Simd, const G: usize>(
    simd: S,
    values: &[Lanes<S>; G],
    points: &[u32],
    factors: &[f64],
    first: usize,
    offset: usize,
    trajectory: &mut Trajectory,
) {
    for i in 0..G {
        let scaled = (values[i] * Lanes::broadcast(simd, factors[i])).to_array();
        let column = &mut trajectory.column_mut(first + i)[offset..];
        for (point, value) in points.iter().zip(scaled) {
            column[*point as usize] = value;
        }
    }
}
