//! [`Points`]: where a sample stands in the unit cube. A *design* gives, for each sample and each random dimension, one number
//! u in (0, 1); laws map these to values.
//!
//! Dimensions are known by name (the component's, or the parameter's and a number for a law of several components). Samples
//! come in blocks of eight consecutive ones, [`BLOCK`], because that is what a block of ChaCha holds and what the quantiles
//! take at a time; a number never depends on what was asked before.

use super::stream::Stream;

/// Samples of a block: block b holds the samples 8 b ... 8 b + 7.
pub const BLOCK: usize = 8;

/// The points of a design, for one worker. What it keeps only makes neighbours cheap.
#[derive(Debug)]
pub enum Points {
    /// Independent uniform numbers, one stream each dimension.
    Random(Vec<Stream>),
}

impl Points {
    /// Independent uniform numbers for the dimensions `names`.
    pub fn random(seed: u64, names: &[String]) -> Self {
        Points::Random(names.iter().map(|name| Stream::new(seed, name)).collect())
    }

    /// The numbers of the samples of `block`, dimension by dimension.
    pub fn fill(&mut self, block: u64, u: &mut [[f64; BLOCK]]) {
        match self {
            Points::Random(streams) => {
                for (stream, u) in streams.iter_mut().zip(u) {
                    stream.uniforms(block, u);
                }
            }
        }
    }
}
