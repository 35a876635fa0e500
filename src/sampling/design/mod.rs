//! [`Design`]: where the samples are in the unit cube; [`Points`]: for each sample and each random dimension one number
//! u in (0, 1), which distributions map to values. To add a design, write its file and add it to the list below.
//!
//! Sample 0 is the nominal scene in every design; sample k >= 1 is point k - 1 of the design. Each number is found from
//! the sample's id alone: no permutation and no earlier point is stored.
//!
//! | design | file | earlier rows stay when samples are added | draws stay when a dispersion is added or moved |
//! | --- | --- | --- | --- |
//! | random | [`random`] | yes | yes |
//! | Latin hypercube | [`latin`] | no: the strata are 1/(samples - 1) wide | yes |
//! | Sobol | [`sobol`] | yes | while those before it in the file stay |
//! | Halton | [`halton`] | yes | while those before it in the file stay |
//! | grid, one at a time | [`grid`], [`one_at_a_time`] | they have a size of their own | no |
//! | Saltelli | [`saltelli`] | yes, by whole blocks | no |
//! | table | [`table`] | they have a size of their own | yes |
//!
//! Latin hypercube, Sobol and Halton may be several designs of their kind, each scrambled on its own: [`replicates`].
//!
//! Dimensions are known by name (the component's, or the parameter's and a number for a distribution of several
//! components). Samples come in blocks of eight consecutive ones, [`BLOCK`], the size of a block of ChaCha and of a
//! call of the quantiles; a number never depends on what was asked before.

mod enumerations;
pub mod grid;
pub mod halton;
pub mod hash;
pub mod latin;
pub mod levels;
pub mod one_at_a_time;
pub mod random;
pub mod replicates;
pub mod saltelli;
pub mod sobol;
pub mod table;
pub mod traits;

pub use traits::{BLOCK, Dimensions, Kind, MAX_SAMPLES, NOMINAL, PointSource, Size};

use self::grid::GridDesign;
use self::halton::HaltonDesign;
use self::latin::LatinHypercubeDesign;
use self::one_at_a_time::OneAtATimeDesign;
use self::random::RandomDesign;
use self::saltelli::SaltelliDesign;
use self::sobol::SobolDesign;
use self::table::TableDesign;
use crate::sampling::error::DispersionError;
use crate::sampling::keys::{DataColumn, Row, Rule, Written};
use crate::sampling::stream::SampleId;

enumerations::designs! {
    Random = RandomDesign,
    LatinHypercube = LatinHypercubeDesign,
    Sobol = SobolDesign,
    Halton = HaltonDesign,
    Grid = GridDesign,
    OneAtATime = OneAtATimeDesign,
    Saltelli = SaltelliDesign,
    Table = TableDesign,
}

impl Design {
    /// The design of a file that does not say.
    pub const DEFAULT: Design = Design::Random(RandomDesign);

    /// The names of the designs that have the key `key`.
    pub fn names_with(key: &str) -> Vec<&'static str> {
        let has = |name: &&str| Self::keys_of(name).is_some_and(|(keys, _)| keys.iter().any(|row| row.key == key));
        Self::NAMES.iter().copied().filter(has).collect()
    }

    /// Whether the first samples represent the population as all do: those of a grid or of a list are others than the
    /// last.
    pub fn begins_as_it_goes_on(&self) -> bool {
        match self {
            Design::Random(_) | Design::LatinHypercube(_) | Design::Sobol(_) | Design::Halton(_) => true,
            Design::Grid(_) | Design::OneAtATime(_) | Design::Saltelli(_) | Design::Table(_) => false,
        }
    }

    /// Three of so many `dimensions` whose effects no test tells apart in `points` points ([`sobol::bound`],
    /// [`halton::bound`]), where there are such.
    pub fn bound(&self, dimensions: usize, points: u64) -> Option<[usize; 3]> {
        let points = points / self.replicates();
        match self {
            Design::Sobol(_) => sobol::bound(dimensions, points),
            Design::Halton(_) => halton::bound(dimensions, points),
            _ => None,
        }
    }

    /// The replicate in which `sample` is, from zero ([`replicates`]); `None` for the nominal sample, which is in none.
    pub fn replicate_of(&self, sample: SampleId) -> Option<u64> {
        sample.0.checked_sub(1).map(|point| point % self.replicates())
    }
}

impl Default for Design {
    fn default() -> Self {
        Self::DEFAULT
    }
}
