//! [`Replicates`]: several designs of one kind in place of one, each scrambled on its own.
//!
//! Points of one scrambled net or hypercube depend on each other, so that intervals for independent runs do not hold. Means over
//! replicates that are scrambled independently are independent and alike: from their spread follows an interval (A. B. Owen,
//! *Scrambled net variance for integrals of smooth functions*, Ann. Statist. 25 (1997) 1541, section 1; *Monte Carlo theory, methods and
//! examples*, chapter 17.4).
//!
//! Sample k >= 1 is point (k - 1) / R of replicate (k - 1) mod R: with every R samples more each replicate has one more.

use crate::sampling::error::{DispersionError, Table, error_of};
use crate::sampling::keys::{KeyReader, KeyWriter};

use super::traits::{BLOCK, MAX_SAMPLES, by_point};

/// The key of the number of replicates.
pub const KEY: &str = "replicates";

/// Most replicates: each has its own scrambling in memory, and more than some dozens narrow no interval.
const MOST: u64 = 1024;

/// The number of replicates, at least 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Replicates(u64);

impl Replicates {
    /// The design itself.
    pub const ONE: Replicates = Replicates(1);

    /// So many, from 1 to 1024; `None` for other numbers.
    pub fn of(count: u64) -> Option<Self> {
        (1..=MOST).contains(&count).then_some(Replicates(count))
    }

    /// The number that the key gives, one without it; `None` where it is wrong, which is then noted.
    pub fn read(keys: &mut dyn KeyReader) -> Option<Self> {
        if !keys.has(KEY) {
            return Some(Replicates::ONE);
        }
        keys.count(KEY, MOST).map(Replicates)
    }

    /// Writes the key, where there are several.
    pub fn write(self, keys: &mut dyn KeyWriter) {
        if self.0 > 1 {
            keys.key(KEY, &self.0);
        }
    }

    /// How many there are.
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

    /// What scrambles the dimensions `names` in each replicate: their names, with the number of the replicate where there are
    /// several.
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
