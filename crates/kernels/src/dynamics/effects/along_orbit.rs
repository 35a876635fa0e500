//! [`Along`]: surroundings of runs in lanes, by their series along the orbits.

use crate::dynamics::gyrostat::Gyrostat;
use crate::dynamics::surroundings::Segment;
use crate::math::prelude::*;

/// Surroundings by series, for arcs within a segment of an orbit that the spacecraft does not leave.
#[derive(Clone, Debug)]
pub struct Along<R> {
    /// Series of the lanes' present arcs.
    pub segment: Segment<R>,
    /// Numbers of the segments; NaN before the first.
    numbers: [f64; WIDEST],
    /// Lanes whose present arcs lie in their segments, or without a run.
    pub is_covered: [bool; WIDEST],
    /// True if that holds in all lanes.
    pub is_everywhere: bool,
    /// True if the present arc of a run lies in its segment.
    pub is_anywhere: bool,
}

impl<R: Real> Along<R> {
    /// Without runs.
    pub fn blank(zero: R) -> Self {
        Along {
            segment: Segment::blank(zero),
            numbers: [f64::NAN; WIDEST],
            is_covered: [true; WIDEST],
            is_everywhere: true,
            is_anywhere: false,
        }
    }

    /// The lane `lane` gets another run.
    pub fn clear(&mut self, lane: usize) {
        self.numbers[lane] = f64::NAN;
        self.is_covered[lane] = true;
    }

    /// The run in lane `lane` has begun an arc.
    pub fn follow(&mut self, lane: usize, run: &mut Gyrostat<f64>) {
        let covering = run.covering();
        if let Some(segment) = covering
            && segment.number() != self.numbers[lane]
        {
            self.numbers[lane] = segment.number();
            self.segment.set_lane(lane, segment);
        }
        self.is_covered[lane] = covering.is_some();
        self.is_everywhere = self.is_covered.iter().all(|is_covered| *is_covered);
        self.is_anywhere =
            self.numbers.iter().zip(&self.is_covered).any(|(number, is_covered)| !number.is_nan() && *is_covered);
    }
}
