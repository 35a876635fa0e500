//! [`Dispersion`]: what a campaign says about one parameter, and [`Dispersions`]: all of it, checked against the nominal scene
//! and ready to be drawn by a [`Sampler`].
//!
//! What is recorded is what was applied: values are written into the scene, made valid as a whole (a quaternion is
//! renormalised) and read back. A draw that is physically impossible is not drawn again: the scene refuses it later.

use super::distribution::{Distribution, TruncatedNormal};
use super::stream::{SampleId, Stream};
use crate::scene::parameter::Kind;
use crate::scene::{Parameter, SceneInput};

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

/// A law as written; a component is independent of every other.
#[derive(Clone, Debug, PartialEq)]
pub enum Law {
    /// Normal about the nominal.
    Normal(Spread),
    /// Normal about the nominal, truncated.
    TruncatedNormal(Spread, Cut),
    /// Uniform.
    Uniform(Range),
}

/// What a campaign says about one parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Dispersion {
    /// The parameter.
    pub parameter: Parameter,
    /// The component that is meant, if not all are.
    pub component: Option<usize>,
    /// The law of its components.
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

/// One number of the scene that a draw writes.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// The parameter.
    pub parameter: Parameter,
    /// Its component.
    pub component: usize,
    /// The nominal value.
    pub nominal: f64,
    /// The law; `None` for a component that only changes with its siblings (the rest of a quaternion).
    pub law: Option<Distribution>,
}

/// Every dispersion of a campaign, ready to be drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct Dispersions {
    seed: u64,
    columns: Vec<Column>,
}

impl Dispersions {
    /// Checks `list` against the `nominal` scene; all errors at once.
    pub fn new(seed: u64, nominal: &SceneInput, list: &[Dispersion]) -> Result<Self, Vec<DispersionError>> {
        let mut columns: Vec<Column> = Vec::new();
        let mut errors = Vec::new();
        for (index, dispersion) in list.iter().enumerate() {
            let parameter = dispersion.parameter;
            let components: Vec<usize> = match dispersion.component {
                Some(component) => vec![component],
                None => (0..parameter.width()).collect(),
            };
            if let Some(missing) = components.iter().find(|component| !parameter.exists(nominal, **component)) {
                errors.push(error(
                    index,
                    "parameter",
                    format!("{:?}", parameter.component_name(*missing)),
                    "a key that the scene has".to_owned(),
                    parameter.remedy().to_owned(),
                ));
                continue;
            }
            let taken = |component: usize| {
                columns.iter().any(|c| (c.parameter, c.component) == (parameter, component) && c.law.is_some())
            };
            if let Some(twice) = components.iter().find(|component| taken(**component)) {
                errors.push(error(
                    index,
                    "parameter",
                    format!("{:?}", parameter.component_name(*twice)),
                    "dispersed once".to_owned(),
                    "delete one of the two [[disperse]] tables, or address different components".to_owned(),
                ));
                continue;
            }
            let nominals: Vec<f64> = components.iter().filter_map(|c| parameter.value(nominal, *c)).collect();
            let laws = match distributions(index, &dispersion.law, &nominals) {
                Ok(laws) => laws,
                Err(error) => {
                    errors.push(error);
                    continue;
                }
            };
            if parameter.kind() == Kind::Quaternion && !columns.iter().any(|c| c.parameter == parameter) {
                columns.extend((0..parameter.width()).map(|component| Column {
                    parameter,
                    component,
                    nominal: parameter.value(nominal, component).unwrap_or(f64::NAN),
                    law: None,
                }));
            }
            for ((component, law), nominal) in components.into_iter().zip(laws).zip(nominals) {
                match columns.iter_mut().find(|c| (c.parameter, c.component) == (parameter, component)) {
                    Some(column) => column.law = Some(law),
                    None => columns.push(Column { parameter, component, nominal, law: Some(law) }),
                }
            }
        }
        if errors.is_empty() { Ok(Dispersions { seed, columns }) } else { Err(errors) }
    }

    /// The numbers that a draw writes, in the order of the file.
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// A sampler for one worker. Allocates; drawing does not.
    pub fn sampler(&self) -> Sampler<'_> {
        let stream = |c: &Column| Stream::new(self.seed, &c.parameter.component_name(c.component));
        Sampler { columns: &self.columns, streams: self.columns.iter().map(stream).collect() }
    }
}

