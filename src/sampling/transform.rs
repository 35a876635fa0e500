//! [`Transform`]: from u in (0, 1) to values; [`Assigned`]: the u that it takes and the columns that it writes.

use super::distribution::{Distribution, Joint, Map, NumberWords, Quantile};

/// A distribution with the u that it takes and the columns that it writes.
#[derive(Clone, Debug, PartialEq)]
pub struct Assigned {
    pub table: usize,
    /// Its first dimension; further ones follow.
    pub first: usize,
    /// Its columns, in the order of the distribution's values.
    pub columns: Vec<usize>,
    pub map: Transform,
}

#[derive(Clone, Debug, PartialEq)]
pub enum Transform {
    Scalar(Distribution),
    Joint(Joint),
}

impl Transform {
    pub fn dimensions(&self) -> usize {
        match self {
            Transform::Scalar(distribution) => distribution.dimensions(),
            Transform::Joint(joint) => joint.dimensions(),
        }
    }

    pub fn text(&self, words: NumberWords<'_>) -> String {
        match self {
            Transform::Scalar(distribution) => distribution.text(words),
            Transform::Joint(joint) => joint.text(words),
        }
    }
}
