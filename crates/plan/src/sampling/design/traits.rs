//! [`Kind`]: the trait of designs.

use crate::sampling::error::Result;
use crate::sampling::keys::{Row, Rule, Written};
use crate::sampling::stream::Stream;
use std::fmt::Debug;

/// Block b holds samples 8 b to 8 b + 7.
pub const BLOCK: usize = 8;

/// Ids stay exact in a double.
pub const MAX_SAMPLES: u64 = 1 << 53;

/// u of a dimension at its nominal value.
pub const NOMINAL: f64 = f64::NAN;

#[derive(Clone, Copy, Debug)]
pub struct Dimensions<'a> {
    pub seed: u64,
    /// Sample 0 included.
    pub samples: u64,
    pub names: &'a [String],
    /// The distribution of each, by consecutive indices.
    pub factors: &'a [usize],
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Size {
    /// As the file states.
    Any,
    Points(u64),
    /// More than can be numbered.
    TooMany,
}

#[derive(Clone, Copy, Debug)]
pub struct Facts {
    pub name: &'static str,
    pub keys: &'static [Row],
    pub rules: &'static [Rule],
    /// True if a dimension may keep its nominal value ([`NOMINAL`]).
    pub leaves_nominal: bool,
    pub max_dimensions: usize,
    /// Why every row depends on the number of samples, and the remedy.
    pub depends_on_samples: Option<[&'static str; 2]>,
    /// Why parameters cannot be correlated, and the remedy.
    pub excludes_correlation: Option<[&'static str; 2]>,
}

impl Facts {
    /// For any number of dimensions and samples, correlated or not.
    pub const fn new(name: &'static str, keys: &'static [Row], rules: &'static [Rule]) -> Self {
        Facts {
            name,
            keys,
            rules,
            leaves_nominal: false,
            max_dimensions: usize::MAX,
            depends_on_samples: None,
            excludes_correlation: None,
        }
    }
}

pub trait Kind: PointSource + Sized {
    const FACTS: Facts;

    fn size(_written: &Written, _dimensions: usize) -> Size {
        Size::Any
    }

    /// # Errors
    /// An impossible number of samples.
    fn check(_dimensions: Dimensions<'_>, _samples: Option<u64>) -> Result<()> {
        Ok(())
    }

    fn points(written: &Written, dimensions: Dimensions<'_>) -> Self;
}

/// The points of a design, for one worker.
pub trait PointSource: Debug {
    /// Writes u of the samples of `block`, by dimension, or [`NOMINAL`]; arbitrary for sample 0.
    fn fill(&mut self, block: u64, u: &mut [[f64; BLOCK]]);
}

pub(super) fn streams(seed: u64, names: &[String]) -> Vec<Stream> {
    names.iter().map(|name| Stream::new(seed, name)).collect()
}

/// Sample k >= 1 is point k - 1.
pub(super) fn by_point(block: u64, u: &mut [[f64; BLOCK]], number: impl Fn(usize, u64) -> f64) {
    for (dimension, u) in u.iter_mut().enumerate() {
        for (lane, u) in u.iter_mut().enumerate() {
            let sample = block * BLOCK as u64 + lane as u64;
            *u = number(dimension, sample.saturating_sub(1));
        }
    }
}
