//! [`Levels`]: the levels of a grid and of a design of one at a time.
//!
//! A level is a u: with n levels the middles of n equally likely intervals, (i + 1/2)/n, or the quantiles that the file
//! lists. Levels are computed where they are needed, not stored: a file may ask for any number of them.

use crate::sampling::error::{DispersionError, Table, error_of};
use crate::sampling::keys::{ALL_BUT_ONE, Counts, Kind, Row, Rule, Value, Values, Written};

use super::traits::MAX_SAMPLES;

pub const LEVELS: [Row; 2] = [
    Row::new(
        "levels",
        Kind::Counts(MAX_SAMPLES),
        "Number of levels in each dimension, or a list of numbers in the order of the file",
    ),
    Row::new("quantiles", Kind::List, "The levels of each dimension as quantiles").within(
        "numbers between 0 and 1, neither included",
        "write them like [0.05, 0.5, 0.95]",
        |u| u > 0.0 && u < 1.0,
    ),
];

/// One of them is written.
pub const ONE_OF_LEVELS: Rule = Rule::One(&[&["levels"], &["quantiles"]], "5", ALL_BUT_ONE);

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

    /// The levels that a file says.
    pub(super) fn of(written: &Written) -> Self {
        match written.get("levels") {
            Some(Value::Counts(counts)) => Levels::Counts(counts.clone()),
            _ => Levels::Quantiles(written.numbers("quantiles").unwrap_or_default().to_vec()),
        }
    }

    /// What a file says of them.
    pub(super) fn written(&self) -> Written {
        let (key, value) = match self {
            Levels::Counts(counts) => ("levels", Value::Counts(counts.clone())),
            Levels::Quantiles(list) => ("quantiles", Value::Numbers(Values::Each(list.clone()))),
        };
        Written::default().with(key, value)
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
