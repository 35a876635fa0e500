//! [`Dispersion`]: what a campaign says about one parameter, as written, and [`DispersionError`]: what is wrong with it.
//!
//! A law of one number at a time becomes a [`super::Distribution`] in [`super::scalar`]; one of several numbers together
//! becomes a [`super::Joint`] in [`super::joint`].

use crate::scene::Parameter;

/// One number for all components, or one for each.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    /// The same for all.
    All(f64),
    /// One each, in the order of the components.
    Each(Vec<f64>),
}

/// The standard deviation of a normal law.
#[derive(Clone, Debug, PartialEq)]
pub enum Spread {
    /// In the parameter's unit (`std`).
    Absolute(Values),
    /// As a fraction of the nominal's absolute value (`relative_std`).
    Relative(Values),
}

/// Where a normal law is cut off.
#[derive(Clone, Debug, PartialEq)]
pub enum Cut {
    /// At so many standard deviations on both sides of the nominal (`sigmas`).
    Sigmas(Values),
    /// At bounds in the parameter's unit (`lower`, `upper`); at least one is given.
    Bounds {
        /// Lower bound.
        lower: Option<Values>,
        /// Upper bound.
        upper: Option<Values>,
    },
}

/// The interval of a uniform law.
#[derive(Clone, Debug, PartialEq)]
pub enum Range {
    /// Between two numbers in the parameter's unit (`min`, `max`).
    Between {
        /// Lower end.
        min: Values,
        /// Upper end.
        max: Values,
    },
    /// So far on both sides of the nominal, in the parameter's unit (`half_width`).
    Around(Values),
    /// So far on both sides, as a fraction of the nominal's absolute value (`relative_half_width`).
    AroundRelative(Values),
}

/// A law as written.
#[derive(Clone, Debug, PartialEq)]
pub enum Law {
    /// Normal about the nominal.
    Normal(Spread),
    /// Normal about the nominal, truncated.
    TruncatedNormal(Spread, Cut),
    /// Uniform.
    Uniform(Range),
    /// Attitude uniform over all rotations, of a quaternion as a whole.
    UniformAttitude,
}

/// What a campaign says about one parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Dispersion {
    /// The parameter.
    pub parameter: Parameter,
    /// The component that is meant, if not all are.
    pub component: Option<usize>,
    /// The law of its components: of each alone, or of all together.
    pub law: Law,
}

/// Why a dispersion cannot be drawn.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("disperse[{dispersion}].{key} = {value}: must be {allowed}; {remedy}")]
pub struct DispersionError {
    /// Which dispersion, counted from zero.
    pub dispersion: usize,
    /// Its key that is wrong: `parameter`, `std`, ...
    pub key: &'static str,
    /// What it is.
    pub value: String,
    /// What it must be (to follow the words `must be`).
    pub allowed: String,
    /// What to do.
    pub remedy: String,
}

/// An error of dispersion `dispersion`, key `key`.
pub(super) fn error(
    dispersion: usize,
    key: &'static str,
    value: impl Into<String>,
    allowed: impl Into<String>,
    remedy: impl Into<String>,
) -> DispersionError {
    DispersionError { dispersion, key, value: value.into(), allowed: allowed.into(), remedy: remedy.into() }
}
