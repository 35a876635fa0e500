//! [`Dispersion`]: what a campaign says about one parameter, as written, and [`DispersionError`]: what is wrong with it.
//!
//! A law of one number at a time becomes a [`super::Distribution`] in [`super::scalar`]; one of several numbers together
//! becomes a [`super::Joint`] in [`super::joint`].

use super::geometric_law::GeometricLaw;
use crate::scene::Parameter;
use std::sync::Arc;

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

/// One bound of a truncated law.
#[derive(Clone, Debug, PartialEq)]
pub enum Bound {
    /// In the parameter's unit (`lower`, `upper`).
    Absolute(Values),
    /// From the nominal, as a fraction of its absolute value (`relative_lower`, `relative_upper`; the lower is below zero).
    Relative(Values),
    /// So many standard deviations from the nominal (`lower_sigmas`, `upper_sigmas`).
    Sigmas(Values),
}

/// Where a normal law is cut off.
#[derive(Clone, Debug, PartialEq)]
pub enum Truncation {
    /// At so many standard deviations on both sides of the nominal (`sigmas`).
    Sigmas(Values),
    /// At bounds; at least one is given.
    Bounds {
        /// Lower bound.
        lower: Option<Bound>,
        /// Upper bound.
        upper: Option<Bound>,
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

/// The interval of a log-uniform law.
#[derive(Clone, Debug, PartialEq)]
pub enum LogRange {
    /// Between two positive numbers in the parameter's unit (`min`, `max`).
    Between {
        /// Lower end.
        min: Values,
        /// Upper end.
        max: Values,
    },
    /// From the nominal divided by a factor to the nominal times it (`factor`).
    Around(Values),
}

/// A distance from the nominal.
#[derive(Clone, Debug, PartialEq)]
pub enum Offset {
    /// In the parameter's unit (`offset`).
    Absolute(Values),
    /// As a fraction of the nominal's absolute value (`relative_offset`).
    Relative(Values),
}

/// A column of a file of numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct DataColumn {
    /// The file, as written.
    pub file: String,
    /// SHA-256 of the file's bytes, hexadecimal.
    pub sha256: String,
    /// The column's name.
    pub column: String,
    /// Its numbers, in the order of the file.
    pub values: Arc<[f64]>,
}

/// What lies between the values of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interpolation {
    /// Nothing: each draw is a value of the file, each as likely as the others.
    None,
    /// A uniform law between neighbours.
    Linear,
}

impl Interpolation {
    /// All values.
    pub const ALL: [Interpolation; 2] = [Interpolation::None, Interpolation::Linear];

    /// The name in campaign files.
    pub const fn name(self) -> &'static str {
        match self {
            Interpolation::None => "none",
            Interpolation::Linear => "linear",
        }
    }
}

/// A law as written.
#[derive(Clone, Debug, PartialEq)]
pub enum Law {
    /// Normal about the nominal.
    Normal(Spread),
    /// Normal about the nominal, truncated.
    TruncatedNormal(Spread, Truncation),
    /// Uniform.
    Uniform(Range),
    /// Normal in the logarithm (`log_std`, and `median`, else the nominal).
    LogNormal {
        /// Standard deviation of the natural logarithm.
        log_std: Values,
        /// Median; the nominal where it is not written.
        median: Option<Values>,
    },
    /// Uniform in the logarithm.
    LogUniform(LogRange),
    /// Triangular (`min`, `max`, and `mode`, else the nominal).
    Triangular {
        /// Lower end.
        min: Values,
        /// Upper end.
        max: Values,
        /// Most likely value; the nominal where it is not written.
        mode: Option<Values>,
    },
    /// Beta law stretched from `min` to `max`, with exponents `alpha` - 1 and `beta` - 1.
    Beta {
        /// First shape parameter.
        alpha: Values,
        /// Second shape parameter.
        beta: Values,
        /// Lower end.
        min: Values,
        /// Upper end.
        max: Values,
    },
    /// PERT: the beta law of shape 1 + 4 (mode - min)/(max - min) and 1 + 4 (max - mode)/(max - min).
    Pert {
        /// Lower end.
        min: Values,
        /// Upper end.
        max: Values,
        /// Most likely value; the nominal where it is not written.
        mode: Option<Values>,
    },
    /// One of a list of values (`values`, and `weights`, else all alike).
    Choice {
        /// The values.
        values: Vec<f64>,
        /// Their weights, in proportion.
        weights: Option<Vec<f64>>,
    },
    /// Another value with some probability (`value`, `probability`), else the nominal.
    Bernoulli {
        /// The other value.
        value: Values,
        /// Its probability.
        probability: Values,
    },
    /// As a column of a file (`file`, `column`, `interpolation`).
    Empirical(DataColumn, Interpolation),
    /// The same distance from the nominal in every sample but the nominal one.
    Offset(Offset),
    /// Attitude uniform over all rotations, of a quaternion as a whole.
    UniformAttitude,
    /// Of a direction or an attitude as a whole.
    Geometric(GeometricLaw),
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

/// Which table of a campaign file an error is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Table {
    /// A `[[disperse]]` table, counted from zero.
    Disperse(usize),
    /// A `[[correlate]]` table, counted from zero.
    Correlate(usize),
    /// A `[[derive]]` table, counted from zero.
    Derive(usize),
    /// The `[design]` table.
    Design,
    /// The `[campaign]` table.
    Campaign,
}

impl std::fmt::Display for Table {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Table::Disperse(index) => write!(f, "disperse[{index}]"),
            Table::Correlate(index) => write!(f, "correlate[{index}]"),
            Table::Derive(index) => write!(f, "derive[{index}]"),
            Table::Design => f.write_str("design"),
            Table::Campaign => f.write_str("campaign"),
        }
    }
}

/// Why a campaign's dispersions cannot be drawn.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{table}.{key} = {value}: must be {allowed}; {remedy}")]
pub struct DispersionError {
    /// Which table.
    pub table: Table,
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
    error_of(Table::Disperse(dispersion), key, value, allowed, remedy)
}

/// An error of any table.
pub(super) fn error_of(
    table: Table,
    key: &'static str,
    value: impl Into<String>,
    allowed: impl Into<String>,
    remedy: impl Into<String>,
) -> DispersionError {
    DispersionError { table, key, value: value.into(), allowed: allowed.into(), remedy: remedy.into() }
}
