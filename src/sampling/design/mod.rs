//! [`Design`]: how samples are laid out in the unit cube; [`Points`]: for each sample and each random dimension one number u in
//! (0, 1), which laws map to values.
//!
//! Sample 0 is the nominal scene in every design; sample k >= 1 is point k - 1 of the design. Each number is found from the
//! sample's id alone: no permutation and no earlier point is stored.
//!
//! | design | file | earlier rows stay when samples are added | draws stay when a dispersion is added or moved |
//! | --- | --- | --- | --- |
//! | random | here | yes | yes |
//! | Latin hypercube | [`latin`] | no: the strata are 1/(samples - 1) wide | yes |
//! | Sobol | [`sobol`] | yes | while those before it in the file stay |
//! | Halton | [`halton`] | yes | while those before it in the file stay |
//! | grid, one at a time | [`levels`] | they have a size of their own | no |
//! | Saltelli | [`saltelli`] | yes, by whole blocks | no |
//! | table | rows of a file, see [`super::dispersions`] | they have a size of their own | yes |
//!
//! Dimensions are known by name (the component's, or the parameter's and a number for a law of several components). Samples
//! come in blocks of eight consecutive ones, [`BLOCK`], because that is what a block of ChaCha holds and what the quantiles
//! take at a time; a number never depends on what was asked before.

pub mod halton;
pub mod hash;
pub mod latin;
pub mod levels;
pub mod saltelli;
pub mod sobol;

use super::law::DataColumn;
use super::stream::Stream;
use halton::Halton;
use latin::LatinHypercube;
use levels::{Factorial, Levels, OneAtATime};
use saltelli::Saltelli;
use sobol::Sobol;

/// Samples of a block: block b holds the samples 8 b ... 8 b + 7.
pub const BLOCK: usize = 8;

/// In place of u where a dimension keeps its nominal value.
pub const NOMINAL: f64 = f64::NAN;

/// A design as written.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Design {
    /// Independent uniform numbers.
    #[default]
    Random,
    /// One sample in each of n equal strata of each dimension.
    LatinHypercube,
    /// Sobol's sequence, scrambled.
    Sobol,
    /// Halton's sequence, scrambled.
    Halton,
    /// All combinations of levels.
    Grid(Levels),
    /// One parameter after the other through its levels, the others nominal.
    OneAtATime(Levels),
    /// Blocks for sensitivity indices.
    Saltelli,
    /// The rows of a file, for the parameters that are its columns; others are drawn as by the random design.
    Table(Vec<DataColumn>),
}

/// The names of the designs.
pub const DESIGNS: [&str; 8] =
    ["random", "latin_hypercube", "sobol", "halton", "grid", "one_at_a_time", "saltelli", "table"];

impl Design {
    /// The name in campaign files.
    pub const fn name(&self) -> &'static str {
        match self {
            Design::Random => DESIGNS[0],
            Design::LatinHypercube => DESIGNS[1],
            Design::Sobol => DESIGNS[2],
            Design::Halton => DESIGNS[3],
            Design::Grid(_) => DESIGNS[4],
            Design::OneAtATime(_) => DESIGNS[5],
            Design::Saltelli => DESIGNS[6],
            Design::Table(_) => DESIGNS[7],
        }
    }

    /// Number of points, for a design that has one of its own: `dimensions` random dimensions in all. `None` too where it is
    /// more than can be numbered.
    pub fn points(&self, dimensions: usize) -> Option<u64> {
        match self {
            Design::Grid(levels) => {
                levels.of(dimensions).iter().try_fold(1u64, |product, level| product.checked_mul(level.len() as u64))
            }
            Design::OneAtATime(levels) => Some(levels.of(dimensions).iter().map(|level| level.len() as u64).sum()),
            Design::Table(columns) => columns.first().map(|column| column.values.len() as u64),
            _ => None,
        }
    }

    /// Most random dimensions that the design has numbers for.
    pub fn most_dimensions(&self) -> usize {
        match self {
            Design::Sobol | Design::Halton => sobol::MOST_DIMENSIONS,
            Design::Saltelli => sobol::MOST_DIMENSIONS / 2,
            _ => usize::MAX,
        }
    }
}

/// The points of a design, for one worker. What it keeps only makes neighbours cheap.
#[derive(Debug)]
pub enum Points {
    /// Independent uniform numbers, one stream each dimension.
    Random(Vec<Stream>),
    /// See [`latin`].
    Latin(LatinHypercube),
    /// See [`sobol`].
    Sobol(Sobol),
    /// See [`halton`].
    Halton(Halton),
    /// See [`levels`].
    Grid(Factorial),
    /// See [`levels`].
    OneAtATime(OneAtATime),
    /// See [`saltelli`].
    Saltelli(Saltelli),
}

impl Points {
    /// The points of `design` with `samples` samples, sample 0 included, for the dimensions `names`; `factors` says to which
    /// law each dimension belongs.
    pub fn new(design: &Design, seed: u64, samples: u64, names: &[String], factors: &[usize]) -> Self {
        match design {
            Design::Random | Design::Table(_) => Points::Random(streams(seed, names)),
            Design::LatinHypercube => Points::Latin(LatinHypercube::new(seed, samples, names)),
            Design::Sobol => Points::Sobol(Sobol::new(seed, names)),
            Design::Halton => Points::Halton(Halton::new(seed, names)),
            Design::Grid(levels) => Points::Grid(Factorial::new(levels.of(names.len()))),
            Design::OneAtATime(levels) => Points::OneAtATime(OneAtATime::new(levels.of(names.len()))),
            Design::Saltelli => Points::Saltelli(Saltelli::new(seed, names, factors)),
        }
    }

    /// The numbers of the samples of `block`, dimension by dimension; [`NOMINAL`] where a dimension keeps its nominal value.
    /// What stands for sample 0 means nothing.
    pub fn fill(&mut self, block: u64, u: &mut [[f64; BLOCK]]) {
        match self {
            Points::Random(streams) => {
                for (stream, u) in streams.iter_mut().zip(u) {
                    stream.uniforms(block, u);
                }
            }
            Points::Latin(points) => points.fill(block, u),
            Points::Sobol(points) => by_point(block, u, |dimension, point| points.number(dimension, point)),
            Points::Halton(points) => by_point(block, u, |dimension, point| points.number(dimension, point)),
            Points::Grid(points) => by_point(block, u, |dimension, point| points.number(dimension, point)),
            Points::OneAtATime(points) => by_point(block, u, |dimension, point| points.number(dimension, point)),
            Points::Saltelli(points) => by_point(block, u, |dimension, point| points.number(dimension, point)),
        }
    }
}

/// One stream for each dimension.
fn streams(seed: u64, names: &[String]) -> Vec<Stream> {
    names.iter().map(|name| Stream::new(seed, name)).collect()
}

/// Fills a block from a function of dimension and point.
fn by_point(block: u64, u: &mut [[f64; BLOCK]], number: impl Fn(usize, u64) -> f64) {
    for (dimension, u) in u.iter_mut().enumerate() {
        for (lane, u) in u.iter_mut().enumerate() {
            let sample = block * BLOCK as u64 + lane as u64;
            *u = number(dimension, sample.saturating_sub(1));
        }
    }
}
