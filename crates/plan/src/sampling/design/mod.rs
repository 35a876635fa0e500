//! [`Design`]: the samples in the unit cube; [`PointSource`]: u in (0, 1) of each sample and random dimension. A new
//! design needs its file and a row of the list below.
//!
//! Sample 0 is the nominal scene, sample k >= 1 is point k - 1. Numbers follow from the sample's id alone, without
//! stored permutations or earlier points.
//!
//! | design | file | earlier rows stay when samples are added | draws stay when a dispersion is added or moved |
//! | --- | --- | --- | --- |
//! | random | [`random`] | yes | yes |
//! | Latin hypercube | [`latin`] | no: the strata are 1/(samples - 1) wide | yes |
//! | Sobol | [`sobol`] | yes | unless it comes earlier in the file |
//! | Halton | [`halton`] | yes | unless it comes earlier in the file |
//! | grid, one at a time | [`grid`], [`one_at_a_time`] | size fixed by the design | no |
//! | Saltelli | [`saltelli`] | yes, by whole blocks | no |
//! | table | [`table`] | size fixed by the table | yes |
//!
//! Latin hypercube, Sobol and Halton designs may consist of independently scrambled [`replicates`].
//!
//! Dimensions are known by the name of the component, or of the parameter with a number. Blocks of eight samples
//! ([`BLOCK`]) match a block of ChaCha and a call of the quantiles.

pub mod grid;
pub mod halton;
pub mod hash;
pub mod latin;
pub mod levels;
pub mod one_at_a_time;
mod prelude;
pub mod random;
pub mod replicates;
pub mod saltelli;
pub mod sobol;
pub mod table;
pub mod traits;

pub use traits::{BLOCK, Dimensions, Facts, Kind, MAX_SAMPLES, NOMINAL, PointSource, Size};

use self::grid::Grid;
use self::halton::Halton;
use self::latin::LatinHypercube;
use self::one_at_a_time::OneAtATime;
use self::random::Random;
use self::replicates::Replicated;
use self::saltelli::Saltelli;
use self::sobol::Sobol;
use self::table::TableRows;
use crate::sampling::error::Result;
use crate::sampling::keys::{Row, Rule, Written};
use crate::sampling::stream::SampleId;

/// Declares the enumeration of all designs and the calls that each passes on to its kind.
macro_rules! designs {
    ($($Name:ident = $Kind:ty),* $(,)?) => {
        /// A design, with its keys.
        #[derive(Clone, Debug, PartialEq)]
        pub enum Design {
            $(
                #[doc = concat!("See [`", stringify!($Kind), "`].")]
                $Name(Written),
            )*
        }

        impl Design {
            /// The names in campaign files.
            pub const NAMES: &'static [&'static str] = &[$(<$Kind as Kind>::FACTS.name),*];

            /// The keys and the rules of the design called `name`.
            pub fn keys_of(name: &str) -> Option<(&'static [Row], &'static [Rule])> {
                let facts = [$(<$Kind as Kind>::FACTS),*].into_iter().find(|facts| facts.name == name)?;
                Some((facts.keys, facts.rules))
            }

            pub fn of(name: &str, written: Written) -> Option<Self> {
                let all: &[fn(Written) -> Self] = &[$(Self::$Name),*];
                Self::NAMES.iter().position(|known| *known == name).map(|place| all[place](written))
            }

            pub fn facts(&self) -> Facts {
                match self { $( Self::$Name(_) => <$Kind as Kind>::FACTS, )* }
            }

            /// Its keys as in canonical text.
            pub fn written(&self) -> &Written {
                match self { $( Self::$Name(written) )|* => written }
            }

            /// See [`Kind::size`].
            pub fn size(&self, dimensions: usize) -> Size {
                match self { $( Self::$Name(written) => <$Kind as Kind>::size(written, dimensions), )* }
            }

            /// Checks its keys against dimensions and samples of the file.
            ///
            /// # Errors
            /// The key that does not fit, or an impossible number of samples.
            pub fn check(&self, dimensions: Dimensions<'_>, samples: Option<u64>) -> Result<()> {
                levels::check(self.written(), dimensions)?;
                replicates::check(self.written(), samples)?;
                match self { $( Self::$Name(_) => <$Kind as Kind>::check(dimensions, samples), )* }
            }

            /// Its points, for one worker.
            pub fn points(&self, dimensions: Dimensions<'_>) -> Box<dyn PointSource> {
                match self { $( Self::$Name(written) => Box::new(<$Kind as Kind>::points(written, dimensions)), )* }
            }
        }
    };
}

designs! {
    Random = Random,
    LatinHypercube = LatinHypercube,
    Sobol = Replicated<Sobol>,
    Halton = Replicated<Halton>,
    Grid = Grid,
    OneAtATime = OneAtATime,
    Saltelli = Saltelli,
    Table = TableRows,
}

impl Design {
    /// The design of a file without `[design]`.
    pub const DEFAULT: Design = Design::Random(Written::NONE);

    pub fn name(&self) -> &'static str {
        self.facts().name
    }

    /// True if the number of samples follows from the design.
    pub fn has_size(&self) -> bool {
        self.size(0) != Size::Any
    }

    pub fn names_with(key: &str) -> Vec<&'static str> {
        let has = |name: &&str| Self::keys_of(name).is_some_and(|(keys, _)| keys.iter().any(|row| row.key == key));
        Self::NAMES.iter().copied().filter(has).collect()
    }

    /// Number of independently scrambled designs.
    pub fn replicates(&self) -> u64 {
        replicates::count(self.written())
    }

    /// True if the first samples represent the population as well as all samples do.
    pub fn begins_as_it_goes_on(&self) -> bool {
        match self {
            Design::Random(_) | Design::LatinHypercube(_) | Design::Sobol(_) | Design::Halton(_) => true,
            Design::Grid(_) | Design::OneAtATime(_) | Design::Saltelli(_) | Design::Table(_) => false,
        }
    }

    /// Three of the `dimensions` whose effects no test separates in `points` points ([`sobol::bound`],
    /// [`halton::bound`]).
    pub fn bound(&self, dimensions: usize, points: u64) -> Option<[usize; 3]> {
        let points = points / self.replicates();
        match self {
            Design::Sobol(_) => sobol::bound(dimensions, points),
            Design::Halton(_) => halton::bound(dimensions, points),
            _ => None,
        }
    }

    /// The replicate of `sample`, from zero ([`replicates`]); `None` for the nominal sample.
    pub fn replicate_of(&self, sample: SampleId) -> Option<u64> {
        sample.0.checked_sub(1).map(|point| point % self.replicates())
    }
}

impl Default for Design {
    fn default() -> Self {
        Self::DEFAULT
    }
}