/// Draws samples of [`Dispersions`]; owned by one worker. What it keeps only makes neighbours cheap: a draw depends on the
/// sample alone.
#[derive(Debug)]
pub struct Sampler<'a> {
    columns: &'a [Column],
    streams: Vec<Stream>,
}

impl Sampler<'_> {
    /// Writes every dispersed number of `sample` into `scene`, a copy of the nominal scene or of an earlier draw, and what was
    /// applied into `applied`, one number a column. Sample 0 is nominal.
    ///
    /// # Panics
    /// Where `applied` is not as long as [`Dispersions::columns`].
    pub fn draw(&mut self, sample: SampleId, scene: &mut SceneInput, applied: &mut [f64]) {
        assert_eq!(applied.len(), self.columns.len(), "one applied value a column");
        for (column, stream) in self.columns.iter().zip(&mut self.streams) {
            let value = match &column.law {
                Some(law) if sample != SampleId(0) => law.quantile(stream.uniform(sample)),
                _ => column.nominal,
            };
            column.parameter.set(scene, column.component, value);
        }
        if sample != SampleId(0) {
            for column in self.columns.iter().filter(|column| column.component == 0) {
                column.parameter.settle(scene);
            }
        }
        for (applied, column) in applied.iter_mut().zip(self.columns) {
            *applied = column.parameter.value(scene, column.component).unwrap_or(f64::NAN);
        }
    }
}

fn error(
    dispersion: usize,
    key: &'static str,
    value: impl Into<String>,
    allowed: impl Into<String>,
    remedy: impl Into<String>,
) -> DispersionError {
    DispersionError { dispersion, key, value: value.into(), allowed: allowed.into(), remedy: remedy.into() }
}

/// One number for each of `width` components, or what is wrong.
fn spread_out(index: usize, key: &'static str, values: &Values, width: usize) -> Result<Vec<f64>, DispersionError> {
    let list = match values {
        Values::All(value) => vec![*value; width],
        Values::Each(list) if list.len() == width => list.clone(),
        Values::Each(list) => {
            let parts = if width == 1 { "1 number".to_owned() } else { format!("1 number, or {width} in an array") };
            return Err(error(index, key, format!("{list:?}"), parts, "give one for each component"));
        }
    };
    match list.iter().find(|x| !x.is_finite()) {
        Some(x) => Err(error(index, key, x.to_string(), "finite", "write a finite number")),
        None => Ok(list),
    }
}

/// Widths in the parameter's unit: not negative, and relative ones relative to something.
fn widths(
    index: usize,
    key: &'static str,
    values: &Values,
    nominals: &[f64],
    relative: Option<&str>,
) -> Result<Vec<f64>, DispersionError> {
    let mut list = spread_out(index, key, values, nominals.len())?;
    if let Some(x) = list.iter().find(|x| **x < 0.0) {
        return Err(error(index, key, format!("{x:?}"), ">= 0", "drop the minus sign"));
    }
    if let Some(absolute) = relative {
        if nominals.iter().all(|nominal| *nominal == 0.0) {
            let allowed = "relative to a nominal value other than 0";
            return Err(error(index, key, shown(values), allowed, format!("use {absolute} in the parameter's unit")));
        }
        list.iter_mut().zip(nominals).for_each(|(x, nominal)| *x *= nominal.abs());
    }
    Ok(list)
}

fn shown(values: &Values) -> String {
    match values {
        Values::All(value) => format!("{value:?}"),
        Values::Each(list) => format!("{list:?}"),
    }
}

fn deviations(index: usize, spread: &Spread, nominals: &[f64]) -> Result<Vec<f64>, DispersionError> {
    match spread {
        Spread::Absolute(values) => widths(index, "std", values, nominals, None),
        Spread::Relative(values) => widths(index, "relative_std", values, nominals, Some("std")),
    }
}

