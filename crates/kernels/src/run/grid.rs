//! [`Grid`]: the observation times of a run.

/// Relative tolerance of equal times: a tick k T and a grid point D (k/n) at the same decimal time have five roundings,
/// 5.6e-16.
const SAME: f64 = 4.0 * f64::EPSILON;

/// Number of ascending `times` up to and including `end`.
pub fn points_to(times: &[f64], end: f64) -> usize {
    times.partition_point(|time| *time <= end + SAME * end.abs())
}

/// Number of ascending `times` before `start`.
pub fn points_before(times: &[f64], start: f64) -> usize {
    times.partition_point(|time| *time < start - SAME * start.abs())
}

/// Observation times of a run, s: ascending, from zero to the duration.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    times: Vec<f64>,
    padded: Vec<f64>,
}

impl Grid {
    /// `points` >= 2 equidistant times from zero to `duration`.
    pub fn uniform(duration: f64, points: usize) -> Self {
        let last = (points - 1) as f64;
        Self::at((0..points).map(|k| if k + 1 == points { duration } else { duration * (k as f64 / last) }).collect())
    }

    /// Ascending `times` from zero.
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

    /// The times, with the last repeated up to a multiple of eight, as in a [`super::StateTable`].
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

    /// Indices of `count` points, evenly distributed from the first to the last; all if there are no more.
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
