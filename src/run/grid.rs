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
}
