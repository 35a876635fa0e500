//! [`Levels`]: the levels of the designs `grid` and `one_at_a_time`.
//!
//! A level is a value of u: the midpoints of n equally likely intervals, (i + 1/2)/n, or the listed quantiles, computed
//! on demand.

use super::prelude::*;
use super::traits::MAX_SAMPLES;
use crate::sampling::error::{Table, error_of};
use crate::sampling::keys::{ALL_BUT_ONE, Kind, Value, Values, inside};

pub const LEVELS: [Row; 2] = [
    Row::new(
        "levels",
        Kind::Counts(MAX_SAMPLES),
        "Number of levels in each dimension, or a list of numbers in the order of the file",
    ),
    Row::new("quantiles", Kind::List, "The levels of each dimension as quantiles").within(
        "numbers between 0 and 1, neither included",
        "write them like [0.05, 0.5, 0.95]",
        inside(0.0, 1.0),
    ),
];

pub const ONE_OF_LEVELS: Rule = Rule::One(&[&["levels"], &["quantiles"]], "5", ALL_BUT_ONE);

/// The levels of each dimension, as written.
#[derive(Clone, Debug, PartialEq)]
pub enum Levels {
    /// Their number (`levels = 5`, or `levels = [5, 3]` in the order of the file).
    Counts(Values<u64>),
    /// Equal quantiles in each dimension (`quantiles = [0.05, 0.5, 0.95]`).
    Quantiles(Vec<f64>),
}

impl Levels {
    pub(super) fn of(written: &Written) -> Self {
        match written.get("levels") {
            Some(Value::Counts(counts)) => Levels::Counts(counts.clone()),
            _ => Levels::Quantiles(written.numbers("quantiles").unwrap_or_default().to_vec()),
        }
    }

    /// Number of levels of a dimension; one, the median, if the list is too short.
    pub fn count(&self, dimension: usize) -> u64 {
        match self {
            Levels::Counts(Values::One(count)) => *count,
            Levels::Counts(Values::Each(counts)) => counts.get(dimension).copied().unwrap_or(1),
            Levels::Counts(Values::Rows(_)) => 1,
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

    /// The running product or sum of the numbers of levels before each dimension.
    pub(super) fn running(&self, dimensions: usize, first: u64, next: fn(u64, u64) -> u64) -> Vec<u64> {
        let counts = (0..dimensions).map(|dimension| self.count(dimension));
        counts.scan(first, |sum, count| Some(std::mem::replace(sum, next(*sum, count)))).collect()
    }
}

/// A list has one number of levels for each dimension.
pub(super) fn check(written: &Written, dimensions: Dimensions<'_>) -> Result<()> {
    let dimensions = dimensions.names.len();
    match written.get("levels") {
        Some(Value::Counts(Values::Each(list))) if list.len() != dimensions => {
            let allowed = format!("one number, or {dimensions} in an array, as many as random dimensions");
            let remedy = "write them in the order of the file's [[disperse]] tables";
            Err(error_of(Table::Design, "levels", format!("{list:?}"), allowed, remedy))
        }
        _ => Ok(()),
    }
}
