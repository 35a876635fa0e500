//! From a law of one number as written ([`Law`]) to its [`Distribution`]: widths in the parameter's unit, bounds in order.

use super::beta::BetaLaw;
use super::discrete::{Choice, Empirical};
use super::distribution::{Distribution, TruncatedNormal};
use super::law::{Bound, DispersionError, Law, LogRange, Offset, Range, Spread, Truncation, Values, error};

/// Shape parameters of a beta law: outside, the law is a spike or two, and the quantile's series need thousands of terms.
const SHAPES: std::ops::RangeInclusive<f64> = 0.01..=1e4;

/// The law of each component, or `None` where `law` is one of all components together.
pub(super) fn distributions(
    index: usize,
    law: &Law,
    nominals: &[f64],
) -> Result<Option<Vec<Distribution>>, DispersionError> {
    let at = At { index, nominals };
    let laws = match law {
        Law::UniformAttitude | Law::Geometric(_) => return Ok(None),
        Law::Normal(spread) => {
            let stds = at.deviations(spread)?;
            at.all(|k| Ok(Distribution::Normal { mean: nominals[k], std: stds[k] }))
        }
        Law::TruncatedNormal(spread, cut) => {
            let stds = at.deviations(spread)?;
            let (lower, upper) = at.bounds(cut, &stds)?;
            at.all(|k| at.truncated(cut, nominals[k], stds[k], lower[k], upper[k]))
        }
        Law::Uniform(range) => {
            let (min, max) = at.range(range)?;
            at.all(|k| Ok(Distribution::Uniform { min: min[k], max: max[k] }))
        }
        Law::LogNormal { log_std, median } => {
            let log_std = at.not_negative("log_std", log_std)?;
            let medians = at.positive_or_nominal("median", median)?;
            at.all(|k| Ok(Distribution::LogNormal { median: medians[k], log_std: log_std[k] }))
        }
        Law::LogUniform(LogRange::Between { min, max }) => {
            at.positive("min", min)?;
            let (min, max) = at.ends(min, max)?;
            at.all(|k| Ok(Distribution::log_uniform(min[k], max[k])))
        }
        Law::LogUniform(LogRange::Around(factor)) => {
            let factor = at.passing("factor", factor, |x| x > 1.0, "> 1", "2 means from half to twice the nominal")?;
            let middle = at.positive_or_nominal("factor", &None)?;
            at.all(|k| Ok(Distribution::log_uniform(middle[k] / factor[k], middle[k] * factor[k])))
        }
        Law::Triangular { min, max, mode } => {
            let (min, max) = at.ends(min, max)?;
            let mode = at.mode(mode, &min, &max)?;
            at.all(|k| Ok(Distribution::Triangular { min: min[k], mode: mode[k], max: max[k] }))
        }
        Law::Beta { alpha, beta, min, max } => {
            let shape = |key, values| {
                at.passing(key, values, |x| SHAPES.contains(&x), "a number from 0.01 to 1e4", "1 is a uniform law")
            };
            let (alpha, beta) = (shape("alpha", alpha)?, shape("beta", beta)?);
            let (min, max) = at.ends(min, max)?;
            at.all(|k| Ok(Distribution::Beta(BetaLaw::new(alpha[k], beta[k], min[k], max[k]))))
        }
        Law::Pert { min, max, mode } => {
            let (min, max) = at.ends(min, max)?;
            let mode = at.mode(mode, &min, &max)?;
            at.all(|k| Ok(Distribution::Beta(BetaLaw::pert(min[k], mode[k], max[k]))))
        }
        Law::Choice { values, weights } => {
            let choice = at.choice(values, weights.as_deref())?;
            at.all(|_| Ok(Distribution::Choice(choice.clone())))
        }
        Law::Bernoulli { value, probability } => {
            let is_probability = |x| (0.0..=1.0).contains(&x);
            let p = at.passing("probability", probability, is_probability, "from 0 to 1", "0.05 is one in twenty")?;
            let value = at.each("value", value)?;
            at.all(|k| Ok(Distribution::Choice(Choice::new(&[nominals[k], value[k]], &[1.0 - p[k], p[k]]))))
        }
        Law::Empirical(data, interpolation) => {
            let empirical = Empirical::new(&data.values, *interpolation);
            at.all(|_| Ok(Distribution::Empirical(empirical.clone())))
        }
        Law::Offset(offset) => {
            let offsets = match offset {
                Offset::Absolute(values) => at.each("offset", values)?,
                Offset::Relative(values) => {
                    let fractions = at.each("relative_offset", values)?;
                    at.relative("relative_offset", values, fractions, "offset")?
                }
            };
            at.all(|k| Ok(Distribution::Fixed(nominals[k] + offsets[k])))
        }
    };
    laws.map(Some)
}

/// The dispersion whose law is made, and the nominal values of its components.
struct At<'a> {
    index: usize,
    nominals: &'a [f64],
}

type Numbers = Result<Vec<f64>, DispersionError>;

