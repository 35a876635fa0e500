//! [`RunEnd`]: the event that ends a run.
//!
//! The end is found in a run to the end of the campaign, and the run is then flown again up to there: its row is that of
//! a campaign of this duration, observed at the same points and at its end.

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

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: a run is observed at the points before its end, and there.
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
