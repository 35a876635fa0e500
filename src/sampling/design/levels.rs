//! Designs of levels: [`Factorial`] (a full grid) and [`OneAtATime`].
//!
//! A level is a u: with n levels the middles of n equally likely intervals, (i + 1/2)/n, or the quantiles that the file lists.

use super::NOMINAL;

/// The levels of each dimension, as written.
#[derive(Clone, Debug, PartialEq)]
pub enum Levels {
    /// So many in all dimensions (`levels = 5`).
    All(u64),
    /// So many in each, in the order of the file (`levels = [5, 3]`).
    Each(Vec<u64>),
    /// These quantiles of each (`quantiles = [0.05, 0.5, 0.95]`).
    Quantiles(Vec<f64>),
}

impl Levels {
    /// The u of each of `dimensions` dimensions; one level, the median, where the list is too short.
    pub fn of(&self, dimensions: usize) -> Vec<Vec<f64>> {
        let middles = |count: u64| (0..count).map(|i| (i as f64 + 0.5) / count as f64).collect();
        match self {
            Levels::All(count) => vec![middles(*count); dimensions],
            Levels::Each(counts) => (0..dimensions).map(|k| middles(counts.get(k).copied().unwrap_or(1))).collect(),
            Levels::Quantiles(list) => vec![list.clone(); dimensions],
        }
    }
}

/// All combinations of levels; the first dimension changes fastest.
#[derive(Clone, Debug)]
pub struct Factorial {
    levels: Vec<Vec<f64>>,
    /// Points after which a dimension takes its next level.
    strides: Vec<u64>,
}

impl Factorial {
    /// The grid of the `levels` of each dimension.
    pub fn new(levels: Vec<Vec<f64>>) -> Self {
        let mut stride = 1u64;
        let strides = levels.iter().map(|level| {
            let this = stride;
            stride = stride.saturating_mul(level.len() as u64);
            this
        });
        Factorial { strides: strides.collect(), levels }
    }

    /// The number of a point.
    pub fn number(&self, dimension: usize, point: u64) -> f64 {
        let levels = &self.levels[dimension];
        levels[(point / self.strides[dimension] % levels.len() as u64) as usize]
    }
}

/// One dimension after the other through its levels, the others nominal.
#[derive(Clone, Debug)]
pub struct OneAtATime {
    levels: Vec<Vec<f64>>,
    /// The first point of each dimension.
    starts: Vec<u64>,
}

impl OneAtATime {
    /// The design of the `levels` of each dimension.
    pub fn new(levels: Vec<Vec<f64>>) -> Self {
        let mut start = 0;
        let starts = levels.iter().map(|level| {
            let this = start;
            start += level.len() as u64;
            this
        });
        OneAtATime { starts: starts.collect(), levels }
    }

    /// The number of a point; [`NOMINAL`] where another dimension has its turn.
    pub fn number(&self, dimension: usize, point: u64) -> f64 {
        let level = point.checked_sub(self.starts[dimension]).and_then(|level| usize::try_from(level).ok());
        level.and_then(|level| self.levels[dimension].get(level).copied()).unwrap_or(NOMINAL)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_grid_holds_every_combination_once() {
        let grid = Factorial::new(Levels::Each(vec![3, 2, 4]).of(3));
        let mut seen = std::collections::HashSet::new();
        for point in 0..24 {
            assert!(seen.insert([0, 1, 2].map(|dimension| grid.number(dimension, point).to_bits())));
        }
        assert_eq!([0, 1, 2, 3].map(|point| grid.number(0, point)), [1.0 / 6.0, 0.5, 5.0 / 6.0, 1.0 / 6.0]);
        assert_eq!([2, 3, 5, 6].map(|point| grid.number(1, point)), [0.25, 0.75, 0.75, 0.25]);
    }

    #[test]
    fn one_dimension_moves_at_a_time() {
        let design = OneAtATime::new(Levels::Quantiles(vec![0.1, 0.9]).of(3));
        for point in 0..6 {
            let moved: Vec<usize> = (0..3).filter(|dimension| !design.number(*dimension, point).is_nan()).collect();
            assert_eq!(moved, [point as usize / 2]);
        }
        assert_eq!([2, 3].map(|point| design.number(1, point)), [0.1, 0.9]);
        assert!(design.number(2, 6).is_nan(), "beyond the last point all is nominal");
    }
}
