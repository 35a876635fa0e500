//! [`Transform`]: from numbers u in (0, 1) to values; [`Assigned`]: which u it takes, and which columns it writes.

use super::distribution::{Distribution, Joint, Map, NumberWords, Quantile};

/// A distribution with the numbers u that it takes, and the columns that it writes.
#[derive(Clone, Debug, PartialEq)]
pub struct Assigned {
    /// The index of the `[[disperse]]` table that it is from.
    pub table: usize,
    /// Its first dimension; it takes as many as its distribution needs, one after the other.
    pub first: usize,
    /// The columns that it writes, in the order of the distribution's values.
    pub columns: Vec<usize>,
    pub map: Transform,
}

/// From numbers u in (0, 1) to values.
#[derive(Clone, Debug, PartialEq)]
pub enum Transform {
    /// One u, one value.
    Scalar(Distribution),
    Joint(Joint),
}

impl Transform {
    /// Number of u that it takes.
    pub fn dimensions(&self) -> usize {
        match self {
            Transform::Scalar(distribution) => distribution.dimensions(),
            Transform::Joint(joint) => joint.dimensions(),
        }
    }

    /// In words; `words` writes its numbers.
    pub fn text(&self, words: NumberWords<'_>) -> String {
        match self {
            Transform::Scalar(distribution) => distribution.text(words),
            Transform::Joint(joint) => joint.text(words),
        }
    }
}
