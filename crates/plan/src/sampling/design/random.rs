//! `random`: independent uniform numbers, one stream for each dimension.

use super::prelude::*;
use super::traits::streams;
use crate::sampling::stream::Stream;

#[derive(Debug)]
pub struct Random(Vec<Stream>);

impl PointSource for Random {
    fn fill(&mut self, block: u64, u: &mut [[f64; BLOCK]]) {
        for (stream, u) in self.0.iter_mut().zip(u) {
            stream.uniforms(block, u);
        }
    }
}

impl Kind for Random {
    const FACTS: Facts = Facts::new("random", &[], &[]);

    fn points(_: &Written, dimensions: Dimensions<'_>) -> Self {
        Random(streams(dimensions.seed, dimensions.names))
    }
}
