//! [`Replicates`]: several designs of one kind in place of one, each scrambled on its own.
//!
//! Points of one scrambled net or hypercube depend on each other, so that intervals for independent runs do not hold.
//! Means over replicates that are scrambled independently are independent and alike: from their spread follows an
//! interval (A. B. Owen, *Scrambled net variance for integrals of smooth functions*, Ann. Statist. 25 (1997) 1541,
//! section 1; *Monte Carlo theory, methods and examples*, chapter 17.4).
//!
//! Sample k >= 1 is point (k - 1) / R of replicate (k - 1) mod R: with every R samples more each replicate has one
//! more.

use crate::sampling::error::{DispersionError, Table, error_of};
use crate::sampling::keys::{Kind, Row, Written};

use super::traits::{BLOCK, MAX_SAMPLES, by_point};

/// Most replicates: each has its own scrambling in memory, and more than some dozens narrow no interval.
const MOST: u64 = 1024;

/// The key of the number of replicates.
pub const REPLICATES: Row = Row::new(
    "replicates",
    Kind::Count([1, MOST]),
    "Number of designs of this kind, each scrambled independently; default: 1",
);

/// The number of replicates, at least 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Replicates(u64);

impl Replicates {
    pub const ONE: Replicates = Replicates(1);

    /// So many, from 1 to 1024; `None` for other numbers.
    pub fn of(count: u64) -> Option<Self> {
        (1..=MOST).contains(&count).then_some(Replicates(count))
    }

    /// The number that a file says, one where it says none.
    pub(super) fn of_written(written: &Written) -> Self {
        written.count(REPLICATES.key).map_or(Replicates::ONE, Replicates)
    }

    /// What a file says of it: nothing where there is one.
    pub(super) fn written(self) -> Written {
        match self.0 {
            1 => Written::default(),
            count => Written::default().with(REPLICATES.key, count),
        }
    }

    pub fn count(self) -> u64 {
        self.0
    }

    /// That all replicates have as many samples as each other.
    ///
    /// # Errors
    /// Where `samples`, sample 0 included, do not divide.
    pub(super) fn check(self, samples: Option<u64>) -> Result<(), DispersionError> {
        let Some(samples) = samples.filter(|samples| *samples > 1 && (samples - 1) % self.0 != 0) else {
            return Ok(());
        };
        let below = 1 + (samples - 1) / self.0 * self.0;
        let allowed = format!("1 and a multiple of {0}: the nominal scene and {0} replicates of the design", self.0);
        let above = Some(below + self.0).filter(|above| *above <= MAX_SAMPLES);
        let below = Some(below).filter(|below| *below > 1);
        let numbers: Vec<String> = below.into_iter().chain(above).map(|number| number.to_string()).collect();
        let remedy = format!("write {}, or other replicates in [design]", numbers.join(" or "));
        Err(error_of(Table::Campaign, "samples", samples.to_string(), allowed, remedy))
    }

    /// What scrambles the dimensions `names` in each replicate: their names, with the number of the replicate where
    /// there are several.
    pub(super) fn names(self, names: &[String]) -> Vec<Vec<String>> {
        match self.0 {
            1 => vec![names.to_vec()],
            count => (0..count)
                .map(|replicate| names.iter().map(|name| format!("{name} replicate {replicate}")).collect())
                .collect(),
        }
    }
}

/// Fills a block from one source of points for each replicate, and a function of source, dimension and point.
pub(super) fn by_replicate<S>(
    sources: &[S],
    block: u64,
    u: &mut [[f64; BLOCK]],
    number: impl Fn(&S, usize, u64) -> f64,
) {
    let count = sources.len() as u64;
    by_point(block, u, |dimension, point| number(&sources[(point % count) as usize], dimension, point / count));
}