/// The law of each component.
fn distributions(index: usize, law: &Law, nominals: &[f64]) -> Result<Vec<Distribution>, DispersionError> {
    let width = nominals.len();
    match law {
        Law::Normal(spread) => {
            let stds = deviations(index, spread, nominals)?;
            Ok(nominals.iter().zip(stds).map(|(mean, std)| Distribution::Normal { mean: *mean, std }).collect())
        }
        Law::TruncatedNormal(spread, cut) => {
            let stds = deviations(index, spread, nominals)?;
            let (lower, upper) = bounds(index, cut, nominals, &stds)?;
            (0..width).map(|k| truncated(index, cut, nominals[k], stds[k], lower[k], upper[k])).collect()
        }
        Law::Uniform(range) => {
            let around = |half: Vec<f64>| {
                let end = |sign: f64| nominals.iter().zip(&half).map(|(x, h)| x + sign * h).collect::<Vec<_>>();
                (end(-1.0), end(1.0))
            };
            let (min, max) = match range {
                Range::Between { min, max } => {
                    let ends = (spread_out(index, "min", min, width)?, spread_out(index, "max", max, width)?);
                    if let Some(k) = (0..width).find(|k| ends.0[*k] >= ends.1[*k]) {
                        let allowed = format!("< max ({:?})", ends.1[k]);
                        return Err(error(index, "min", format!("{:?}", ends.0[k]), allowed, "swap min and max"));
                    }
                    ends
                }
                Range::Around(half) => around(widths(index, "half_width", half, nominals, None)?),
                Range::AroundRelative(half) => {
                    around(widths(index, "relative_half_width", half, nominals, Some("half_width"))?)
                }
            };
            Ok(min.into_iter().zip(max).map(|(min, max)| Distribution::Uniform { min, max }).collect())
        }
    }
}

/// Lower and upper bound of each component of a truncated law.
fn bounds(index: usize, cut: &Cut, nominals: &[f64], stds: &[f64]) -> Result<(Vec<f64>, Vec<f64>), DispersionError> {
    let width = nominals.len();
    match cut {
        Cut::Sigmas(sigmas) => {
            let sigmas = spread_out(index, "sigmas", sigmas, width)?;
            if let Some(x) = sigmas.iter().find(|x| **x <= 0.0) {
                return Err(error(index, "sigmas", format!("{x:?}"), "> 0", "3 cuts 0.27% of the normal law"));
            }
            let end = |sign: f64| (0..width).map(|k| nominals[k] + sign * sigmas[k] * stds[k]).collect();
            Ok((end(-1.0), end(1.0)))
        }
        Cut::Bounds { lower, upper } => {
            let end = |key, values: &Option<Values>, none: f64| match values {
                Some(values) => spread_out(index, key, values, width),
                None => Ok(vec![none; width]),
            };
            let (lower, upper) = (end("lower", lower, f64::NEG_INFINITY)?, end("upper", upper, f64::INFINITY)?);
            match (0..width).find(|k| lower[*k] >= upper[*k]) {
                Some(k) => {
                    let allowed = format!("< upper ({:?})", upper[k]);
                    Err(error(index, "lower", format!("{:?}", lower[k]), allowed, "swap lower and upper"))
                }
                None => Ok((lower, upper)),
            }
        }
    }
}

fn truncated(
    index: usize,
    cut: &Cut,
    mean: f64,
    std: f64,
    lower: f64,
    upper: f64,
) -> Result<Distribution, DispersionError> {
    let key = match cut {
        Cut::Sigmas(_) => "sigmas",
        Cut::Bounds { lower: Some(_), .. } => "lower",
        Cut::Bounds { .. } => "upper",
    };
    let refused = || {
        let allowed =
            format!("bounds with some of the normal law of mean {mean:?} and standard deviation {std:?} between them");
        error(index, key, format!("{lower:?} to {upper:?}"), allowed, "move the bounds to the nominal, or widen them")
    };
    // A nominal that is not a number is the scene's error, and is reported as such.
    if !(mean + std).is_finite() {
        return Ok(Distribution::Normal { mean, std });
    }
    if std == 0.0 {
        let inside = lower <= mean && mean <= upper;
        return if inside { Ok(Distribution::Normal { mean, std }) } else { Err(refused()) };
    }
    TruncatedNormal::new(mean, std, lower, upper).map(Distribution::TruncatedNormal).ok_or_else(refused)
}
