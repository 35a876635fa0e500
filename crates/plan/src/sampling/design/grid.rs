//! `grid`: all combinations of levels; the first dimension changes fastest.

use super::levels::{LEVELS, Levels, ONE_OF_LEVELS};
use super::prelude::*;
use super::traits::Size;

#[derive(Debug)]
pub struct Grid {
    levels: Levels,
    /// Points after which a dimension takes its next level.
    strides: Vec<u64>,
}

impl PointSource for Grid {
    fn fill(&mut self, block: u64, u: &mut [[f64; BLOCK]]) {
        by_point(block, u, |dimension, point| {
            let index = point / self.strides[dimension] % self.levels.count(dimension);
            self.levels.level(dimension, index)
        });
    }
}

impl Kind for Grid {
    const FACTS: Facts = Facts {
        excludes_correlation: Some([
            "a design for correlated parameters: with [[correlate]] the levels would not be those that were asked",
            "delete [[correlate]], or use sobol",
        ]),
        ..Facts::new("grid", &LEVELS, &[ONE_OF_LEVELS])
    };

    fn size(written: &Written, dimensions: usize) -> Size {
        let levels = Levels::of(written);
        let product = (0..dimensions).try_fold(1u64, |product, k| product.checked_mul(levels.count(k)));
        product.map_or(Size::TooMany, Size::Points)
    }

    fn points(written: &Written, dimensions: Dimensions<'_>) -> Self {
        let levels = Levels::of(written);
        Grid { strides: levels.running(dimensions.names.len(), 1, u64::saturating_mul), levels }
    }
}
