//! [`Levels`]: the levels of a grid and of a design of one at a time.
//!
//! A level is a u: with n levels the middles of n equally likely intervals, (i + 1/2)/n, or the quantiles that the file lists.
//! Levels are computed where they are needed, not stored: a file may ask for any number of them.

use crate::sampling::error::{DispersionError, Table, error_of};
use crate::sampling::keys::{Counts, KeyReader, KeyWriter};

/// The levels of each dimension, as written.
#[derive(Clone, Debug, PartialEq)]
pub enum Levels {
    /// So many in each (`levels = 5`, or `levels = [5, 3]` in the order of the file).
    Counts(Counts),
    /// These quantiles of each (`quantiles = [0.05, 0.5, 0.95]`).
    Quantiles(Vec<f64>),
}

impl Levels {
    /// Number of levels of a dimension; one, the median, where the list is too short.
    pub fn count(&self, dimension: usize) -> u64 {
        match self {
            Levels::Counts(Counts::All(count)) => *count,
            Levels::Counts(Counts::Each(counts)) => counts.get(dimension).copied().unwrap_or(1),
            Levels::Quantiles(list) => list.len() as u64,
        }
    }

    /// Level `index` of a dimension, below [`Levels::count`].
    pub fn level(&self, dimension: usize, index: u64) -> f64 {
        match self {
            Levels::Quantiles(list) => list[index as usize],
            _ => (index as f64 + 0.5) / self.count(dimension) as f64,
        }
    }

    /// Reads `levels` or `quantiles`; `None` where something is wrong, which is then noted.
    pub(super) fn read(keys: &mut dyn KeyReader) -> Option<Self> {
        let (has_levels, has_quantiles) = (keys.has("levels"), keys.has("quantiles"));
        if has_levels && has_quantiles {
            keys.refuse("quantiles", "the only one of levels, quantiles", "delete one of them");
        }
        if !has_levels && !has_quantiles {
            keys.require("levels", "given (levels or quantiles)", "5");
        }
        let levels = keys.counts("levels");
        let quantiles = keys.numbers("quantiles");
        if let Some(list) = &quantiles
            && (list.is_empty() || list.iter().any(|u| *u <= 0.0 || *u >= 1.0))
        {
            let remedy = "write them like [0.05, 0.5, 0.95]";
            keys.refuse("quantiles", "numbers between 0 and 1, neither included", remedy);
            return None;
        }
        match (has_levels, has_quantiles) {
            (true, false) => levels.map(Levels::Counts),
            (false, true) => quantiles.map(Levels::Quantiles),
            _ => None,
        }
    }

    /// Writes them.
    pub(super) fn write(&self, keys: &mut dyn KeyWriter) {
        match self {
            Levels::Counts(Counts::All(count)) => keys.key("levels", count),
            Levels::Counts(Counts::Each(counts)) => keys.key("levels", counts),
            Levels::Quantiles(list) => keys.key("quantiles", list),
        }
    }

    /// That there is one number of levels for each dimension, where they are listed.
    pub(super) fn check(&self, dimensions: usize) -> Result<(), DispersionError> {
        if let Levels::Counts(Counts::Each(list)) = self
            && list.len() != dimensions
        {
            let allowed = format!("one number, or {dimensions} in an array, as many as random dimensions");
            let remedy = "write them in the order of the file's [[disperse]] tables";
            return Err(error_of(Table::Design, "levels", format!("{list:?}"), allowed, remedy));
        }
        Ok(())
    }
}
