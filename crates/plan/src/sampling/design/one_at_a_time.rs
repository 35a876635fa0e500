//! `one_at_a_time`: one dimension after the other through its levels, the others nominal.

use super::levels::{LEVELS, Levels, ONE_OF_LEVELS};
use super::prelude::*;
use super::traits::{NOMINAL, Size};

#[derive(Debug)]
pub struct OneAtATime {
    levels: Levels,
    /// The first point of each dimension.
    starts: Vec<u64>,
}

impl PointSource for OneAtATime {
    fn fill(&mut self, block: u64, u: &mut [[f64; BLOCK]]) {
        by_point(block, u, |dimension, point| match point.checked_sub(self.starts[dimension]) {
            Some(index) if index < self.levels.count(dimension) => self.levels.level(dimension, index),
            _ => NOMINAL,
        });
    }
}

impl Kind for OneAtATime {
    const FACTS: Facts = Facts {
        leaves_nominal: true,
        excludes_correlation: Some([
            "a design in which parameters may vary together, as [[correlate]] asks",
            "delete [[correlate]], or use another design",
        ]),
        ..Facts::new("one_at_a_time", &LEVELS, &[ONE_OF_LEVELS])
    };

    fn size(written: &Written, dimensions: usize) -> Size {
        let levels = Levels::of(written);
        let sum = (0..dimensions).try_fold(0u64, |sum, k| sum.checked_add(levels.count(k)));
        sum.map_or(Size::TooMany, Size::Points)
    }

    fn points(written: &Written, dimensions: Dimensions<'_>) -> Self {
        let levels = Levels::of(written);
        OneAtATime { starts: levels.running(dimensions.names.len(), 0, u64::saturating_add), levels }
    }
}
