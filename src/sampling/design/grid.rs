//! `grid`: all combinations of levels; the first dimension changes fastest.

use super::levels::{LEVELS, Levels, ONE_OF_LEVELS};
use super::traits::{BLOCK, Dimensions, Kind, PointSource, Size, by_point};
use crate::sampling::error::DispersionError;
use crate::sampling::keys::{Row, Rule, Written};

#[derive(Clone, Debug, PartialEq)]
pub struct GridDesign(pub Levels);

#[derive(Clone, Debug)]
pub struct Grid {
    levels: Levels,
    /// Points after which a dimension takes its next level.
    strides: Vec<u64>,
}

impl Grid {
    /// The grid of `levels` in so many dimensions.
    pub fn new(levels: Levels, dimensions: usize) -> Self {
        let mut stride = 1u64;
        let strides = (0..dimensions).map(|dimension| {
            let this = stride;
            stride = stride.saturating_mul(levels.count(dimension));
            this
        });
        Grid { strides: strides.collect(), levels }
    }

    /// The number of a point.
    pub fn number(&self, dimension: usize, point: u64) -> f64 {
        let count = self.levels.count(dimension);
        self.levels.level(dimension, point / self.strides[dimension] % count)
    }
}

impl PointSource for Grid {
    fn fill(&mut self, block: u64, u: &mut [[f64; BLOCK]]) {
        by_point(block, u, |dimension, point| self.number(dimension, point));
    }
}

impl Kind for GridDesign {
    const NAME: &'static str = "grid";
    const KEYS: &'static [Row] = &LEVELS;
    const RULES: &'static [Rule] = &[ONE_OF_LEVELS];
    const HAS_SIZE: bool = true;
    const EXCLUDES_CORRELATION: Option<[&'static str; 2]> = Some([
        "a design for correlated parameters: with [[correlate]] the levels would not be those that were asked",
        "delete [[correlate]], or use sobol",
    ]);
    type Points = Grid;

    fn of(written: &Written) -> Self {
        GridDesign(Levels::of(written))
    }

    fn written(&self) -> Written {
        self.0.written()
    }

    fn size(&self, dimensions: usize) -> Size {
        let product = (0..dimensions).try_fold(1u64, |product, k| product.checked_mul(self.0.count(k)));
        product.map_or(Size::TooMany, Size::Points)
    }

    fn check(&self, dimensions: Dimensions<'_>, _samples: Option<u64>) -> Result<(), DispersionError> {
        self.0.check(dimensions.names.len())
    }

    fn points(&self, dimensions: Dimensions<'_>) -> Grid {
        Grid::new(self.0.clone(), dimensions.names.len())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::keys::Counts;

    #[test]
    fn a_grid_holds_every_combination_once() {
        let grid = Grid::new(Levels::Counts(Counts::Each(vec![3, 2, 4])), 3);
        let mut seen = std::collections::HashSet::new();
        for point in 0..24 {
            assert!(seen.insert([0, 1, 2].map(|dimension| grid.number(dimension, point).to_bits())));
        }
        assert_eq!([0, 1, 2, 3].map(|point| grid.number(0, point)), [1.0 / 6.0, 0.5, 5.0 / 6.0, 1.0 / 6.0]);
        assert_eq!([2, 3, 5, 6].map(|point| grid.number(1, point)), [0.25, 0.75, 0.75, 0.25]);
    }

    #[test]
    fn any_number_of_levels_takes_no_memory() {
        let levels = Levels::Counts(Counts::All(1_000_000_000_000));
        assert_eq!(GridDesign(levels.clone()).size(1), Size::Points(1_000_000_000_000));
        assert_eq!(GridDesign(levels.clone()).size(2), Size::TooMany);
        assert_eq!(Grid::new(levels, 1).number(0, 999_999_999_999), (999_999_999_999.0 + 0.5) / 1e12);
    }
}
