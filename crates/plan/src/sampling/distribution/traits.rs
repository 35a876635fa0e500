//! The traits of distributions.

use super::target::Target;
use crate::math::normal::{quantile, quantiles};
use crate::sampling::error::Result;
use crate::sampling::keys::{Row, Rule};
use std::fmt::Debug;
use std::ops::Deref;

/// Formats of the numbers in a distribution's description.
#[derive(Clone, Copy)]
pub struct NumberWords<'a> {
    pub amount: &'a dyn Fn(f64) -> String,
    /// Angles, rad.
    pub angle: &'a dyn Fn(f64) -> String,
    /// Pure numbers.
    pub number: &'a dyn Fn(f64) -> String,
}

/// A distribution of one number for each component.
pub trait Scalar {
    const NAME: &'static str;
    const KEYS: &'static [Row];
    const RULES: &'static [Rule] = &[];
    type Quantile: Quantile;

    /// The distribution of each component.
    ///
    /// # Errors
    /// Numbers that do not fit the target.
    fn of(target: &Target<'_>) -> Result<Vec<Self::Quantile>>;
}

/// A quantile function: either [`Quantile::quantile`] or [`Quantile::at_score`] is its own.
pub trait Quantile: Debug {
    /// The value at the probability `u`, 0 < u < 1.
    fn quantile(&self, u: f64) -> f64 {
        self.at_score(quantile(u)).unwrap_or(f64::NAN)
    }

    /// The value at the normal score `z`, the quantile of Phi(z); `None` if it is no function of the score. In the
    /// upper tail a score has more digits than its u.
    #[inline]
    fn at_score(&self, _z: f64) -> Option<f64> {
        None
    }

    /// [`Quantile::quantile`] of eight numbers, with the same bits.
    #[inline]
    fn quantiles(&self, u: &[f64; 8], values: &mut [f64; 8]) {
        let mut z = [0.0; 8];
        if self.at_score(0.0).is_some() {
            quantiles(u, &mut z);
            self.of_scores(&z, values);
            return;
        }
        for (value, u) in values.iter_mut().zip(u) {
            *value = self.quantile(*u);
        }
    }

    /// [`Quantile::at_score`] of eight numbers; false, with `values` unchanged, if it is no function of the score.
    #[inline]
    fn of_scores(&self, z: &[f64; 8], values: &mut [f64; 8]) -> bool {
        for (value, z) in values.iter_mut().zip(z) {
            let Some(at_score) = self.at_score(*z) else { return false };
            *value = at_score;
        }
        true
    }

    /// 0 for a fixed value.
    #[inline]
    fn dimensions(&self) -> usize {
        1
    }

    /// If normal.
    fn normal_std(&self) -> Option<f64> {
        None
    }

    /// Cumulative probabilities of a discrete distribution, ascending, up to 1.
    fn steps(&self) -> Option<Vec<f64>> {
        None
    }

    fn text(&self, words: NumberWords<'_>) -> String;
}

/// A joint distribution of a vector, an attitude, or the parameters that a file names.
pub trait Together: Map + Sized {
    const NAME: &'static str;
    const KEYS: &'static [Row];
    const RULES: &'static [Rule] = &[];

    /// # Errors
    /// A target or numbers that do not fit.
    fn map(target: &Target<'_>) -> Result<Self>;
}

/// A map from several u in (0, 1) to the values of several components.
pub trait Map: Debug {
    /// At most [`MAX_DIMENSIONS`].
    fn dimensions(&self) -> usize;

    fn dimension_name(&self, dimension: usize) -> String {
        (dimension + 1).to_string()
    }

    /// Writes the values at `u`, one for each component.
    fn values(&self, u: &[f64], values: &mut [f64]);

    fn text(&self, words: NumberWords<'_>) -> String;
}

pub const MAX_DIMENSIONS: usize = 8;

/// The distribution of a magnitude or an angle in a table of a joint distribution.
pub trait Nested: Deref<Target = dyn Quantile> + Clone + Debug + PartialEq {
    /// The distribution about `nominal` in the table `key` of `target`.
    ///
    /// # Errors
    /// The distribution is not one of one number, or its numbers do not fit.
    fn nested(target: &Target<'_>, key: &'static str, nominal: f64) -> Result<Self>;
}
