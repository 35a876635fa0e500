//! [`Grid`]: the times at which a run is observed.

/// The times at which a run is observed, s: ascending, the first is zero, the last the duration.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    times: Vec<f64>,
    padded: Vec<f64>,
}

impl Grid {
    /// `points` >= 2 times from zero to `duration` at equal intervals.
    pub fn uniform(duration: f64, points: usize) -> Self {
        let last = (points - 1) as f64;
        Self::at((0..points).map(|k| if k + 1 == points { duration } else { duration * (k as f64 / last) }).collect())
    }

    /// The given times: ascending, the first zero.
    pub fn at(times: Vec<f64>) -> Self {
        let mut padded = times.clone();
        let last = *times.last().expect("a grid has at least one time");
        padded.resize(times.len().next_multiple_of(8), last);
        Grid { times, padded }
    }

    /// The times, s.
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// The times, padded as the columns of a [`super::StateTable`]: the last time is repeated up to a multiple of eight.
    pub fn padded_times(&self) -> &[f64] {
        &self.padded
    }

    /// Number of times.
    pub fn points(&self) -> usize {
        self.times.len()
    }

    /// The last time, s.
    pub fn duration(&self) -> f64 {
        *self.times.last().expect("a grid has at least one time")
    }

    /// `count` of its points, evenly distributed, with the first and the last; all where there are no more.
    pub fn evenly(&self, count: usize) -> Vec<usize> {
        let (points, count) = (self.points(), count.min(self.points()));
        let intervals = count.saturating_sub(1).max(1);
        (0..count).map(|index| (index * (points - 1) + intervals / 2) / intervals).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_are_evenly_distributed() {
        let evenly = |points: usize, count: usize| Grid::uniform(1.0, points).evenly(count);
        assert_eq!((evenly(101, 33).first(), evenly(101, 33).last()), (Some(&0), Some(&100)));
        assert_eq!(evenly(33, 33), (0..33).collect::<Vec<_>>());
        for (points, count) in [(101, 33), (11, 33), (2, 2), (100_000, 257), (100, 99)] {
            let found = evenly(points, count);
            assert_eq!(found.len(), count.min(points));
            let gaps: Vec<usize> = found.windows(2).map(|pair| pair[1] - pair[0]).collect();
            let (least, most) = (gaps.iter().min(), gaps.iter().max());
            assert!(least > Some(&0) && most <= least.map(|least| least + 1).as_ref(), "{points} {count}: {found:?}");
        }
        assert!(evenly(11, 0).is_empty());
    }
}
