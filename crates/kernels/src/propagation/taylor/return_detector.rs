//! [`ReturnDetector`]: search for the period of omega in all lanes, by their [`super::period::PoincareSection`]s.

use super::period::PoincareSection;
use crate::math::Real;
use crate::math::vector::{difference, dot};

/// Sections of all lanes; a lane without a search has a direction of zero and never returns.
#[derive(Clone, Copy, Debug)]
pub struct ReturnDetector<R> {
    start: [R; 3],
    direction: [R; 3],
    extent2: R,
    side: R,
}

impl<R: Real> ReturnDetector<R> {
    /// No searches.
    pub fn none(zero: R) -> Self {
        ReturnDetector { start: [zero; 3], direction: [zero; 3], extent2: zero, side: zero }
    }

    /// Sets the section of `lane`, or ends its search.
    pub fn set(&mut self, lane: usize, section: Option<&PoincareSection>) {
        let nothing = PoincareSection { start: [0.0; 3], direction: [0.0; 3], extent2: 0.0, side: 0.0 };
        let section = section.unwrap_or(&nothing);
        for i in 0..3 {
            self.start[i].set_lane(lane, section.start[i]);
            self.direction[i].set_lane(lane, section.direction[i]);
        }
        self.extent2.set_lane(lane, section.extent2);
        self.side.set_lane(lane, section.side);
    }

    /// Section of `lane`, with `side` from before the last step.
    pub fn section(&self, lane: usize) -> PoincareSection {
        let three = |v: &[R; 3]| [v[0].lane(lane), v[1].lane(lane), v[2].lane(lane)];
        PoincareSection {
            start: three(&self.start),
            direction: three(&self.direction),
            extent2: self.extent2.lane(lane),
            side: self.side.lane(lane),
        }
    }

    /// Updates the sections with omega at the end of a step; true in lanes that may have come back through their
    /// section.
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
