//! [`ReturnDetector`]: search for the period of omega in all lanes, by their [`super::period::PoincareSection`]s.

use super::period::PoincareSection;
use crate::math::prelude::*;

const NONE: PoincareSection = PoincareSection { start: [0.0; 3], direction: [0.0; 3], extent2: 0.0, side: 0.0 };

/// Sections of all lanes; a lane without a search has a direction of zero and never returns.
#[derive(Clone, Copy, Debug)]
pub struct ReturnDetector<R> {
    start: [R; 3],
    direction: [R; 3],
    extent2: R,
    side: R,
}

impl<R: Real> ReturnDetector<R> {
    pub fn none(zero: R) -> Self {
        ReturnDetector { start: [zero; 3], direction: [zero; 3], extent2: zero, side: zero }
    }

    pub fn set(&mut self, lane: usize, section: Option<&PoincareSection>) {
        let section = section.copied().unwrap_or(NONE);
        set_lanes(&mut self.start, lane, &section.start);
        set_lanes(&mut self.direction, lane, &section.direction);
        self.extent2.set_lane(lane, section.extent2);
        self.side.set_lane(lane, section.side);
    }

    /// Section of `lane`, with `side` from before the last step.
    pub fn section(&self, lane: usize) -> PoincareSection {
        PoincareSection {
            start: lane_of(&self.start, lane),
            direction: lane_of(&self.direction, lane),
            extent2: self.extent2.lane(lane),
            side: self.side.lane(lane),
        }
    }

    /// Updates the sections with omega at the end of a step; true in lanes that may have come back through them.
    #[inline(always)]
    pub fn passes(&mut self, omega: [R; 3]) -> R::Mask {
        let zero = self.side.zero();
        let off = difference(omega, self.start);
        let side = dot(off, self.direction);
        let extent2 = dot(off, off);
        let back = self.side.lt(zero) & !side.lt(zero);
        self.side = side;
        self.extent2 = extent2.larger(self.extent2);
        back
    }
}
