//! [`Along`]: surroundings of runs in lanes, by their series along the orbits.

use super::ChangingEffects;
use crate::dynamics::orbit_path::OrbitPath;
use crate::dynamics::surroundings::{Segment, Surroundings};
use crate::math::prelude::*;
use crate::scene::Arc;

/// Surroundings by series, for arcs within a segment of an orbit that the spacecraft does not leave.
#[derive(Clone, Debug)]
pub struct Along<R> {
    /// Series of the lanes' present arcs.
    pub segment: Segment<R>,
    /// Surroundings of the run in each lane, and the number of the segment.
    pub runs: [Option<(Surroundings, f64)>; WIDEST],
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
            runs: [const { None }; WIDEST],
            is_covered: [true; WIDEST],
            is_everywhere: true,
            is_anywhere: false,
        }
    }

    /// The run in lane `lane`, on `path` under `effects`, begins `arc`.
    pub fn follow(&mut self, lane: usize, path: &OrbitPath, effects: &ChangingEffects<f64>, arc: &Arc) {
        let (around, number) = self.runs[lane].get_or_insert_with(|| {
            let field = effects.magnetic_torque.as_ref().map(|torque| torque.field);
            let epoch = effects.solar_pressure.as_ref().map(|pressure| pressure.light.epoch);
            (Surroundings::new(path, field, epoch), f64::NAN)
        });
        let covering = around.covering(arc.start, arc.end());
        if let Some(next) = covering
            && next != *number
        {
            *number = next;
            self.segment.set_lane(lane, &around.segment(next));
        }
        self.is_covered[lane] = covering.is_some();
        self.is_everywhere = self.is_covered.iter().all(|is_covered| *is_covered);
        self.is_anywhere = self.runs.iter().zip(&self.is_covered).any(|(run, is_covered)| run.is_some() && *is_covered);
    }
}
