//! [`Kind`]: what every design implements; [`Options`]: the keys that designs share.

use crate::sampling::error::DispersionError;
use crate::sampling::keys::{DataColumn, Row, Rule, Written};
use crate::sampling::stream::Stream;
use std::fmt::Debug;

/// Samples of a block: block b holds samples 8 b to 8 b + 7.
pub const BLOCK: usize = 8;

/// Largest number of samples of a campaign: ids stay exact in a double.
pub const MAX_SAMPLES: u64 = 1 << 53;

/// Stands for u where a dimension keeps its nominal value.
pub const NOMINAL: f64 = f64::NAN;

/// The random dimensions of a campaign.
#[derive(Clone, Copy, Debug)]
pub struct Dimensions<'a> {
    pub seed: u64,
    /// Number of samples, sample 0 included.
    pub samples: u64,
    pub names: &'a [String],
    /// The distribution of each dimension, numbered from zero without gaps.
    pub factors: &'a [usize],
}

/// The number of points of a design.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Size {
    /// As many as the file asks for.
    Any,
    Points(u64),
    /// More than can be numbered.
    TooMany,
}

/// The properties of a kind of design that do not depend on its options.
#[derive(Clone, Copy, Debug)]
pub struct Facts {
    /// The name in campaign files.
    pub name: &'static str,
    pub keys: &'static [Row],
    /// Rules between keys.
    pub rules: &'static [Rule],
    /// Whether a dimension may keep its nominal value ([`NOMINAL`]).
    pub leaves_nominal: bool,
    pub max_dimensions: usize,
    /// Why a different number of samples changes every row, and the remedy.
    pub depends_on_samples: Option<[&'static str; 2]>,
    /// Why parameters cannot be correlated, and the remedy.
    pub excludes_correlation: Option<[&'static str; 2]>,
}

impl Facts {
    /// A design for any number of dimensions and samples, correlated or not.
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

pub trait Options: Clone + Debug + PartialEq {
    fn read(written: &Written) -> Self;

    fn written(&self) -> Written;

    /// Number of independently scrambled designs.
    fn replicates(&self) -> u64 {
        1
    }

    /// Checks the options against the number of dimensions and the number of samples in the file.
    ///
    /// # Errors
    /// The key that does not fit.
    fn check(&self, _dimensions: usize, _samples: Option<u64>) -> Result<(), DispersionError> {
        Ok(())
    }

    /// The columns of a data file whose rows are the samples.
    fn columns(&self) -> &[DataColumn] {
        &[]
    }
}

impl Options for () {
    fn read(_written: &Written) -> Self {}

    fn written(&self) -> Written {
        Written::default()
    }
}

pub trait Kind: PointSource + Sized {
    const FACTS: Facts;
    type Options: Options;

    /// Number of points in so many random dimensions.
    fn size(_options: &Self::Options, _dimensions: usize) -> Size {
        Size::Any
    }

    /// Checks the number of samples in the file against the dimensions.
    ///
    /// # Errors
    /// Where the design has no such number of samples.
    fn check(_dimensions: Dimensions<'_>, _samples: Option<u64>) -> Result<(), DispersionError> {
        Ok(())
    }

    fn points(options: &Self::Options, dimensions: Dimensions<'_>) -> Self;
}

/// The points of a design, for one worker. State only makes neighbours cheap.
pub trait PointSource: Debug {
    /// Writes u of the samples of `block`, dimension by dimension, or [`NOMINAL`]. The values of sample 0 are
    /// arbitrary.
    fn fill(&mut self, block: u64, u: &mut [[f64; BLOCK]]);
}

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
