//! `random`: independent uniform numbers, one stream for each dimension.

use super::traits::{BLOCK, Dimensions, Kind, PointSource, streams};
use crate::sampling::keys::Written;
use crate::sampling::stream::Stream;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RandomDesign;

#[derive(Debug)]
pub struct RandomPoints(Vec<Stream>);

impl RandomPoints {
    /// The points of these dimensions.
    pub fn new(dimensions: Dimensions<'_>) -> Self {
        RandomPoints(streams(dimensions.seed, dimensions.names))
    }
}

impl PointSource for RandomPoints {
    fn fill(&mut self, block: u64, u: &mut [[f64; BLOCK]]) {
        for (stream, u) in self.0.iter_mut().zip(u) {
            stream.uniforms(block, u);
        }
    }
}

impl Kind for RandomDesign {
    const NAME: &'static str = "random";
    type Points = RandomPoints;

    fn of(_written: &Written) -> Self {
        RandomDesign
    }

    fn points(&self, dimensions: Dimensions<'_>) -> RandomPoints {
        RandomPoints::new(dimensions)
    }
}
