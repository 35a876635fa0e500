//! From a law of one number as written ([`Law`]) to its [`Distribution`]: widths in the parameter's unit, bounds in order.

use super::distribution::{Distribution, TruncatedNormal};
use super::law::{Cut, DispersionError, Law, Range, Spread, Values, error};

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

/// The law of each component, or `None` where `law` is one of all components together.
pub(super) fn distributions(
    index: usize,
    law: &Law,
    nominals: &[f64],
) -> Result<Option<Vec<Distribution>>, DispersionError> {
    let width = nominals.len();
    let laws: Vec<Distribution> = match law {
        Law::UniformAttitude => return Ok(None),
        Law::Normal(spread) => {
            let stds = deviations(index, spread, nominals)?;
            nominals.iter().zip(stds).map(|(mean, std)| Distribution::Normal { mean: *mean, std }).collect()
        }
        Law::TruncatedNormal(spread, cut) => {
            let stds = deviations(index, spread, nominals)?;
            let (lower, upper) = bounds(index, cut, nominals, &stds)?;
            let of = |k: usize| truncated(index, cut, nominals[k], stds[k], lower[k], upper[k]);
            (0..width).map(of).collect::<Result<_, _>>()?
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
            min.into_iter().zip(max).map(|(min, max)| Distribution::Uniform { min, max }).collect()
        }
    };
    Ok(Some(laws))
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
