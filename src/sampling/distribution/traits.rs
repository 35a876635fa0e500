//! What every distribution implements.

use super::target::{JointTarget, Target};
use crate::sampling::error::DispersionError;
use crate::sampling::keys::{Row, Rule, Value, Written};
use std::fmt::Debug;

/// How a distribution in words writes its numbers.
#[derive(Clone, Copy)]
pub struct NumberWords<'a> {
    /// Those in the unit of the parameter.
    pub amount: &'a dyn Fn(f64) -> String,
    /// Angles, rad, whatever the unit of the parameter.
    pub angle: &'a dyn Fn(f64) -> String,
    /// Those of a unit of their own, or of none: shapes, components of a direction.
    pub number: &'a dyn Fn(f64) -> String,
}

/// A distribution of one number; of a parameter with components, each has it.
pub trait Scalar {
    /// The name in campaign files.
    const NAME: &'static str;
    const KEYS: &'static [Row];
    /// What its keys have to do with each other.
    const RULES: &'static [Rule] = &[];
    type Quantile: Quantile;

    /// The quantile function of each component.
    ///
    /// # Errors
    /// What about its numbers does not fit the target.
    fn quantiles(target: &Target<'_>) -> Result<Vec<Self::Quantile>, DispersionError>;
}

/// For [`Quantile::of_scores`] of a distribution whose value is the function `of` of the normal score: the value of
/// each.
#[inline]
pub fn each_score(z: &[f64; 8], values: &mut [f64; 8], of: impl Fn(f64) -> f64) -> bool {
    for (value, z) in values.iter_mut().zip(z) {
        *value = of(*z);
    }
    true
}

pub trait Quantile: Clone + Debug + PartialEq {
    /// The value below which the fraction `u` of the distribution lies, 0 < u < 1.
    fn quantile(&self, u: f64) -> f64;

    /// [`Quantile::quantile`] of eight numbers, with the same bits.
    #[inline]
    fn quantiles(&self, u: &[f64; 8], values: &mut [f64; 8]) {
        for (value, u) in values.iter_mut().zip(u) {
            *value = self.quantile(*u);
        }
    }

    /// The values of eight normal scores z, that is the quantiles of Phi(z), where the value is a function of z itself;
    /// false, and nothing done, elsewhere. A score says more than its u in the upper tail.
    #[inline]
    fn of_scores(&self, _z: &[f64; 8], _values: &mut [f64; 8]) -> bool {
        false
    }

    /// Number of u that it takes: 0 where the value is always the same.
    #[inline]
    fn dimensions(&self) -> usize {
        1
    }

    /// The standard deviation, of a normal distribution.
    fn normal_std(&self) -> Option<f64> {
        None
    }

    /// Of a discrete distribution, the probability of each value or a smaller one, ascending; the last is 1 to
    /// rounding.
    fn steps(&self) -> Option<Vec<f64>> {
        None
    }

    /// In words; `words` writes its numbers.
    fn text(&self, words: NumberWords<'_>) -> String;
}

/// A distribution of all components of a vector or an attitude together, or of the numbers that a file of its own
/// names.
pub trait Together {
    /// The name in campaign files.
    const NAME: &'static str;
    const KEYS: &'static [Row];
    /// What its keys have to do with each other.
    const RULES: &'static [Rule] = &[];
    type Map: Map;

    /// The map to be drawn.
    ///
    /// # Errors
    /// What is wrong with target or numbers.
    fn map(target: &JointTarget<'_>) -> Result<Self::Map, DispersionError>;
}

/// A map from several u in (0, 1) to the values of several components.
pub trait Map: Clone + Debug + PartialEq {
    /// Number of u that a draw takes, at most [`MAX_DIMENSIONS`].
    fn dimensions(&self) -> usize;

    /// What a dimension is called after the name of what is drawn.
    fn dimension_name(&self, dimension: usize) -> String {
        (dimension + 1).to_string()
    }

    /// Number of values that a draw gives.
    fn components(&self) -> usize;

    /// The values for `u` ([`Map::dimensions`] numbers), into the first [`Map::components`] of `values`.
    fn values(&self, u: &[f64], values: &mut [f64]);

    /// In words; `words` writes its numbers.
    fn text(&self, words: NumberWords<'_>) -> String;
}

/// Largest number of u of one distribution.
pub const MAX_DIMENSIONS: usize = 8;

/// The distributions of one number that others have within them: of a magnitude, of an angle. The list of distributions
/// is one.
pub trait Nested {
    type Quantile: Quantile;

    /// The quantile function about `nominal` of the distribution with this name and these keys, which the table `key`
    /// has.
    ///
    /// # Errors
    /// That it is not a distribution of one number, or what about its numbers does not fit.
    fn quantile(
        index: usize,
        key: &'static str,
        nominal: f64,
        distribution: (&str, &Written),
    ) -> Result<Self::Quantile, DispersionError>;
}

/// The distribution in the table `key` of a distribution of several numbers, about `nominal`.
pub(super) fn nested<N: Nested>(
    target: &JointTarget<'_>,
    key: &'static str,
    nominal: f64,
) -> Result<N::Quantile, DispersionError> {
    match target.written.get(key) {
        Some(Value::Distribution(name, written)) => N::quantile(target.index, key, nominal, (name, written)),
        _ => target.lacks(key, "given", "write a distribution of one number"),
    }
}
