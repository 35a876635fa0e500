//! [`SeriesRing`]: series of the last steps of all lanes.

use super::dense::Segment;
use crate::math::Real;

/// Initial capacity in steps; a period within it is found without allocation.
const INITIAL: usize = 24;
/// Largest capacity; a run without a period within it continues as plain Taylor integration.
pub const LARGEST: usize = 192;

/// Series of the last steps; step k is in slot k modulo the length.
#[derive(Clone, Debug)]
pub struct SeriesRing<R, const J: usize> {
    segments: Vec<Segment<R, J>>,
    order: usize,
    pub clock: usize,
}

impl<R: Real, const J: usize> SeriesRing<R, J> {
    pub fn new(zero: R, order: usize) -> Self {
        SeriesRing { segments: (0..INITIAL).map(|_| Segment::new(zero, order)).collect(), order, clock: 0 }
    }

    #[inline(always)]
    pub fn len(&self) -> usize {
        self.segments.len()
    }

    /// The series of step `step`, one of the last.
    #[inline(always)]
    pub fn segment(&self, step: usize) -> &Segment<R, J> {
        &self.segments[step % self.segments.len()]
    }

    #[inline(always)]
    pub fn current(&mut self) -> &mut Segment<R, J> {
        let slot = self.clock % self.segments.len();
        &mut self.segments[slot]
    }

    #[inline(always)]
    pub fn last(&self) -> &Segment<R, J> {
        self.segment(self.clock - 1)
    }

    /// Doubles the capacity and keeps the series; false at [`LARGEST`].
    pub fn grow(&mut self, zero: R) -> bool {
        let old = self.segments.len();
        if old >= LARGEST {
            return false;
        }
        let mut segments: Vec<Segment<R, J>> = (0..2 * old).map(|_| Segment::new(zero, self.order)).collect();
        for step in self.clock.saturating_sub(old)..self.clock {
            core::mem::swap(&mut segments[step % (2 * old)], &mut self.segments[step % old]);
        }
        self.segments = segments;
        true
    }
}
