//! [`RunEnd`]: the event that ends a run.
//!
//! The end is found in a run to the end of the campaign, and the run is then flown again up to there: its row is that
//! of a campaign of this duration, observed at the same points and at its end.

use crate::run::Grid;

/// The event that ends a run, and when.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RunEnd {
    /// Index among the events of the plan.
    pub event: usize,
    /// s, positive.
    pub time: f64,
}

impl RunEnd {
    /// The points of `grid` before this end, and the end; with the number of points of `grid` among them.
    pub fn grid(self, grid: &Grid) -> (Grid, usize) {
        let before = grid.times().partition_point(|time| *time < self.time);
        let is_point = grid.times().get(before) == Some(&self.time);
        let times = grid.times()[..before].iter().copied().chain([self.time]).collect();
        (Grid::at(times), before + usize::from(is_point))
    }
}
