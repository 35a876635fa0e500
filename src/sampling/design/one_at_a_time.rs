//! `one_at_a_time`: one dimension after the other through its levels, the others nominal.

use super::levels::{LEVELS, Levels, ONE_OF_LEVELS};
use super::traits::{BLOCK, Dimensions, Kind, NOMINAL, PointSource, Size, by_point};
use crate::sampling::error::DispersionError;
use crate::sampling::keys::{Row, Rule, Written};

/// One parameter after the other through its levels, the others nominal.
#[derive(Clone, Debug, PartialEq)]
pub struct OneAtATimeDesign(pub Levels);

#[derive(Clone, Debug)]
pub struct OneAtATime {
    levels: Levels,
    /// The first point of each dimension.
    starts: Vec<u64>,
}

impl OneAtATime {
    /// The design of `levels` in so many dimensions.
    pub fn new(levels: Levels, dimensions: usize) -> Self {
        let mut start = 0u64;
        let starts = (0..dimensions).map(|dimension| {
            let this = start;
            start = start.saturating_add(levels.count(dimension));
            this
        });
        OneAtATime { starts: starts.collect(), levels }
    }

    /// The number of a point; [`NOMINAL`] where it is another dimension that varies.
    pub fn number(&self, dimension: usize, point: u64) -> f64 {
        match point.checked_sub(self.starts[dimension]) {
            Some(index) if index < self.levels.count(dimension) => self.levels.level(dimension, index),
            _ => NOMINAL,
        }
    }
}

impl PointSource for OneAtATime {
    fn fill(&mut self, block: u64, u: &mut [[f64; BLOCK]]) {
        by_point(block, u, |dimension, point| self.number(dimension, point));
    }
}

impl Kind for OneAtATimeDesign {
    const NAME: &'static str = "one_at_a_time";
    const KEYS: &'static [Row] = &LEVELS;
    const RULES: &'static [Rule] = &[ONE_OF_LEVELS];
    const HAS_SIZE: bool = true;
    const LEAVES_NOMINAL: bool = true;
    const EXCLUDES_CORRELATION: Option<[&'static str; 2]> = Some([
        "a design in which parameters may vary together, as [[correlate]] asks",
        "delete [[correlate]], or use another design",
    ]);
    type Points = OneAtATime;

    fn of(written: &Written) -> Self {
        OneAtATimeDesign(Levels::of(written))
    }

    fn written(&self) -> Written {
        self.0.written()
    }

    fn size(&self, dimensions: usize) -> Size {
        let sum = (0..dimensions).try_fold(0u64, |sum, k| sum.checked_add(self.0.count(k)));
        sum.map_or(Size::TooMany, Size::Points)
    }

    fn check(&self, dimensions: Dimensions<'_>, _samples: Option<u64>) -> Result<(), DispersionError> {
        self.0.check(dimensions.names.len())
    }

    fn points(&self, dimensions: Dimensions<'_>) -> OneAtATime {
        OneAtATime::new(self.0.clone(), dimensions.names.len())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_dimension_moves_at_a_time() {
        let design = OneAtATime::new(Levels::Quantiles(vec![0.1, 0.9]), 3);
        for point in 0..6 {
            let moved: Vec<usize> = (0..3).filter(|dimension| !design.number(*dimension, point).is_nan()).collect();
            assert_eq!(moved, [point as usize / 2]);
        }
        assert_eq!([2, 3].map(|point| design.number(1, point)), [0.1, 0.9]);
        assert!(design.number(2, 6).is_nan(), "beyond the last point all is nominal");
    }
}
