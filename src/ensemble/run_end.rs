//! [`RunEnd`]: the event that ends a run.
//!
//! Where a run ends is found in one that goes on to the end of the campaign. It is then flown again up to there, so
//! that its row is the one that it would have in a campaign of that duration, observed at the same points and at its
//! end.

use crate::run::Grid;

/// The event that ends a run, and when.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RunEnd {
    /// Its place among the events of the plan.
    pub event: usize,
    /// s, positive.
    pub time: f64,
}

impl RunEnd {
    /// The points of `grid` up to this end, which is the last; how many of them are before it, or at it, in `grid`.
    pub fn grid(self, grid: &Grid) -> (Grid, usize) {
        let before = grid.times().partition_point(|time| *time < self.time);
        let is_point = grid.times().get(before) == Some(&self.time);
        let times = grid.times()[..before].iter().copied().chain([self.time]).collect();
        (Grid::at(times), before + usize::from(is_point))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: a run that ends is observed at the points before its end, and there; a point at the end itself is one of
    /// the campaign.
    #[test]
    fn the_last_point_is_the_end() {
        let grid = Grid::uniform(10.0, 11);
        for (time, times, of_campaign) in [
            (2.5, vec![0.0, 1.0, 2.0, 2.5], 3),
            (2.0, vec![0.0, 1.0, 2.0], 3),
            (1e-11, vec![0.0, 1e-11], 1),
            (10.0, grid.times().to_vec(), 11),
        ] {
            let (found, before) = RunEnd { event: 0, time }.grid(&grid);
            assert_eq!((found.times(), before), (&times[..], of_campaign));
        }
    }
}