impl At<'_> {
    fn refused<T>(
        &self,
        key: &'static str,
        value: String,
        allowed: impl Into<String>,
        remedy: impl Into<String>,
    ) -> Result<T, DispersionError> {
        Err(error(self.index, key, value, allowed, remedy))
    }

    /// One law for each component.
    fn all(
        &self,
        of: impl Fn(usize) -> Result<Distribution, DispersionError>,
    ) -> Result<Vec<Distribution>, DispersionError> {
        (0..self.nominals.len()).map(of).collect()
    }

    /// One number for each component, or what is wrong.
    fn each(&self, key: &'static str, values: &Values) -> Numbers {
        let width = self.nominals.len();
        let list = match values {
            Values::All(value) => vec![*value; width],
            Values::Each(list) if list.len() == width => list.clone(),
            Values::Each(list) => {
                let parts =
                    if width == 1 { "1 number".to_owned() } else { format!("1 number, or {width} in an array") };
                return self.refused(key, format!("{list:?}"), parts, "give one for each component");
            }
        };
        match list.iter().find(|x| !x.is_finite()) {
            Some(x) => self.refused(key, x.to_string(), "finite", "write a finite number"),
            None => Ok(list),
        }
    }

    /// The same, of numbers that pass a test.
    fn passing(
        &self,
        key: &'static str,
        values: &Values,
        test: impl Fn(f64) -> bool,
        allowed: &str,
        remedy: &str,
    ) -> Numbers {
        let list = self.each(key, values)?;
        match list.iter().find(|x| !test(**x)) {
            Some(x) => self.refused(key, format!("{x:?}"), allowed, remedy),
            None => Ok(list),
        }
    }

    fn not_negative(&self, key: &'static str, values: &Values) -> Numbers {
        self.passing(key, values, |x| x >= 0.0, ">= 0", "drop the minus sign")
    }

    fn positive(&self, key: &'static str, values: &Values) -> Numbers {
        self.passing(key, values, |x| x > 0.0, "> 0", "a logarithm needs a positive number")
    }

    /// The written values, else the nominals, all above zero.
    fn positive_or_nominal(&self, key: &'static str, values: &Option<Values>) -> Numbers {
        if let Some(values) = values {
            return self.positive(key, values);
        }
        match self.nominals.iter().find(|x| **x <= 0.0) {
            Some(x) => {
                let allowed = "used where the nominal is > 0, since it stands for the logarithm's middle";
                self.refused(
                    key,
                    format!("nominal {x:?}"),
                    allowed,
                    "disperse a positive parameter, or use another law",
                )
            }
            None => Ok(self.nominals.to_vec()),
        }
    }

    /// Fractions of the nominal in the parameter's unit.
    fn relative(&self, key: &'static str, written: &Values, fractions: Vec<f64>, absolute: &str) -> Numbers {
        if self.nominals.iter().all(|nominal| *nominal == 0.0) {
            let allowed = "relative to a nominal value other than 0";
            return self.refused(key, shown(written), allowed, format!("use {absolute} in the parameter's unit"));
        }
        Ok(fractions.iter().zip(self.nominals).map(|(x, nominal)| x * nominal.abs()).collect())
    }

    /// Widths in the parameter's unit: not negative, and relative ones relative to something.
    fn widths(&self, key: &'static str, values: &Values, relative: Option<&str>) -> Numbers {
        let list = self.not_negative(key, values)?;
        match relative {
            Some(absolute) => self.relative(key, values, list, absolute),
            None => Ok(list),
        }
    }

    fn deviations(&self, spread: &Spread) -> Numbers {
        match spread {
            Spread::Absolute(values) => self.widths("std", values, None),
            Spread::Relative(values) => self.widths("relative_std", values, Some("std")),
        }
    }

    /// `min` < `max` for each component.
    fn ends(&self, min: &Values, max: &Values) -> Result<(Vec<f64>, Vec<f64>), DispersionError> {
        let (min, max) = (self.each("min", min)?, self.each("max", max)?);
        match min.iter().zip(&max).find(|(min, max)| min >= max) {
            Some((low, high)) => {
                self.refused("min", format!("{low:?}"), format!("< max ({high:?})"), "swap min and max")
            }
            None => Ok((min, max)),
        }
    }

    fn range(&self, range: &Range) -> Result<(Vec<f64>, Vec<f64>), DispersionError> {
        let half = match range {
            Range::Between { min, max } => return self.ends(min, max),
            Range::Around(half) => self.widths("half_width", half, None)?,
            Range::AroundRelative(half) => self.widths("relative_half_width", half, Some("half_width"))?,
        };
        let end = |sign: f64| self.nominals.iter().zip(&half).map(|(x, h)| x + sign * h).collect();
        Ok((end(-1.0), end(1.0)))
    }

    /// The most likely value of each component, between its ends.
    fn mode(&self, mode: &Option<Values>, min: &[f64], max: &[f64]) -> Numbers {
        let modes = match mode {
            Some(mode) => self.each("mode", mode)?,
            None => self.nominals.to_vec(),
        };
        for ((mode, min), max) in modes.iter().zip(min).zip(max) {
            if mode < min || mode > max {
                let allowed = format!("from min ({min:?}) to max ({max:?}); without mode the nominal is meant");
                return self.refused("mode", format!("{mode:?}"), allowed, "write mode, or move min and max");
            }
        }
        Ok(modes)
    }

    fn choice(&self, values: &[f64], weights: Option<&[f64]>) -> Result<Choice, DispersionError> {
        let shown = |list: &[f64]| format!("{list:?}");
        if values.is_empty() || values.iter().any(|x| !x.is_finite()) {
            return self.refused("values", shown(values), "at least one finite number", "write them as [1.0, 2.0]");
        }
        let Some(weights) = weights else { return Ok(Choice::new(values, &vec![1.0; values.len()])) };
        if weights.len() != values.len() {
            let allowed = format!("as many numbers as values ({})", values.len());
            return self.refused("weights", shown(weights), allowed, "give one for each value");
        }
        let sum: f64 = weights.iter().sum();
        if weights.iter().any(|x| !x.is_finite() || *x < 0.0) || sum <= 0.0 || !sum.is_finite() {
            let allowed = "numbers >= 0, not all 0";
            return self.refused("weights", shown(weights), allowed, "their proportions count, not their sum");
        }
        Ok(Choice::new(values, weights))
    }

    /// Lower and upper bound of each component of a truncated law.
    fn bounds(&self, cut: &Truncation, stds: &[f64]) -> Result<(Vec<f64>, Vec<f64>), DispersionError> {
        let so_many =
            |key, values: &Values| self.passing(key, values, |x| x > 0.0, "> 0", "3 cuts 0.27% of the normal law");
        let sigmas_away = |sigmas: &[f64], sign: f64| -> Vec<f64> {
            (0..stds.len()).map(|k| self.nominals[k] + sign * sigmas[k] * stds[k]).collect()
        };
        match cut {
            Truncation::Sigmas(sigmas) => {
                let sigmas = so_many("sigmas", sigmas)?;
                Ok((sigmas_away(&sigmas, -1.0), sigmas_away(&sigmas, 1.0)))
            }
            Truncation::Bounds { lower, upper } => {
                let end = |bound: &Option<Bound>, keys: [&'static str; 3], sign: f64| match bound {
                    None => Ok(vec![sign * f64::INFINITY; stds.len()]),
                    Some(Bound::Absolute(values)) => self.each(keys[0], values),
                    Some(Bound::Relative(values)) => {
                        let away = self.relative(keys[1], values, self.each(keys[1], values)?, keys[0])?;
                        Ok(self.nominals.iter().zip(away).map(|(x, away)| x + away).collect())
                    }
                    Some(Bound::Sigmas(values)) => Ok(sigmas_away(&so_many(keys[2], values)?, sign)),
                };
                let lower = end(lower, LOWER_KEYS, -1.0)?;
                let upper = end(upper, UPPER_KEYS, 1.0)?;
                match lower.iter().zip(&upper).find(|(lower, upper)| lower >= upper) {
                    Some((low, high)) => {
                        let allowed = format!("< upper ({high:?})");
                        self.refused(cut_key(cut), format!("{low:?}"), allowed, "swap lower and upper")
                    }
                    None => Ok((lower, upper)),
                }
            }
        }
    }

    fn truncated(
        &self,
        cut: &Truncation,
        mean: f64,
        std: f64,
        lower: f64,
        upper: f64,
    ) -> Result<Distribution, DispersionError> {
        let refused = || {
            let allowed = format!(
                "bounds with some of the normal law of mean {mean:?} and standard deviation {std:?} between them"
            );
            let remedy = "move the bounds to the nominal, or widen them";
            error(self.index, cut_key(cut), format!("{lower:?} to {upper:?}"), allowed, remedy)
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
}

/// The keys of a lower and of an upper bound: absolute, relative, in sigmas.
pub const LOWER_KEYS: [&str; 3] = ["lower", "relative_lower", "lower_sigmas"];
/// See [`LOWER_KEYS`].
pub const UPPER_KEYS: [&str; 3] = ["upper", "relative_upper", "upper_sigmas"];

/// The key that stands for both bounds in a message.
fn cut_key(cut: &Truncation) -> &'static str {
    let key = |bound: &Bound, keys: [&'static str; 3]| match bound {
        Bound::Absolute(_) => keys[0],
        Bound::Relative(_) => keys[1],
        Bound::Sigmas(_) => keys[2],
    };
    match cut {
        Truncation::Sigmas(_) => "sigmas",
        Truncation::Bounds { lower: Some(lower), .. } => key(lower, LOWER_KEYS),
        Truncation::Bounds { upper: Some(upper), .. } => key(upper, UPPER_KEYS),
        Truncation::Bounds { .. } => "lower",
    }
}

fn shown(values: &Values) -> String {
    match values {
        Values::All(value) => format!("{value:?}"),
        Values::Each(list) => format!("{list:?}"),
    }
}
