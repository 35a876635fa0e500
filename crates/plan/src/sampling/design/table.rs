//! `table`: the rows of a file, for the parameters in its columns; other parameters are drawn as in the random design.

use super::prelude::*;
use super::random::Random;
use super::traits::Size;
use crate::sampling::keys::FILE_OF_PARAMETERS;

#[derive(Debug)]
pub struct TableRows(Random);

impl PointSource for TableRows {
    fn fill(&mut self, block: u64, u: &mut [[f64; BLOCK]]) {
        self.0.fill(block, u);
    }
}

impl Kind for TableRows {
    const FACTS: Facts = Facts::new("table", &[FILE_OF_PARAMETERS], &[]);

    fn size(written: &Written, _dimensions: usize) -> Size {
        written.columns().first().map_or(Size::Any, |column| Size::Points(column.values.len() as u64))
    }

    fn points(written: &Written, dimensions: Dimensions<'_>) -> Self {
        TableRows(Random::points(written, dimensions))
    }
}
