//! What every design implements.

use crate::sampling::error::DispersionError;
use crate::sampling::keys::{DataColumn, Row, Rule, Written};
use crate::sampling::stream::Stream;
use std::fmt::Debug;

/// Samples of a block: block b has the samples 8 b ... 8 b + 7.
pub const BLOCK: usize = 8;

/// Largest number of samples of a campaign: ids stay exact in a double.
pub const MAX_SAMPLES: u64 = 1 << 53;

/// In place of u where a dimension keeps its nominal value.
pub const NOMINAL: f64 = f64::NAN;

/// What a design is made for: the random dimensions of a campaign.
#[derive(Clone, Copy, Debug)]
pub struct Dimensions<'a> {
    pub seed: u64,
    /// Number of samples, sample 0 included.
    pub samples: u64,
    /// The names of the dimensions.
    pub names: &'a [String],
    /// To which distribution each dimension belongs, counted from zero without gaps.
    pub factors: &'a [usize],
}

/// The number of points of a design.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Size {
    /// As many as there are samples; the file must say.
    Any,
    Points(u64),
    /// More than can be numbered.
    TooMany,
}

pub trait Kind: Clone + Debug + PartialEq {
    /// The name in campaign files.
    const NAME: &'static str;
    const KEYS: &'static [Row] = &[];
    /// What its keys have to do with each other.
    const RULES: &'static [Rule] = &[];
    /// Whether the design has a size of its own, so that the file need not give the number of samples.
    const HAS_SIZE: bool = false;
    /// Whether a dimension may keep its nominal value ([`NOMINAL`]).
    const LEAVES_NOMINAL: bool = false;
    /// Most random dimensions that the design has numbers for.
    const MAX_DIMENSIONS: usize = usize::MAX;
    /// Why another number of samples changes every row, if it does; and the remedy.
    const DEPENDS_ON_SAMPLES: Option<[&'static str; 2]> = None;
    /// Why parameters cannot be correlated, if they cannot; and the remedy.
    const EXCLUDES_CORRELATION: Option<[&'static str; 2]> = None;
    type Points: PointSource;

    /// The design of what a file says.
    fn of(written: &Written) -> Self;

    /// What a file says of it.
    fn written(&self) -> Written {
        Written::default()
    }

    /// Number of points for so many random dimensions.
    fn size(&self, _dimensions: usize) -> Size {
        Size::Any
    }

    /// How many designs of the kind it consists of.
    fn replicates(&self) -> u64 {
        1
    }

    /// What else keeps it from having these dimensions and samples (if the file gives a number).
    ///
    /// # Errors
    /// What it is.
    fn check(&self, _dimensions: Dimensions<'_>, _samples: Option<u64>) -> Result<(), DispersionError> {
        Ok(())
    }

    /// The columns of a file whose rows it takes.
    fn columns(&self) -> &[DataColumn] {
        &[]
    }

    /// The points, for one worker.
    fn points(&self, dimensions: Dimensions<'_>) -> Self::Points;
}

/// The points of a design, for one worker. What it keeps only makes neighbours cheap.
pub trait PointSource: Debug {
    /// The numbers of the samples of `block`, dimension by dimension; [`NOMINAL`] where a dimension keeps its nominal
    /// value. What is there for sample 0 means nothing.
    fn fill(&mut self, block: u64, u: &mut [[f64; BLOCK]]);
}

/// One stream for each dimension.
pub(super) fn streams(seed: u64, names: &[String]) -> Vec<Stream> {
    names.iter().map(|name| Stream::new(seed, name)).collect()
}

/// Fills a block from a function of dimension and point: sample k >= 1 is point k - 1.
pub(super) fn by_point(block: u64, u: &mut [[f64; BLOCK]], number: impl Fn(usize, u64) -> f64) {
    for (dimension, u) in u.iter_mut().enumerate() {
        for (lane, u) in u.iter_mut().enumerate() {
            let sample = block * BLOCK as u64 + lane as u64;
            *u = number(dimension, sample.saturating_sub(1));
        }
    }
}
