//! `truncated_normal`: normal about the nominal value under the condition that it lies between two bounds.

use super::normal::Spread;
use super::target::Target;
use super::traits::{NumberWords, Quantile, Scalar};
use crate::math::normal::{probability, quantile, quantiles};
use crate::sampling::error::{DispersionError, error};
use crate::sampling::keys::{KeyReader, KeyWriter, Values};

/// One bound of a truncated normal distribution.
#[derive(Clone, Debug, PartialEq)]
pub enum Bound {
    /// In the parameter's unit (`lower`, `upper`).
    Absolute(Values),
    /// From the nominal, as a fraction of its absolute value (`relative_lower`, `relative_upper`; the lower is below zero).
    Relative(Values),
    /// So many standard deviations from the nominal (`lower_sigmas`, `upper_sigmas`).
    Sigmas(Values),
}

/// Where a normal distribution is cut off.
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

/// As written.
#[derive(Clone, Debug, PartialEq)]
pub struct TruncatedNormal(pub Spread, pub Truncation);

/// The keys of a lower and of an upper bound: absolute, relative, in sigmas.
const LOWER_KEYS: [&str; 3] = ["lower", "relative_lower", "lower_sigmas"];
const UPPER_KEYS: [&str; 3] = ["upper", "relative_upper", "upper_sigmas"];

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

/// Ready to be drawn: normal under the condition that the value lies between two bounds. Truncated, not clamped: the bounds carry no
/// probability.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TruncatedNormalQuantile {
    mean: f64,
    /// Negative where the distribution is reflected, so that the interval lies at or below the mean or about it.
    std: f64,
    lower: f64,
    upper: f64,
    /// Probability below, above and between the bounds, after reflection.
    below: f64,
    above: f64,
    between: f64,
}

impl TruncatedNormalQuantile {
    /// The normal distribution of `mean` and `std` > 0 between `lower` < `upper` (either may be infinite); `None` where less than
    /// [`TruncatedNormalQuantile::LEAST`] of the distribution lies between the bounds.
    pub fn new(mean: f64, std: f64, lower: f64, upper: f64) -> Option<Self> {
        let (a, b) = ((lower - mean) / std, (upper - mean) / std);
        // In an upper tail probabilities are 1 minus something and lose their digits: reflect it to a lower tail.
        let (std, a, b) = if a > 0.0 { (-std, -b, -a) } else { (std, a, b) };
        let (below, above) = (probability(a), probability(-b));
        // each form where it does not cancel
        let between = if b <= 0.0 { probability(b) - below } else { 1.0 - below - above };
        (between >= Self::LEAST).then_some(TruncatedNormalQuantile { mean, std, lower, upper, below, above, between })
    }

    /// A distribution of width zero, at its mean; a nominal that is not a number is the scene's error, and is reported as such.
    fn fixed(mean: f64) -> Self {
        TruncatedNormalQuantile {
            mean,
            std: 0.0,
            lower: f64::NEG_INFINITY,
            upper: f64::INFINITY,
            below: 0.0,
            above: 0.0,
            between: 1.0,
        }
    }

    /// The least probability between the bounds: further out than about 8.2 standard deviations the scene that is asked for
    /// has nothing to do with its nominal.
    pub const LEAST: f64 = 1e-16;

    /// The quantile of the lower tail after reflection.
    #[inline]
    fn reflected(&self, u: f64) -> f64 {
        let p = self.below + u * self.between;
        let z = if p <= 0.5 { quantile(p) } else { -quantile(self.above + (1.0 - u) * self.between) };
        // The conditional distribution has no probability outside; this catches a last bit only.
        (self.mean + self.std * z).clamp(self.lower, self.upper)
    }
}

impl Scalar for TruncatedNormal {
    const NAME: &'static str = "truncated_normal";
    type Quantile = TruncatedNormalQuantile;

    fn read(keys: &mut dyn KeyReader) -> Option<Self> {
        let (spread, truncation) = (Spread::read(keys), read_truncation(keys));
        spread.zip(truncation).map(|(spread, truncation)| TruncatedNormal(spread, truncation))
    }

    fn write(&self, keys: &mut dyn KeyWriter) {
        self.0.write(keys);
        match &self.1 {
            Truncation::Sigmas(sigmas) => keys.values("sigmas", sigmas),
            Truncation::Bounds { lower, upper } => {
                for (bound, names) in [(lower, LOWER_KEYS), (upper, UPPER_KEYS)] {
                    match bound {
                        Some(Bound::Absolute(values)) => keys.values(names[0], values),
                        Some(Bound::Relative(values)) => keys.values(names[1], values),
                        Some(Bound::Sigmas(values)) => keys.values(names[2], values),
                        None => {}
                    }
                }
            }
        }
    }

    fn quantiles(&self, target: &Target<'_>) -> Result<Vec<TruncatedNormalQuantile>, DispersionError> {
        let stds = self.0.deviations(target)?;
        let (lower, upper) = bounds(target, &self.1, &stds)?;
        target.all(|k| truncated(target, &self.1, target.nominals[k], stds[k], lower[k], upper[k]))
    }
}

fn read_truncation(keys: &mut dyn KeyReader) -> Option<Truncation> {
    let first = LOWER_KEYS.into_iter().chain(UPPER_KEYS).find(|key| keys.has(key)).unwrap_or(LOWER_KEYS[0]);
    let one = keys.is_one_of(&["sigmas", first], "3");
    let sigmas = keys.optional("sigmas");
    let (lower, upper) = (read_bound(keys, LOWER_KEYS), read_bound(keys, UPPER_KEYS));
    let (sigmas, (lower, upper)) = sigmas.zip(lower.zip(upper))?;
    match (one, sigmas) {
        (false, _) => None,
        (true, Some(sigmas)) => Some(Truncation::Sigmas(sigmas)),
        (true, None) => Some(Truncation::Bounds { lower, upper }),
    }
}

/// The bound that one of three keys gives, if any; `None` where what is written is wrong.
fn read_bound(keys: &mut dyn KeyReader, names: [&'static str; 3]) -> Option<Option<Bound>> {
    let written: Vec<&'static str> = names.into_iter().filter(|key| keys.has(key)).collect();
    if let [_, second, ..] = written[..] {
        keys.refuse(second, &format!("the only one of {}", names.join(", ")), "delete all but one of them");
    }
    let kinds: [fn(Values) -> Bound; 3] = [Bound::Absolute, Bound::Relative, Bound::Sigmas];
    let bounds: Vec<Bound> =
        names.into_iter().zip(kinds).filter_map(|(key, kind)| keys.values(key).map(kind)).collect();
    (written.len() <= 1 && bounds.len() == written.len()).then(|| bounds.into_iter().next())
}

/// Lower and upper bound of each component.
fn bounds(target: &Target<'_>, cut: &Truncation, stds: &[f64]) -> Result<(Vec<f64>, Vec<f64>), DispersionError> {
    let so_many = |key, values: &Values| {
        target.passing(key, values, |x| x > 0.0, "> 0", "3 cuts off 0.27% of the normal distribution")
    };
    let sigmas_away = |sigmas: &[f64], sign: f64| -> Vec<f64> {
        (0..stds.len()).map(|k| target.nominals[k] + sign * sigmas[k] * stds[k]).collect()
    };
    match cut {
        Truncation::Sigmas(sigmas) => {
            let sigmas = so_many("sigmas", sigmas)?;
            Ok((sigmas_away(&sigmas, -1.0), sigmas_away(&sigmas, 1.0)))
        }
        Truncation::Bounds { lower, upper } => {
            let end = |bound: &Option<Bound>, keys: [&'static str; 3], sign: f64| match bound {
                None => Ok(vec![sign * f64::INFINITY; stds.len()]),
                Some(Bound::Absolute(values)) => target.each(keys[0], values),
                Some(Bound::Relative(values)) => {
                    let away = target.relative(keys[1], values, target.each(keys[1], values)?, keys[0])?;
                    Ok(target.nominals.iter().zip(away).map(|(x, away)| x + away).collect())
                }
                Some(Bound::Sigmas(values)) => Ok(sigmas_away(&so_many(keys[2], values)?, sign)),
            };
            let lower = end(lower, LOWER_KEYS, -1.0)?;
            let upper = end(upper, UPPER_KEYS, 1.0)?;
            match lower.iter().zip(&upper).find(|(lower, upper)| lower >= upper) {
                Some((low, high)) => {
                    let allowed = format!("< upper ({high:?})");
                    let larger = "make upper larger, or delete this table";
                    let remedy = if low > high { "swap lower and upper" } else { larger };
                    target.refused(cut_key(cut), format!("{low:?}"), allowed, remedy)
                }
                None => Ok((lower, upper)),
            }
        }
    }
}

fn truncated(
    target: &Target<'_>,
    cut: &Truncation,
    mean: f64,
    std: f64,
    lower: f64,
    upper: f64,
) -> Result<TruncatedNormalQuantile, DispersionError> {
    let refused = || {
        let allowed = format!(
            "bounds with some of the normal distribution of mean {mean:?} and standard deviation {std:?} between them"
        );
        let remedy = "move the bounds to the nominal, or widen them";
        error(target.index, cut_key(cut), format!("{lower:?} to {upper:?}"), allowed, remedy)
    };
    // A nominal that is not a number is the scene's error, and is reported as such.
    if !(mean + std).is_finite() {
        return Ok(TruncatedNormalQuantile::fixed(mean));
    }
    if std == 0.0 {
        let inside = lower <= mean && mean <= upper;
        return if inside { Ok(TruncatedNormalQuantile::fixed(mean)) } else { Err(refused()) };
    }
    TruncatedNormalQuantile::new(mean, std, lower, upper).ok_or_else(refused)
}

impl Quantile for TruncatedNormalQuantile {
    #[inline]
    fn quantile(&self, u: f64) -> f64 {
        self.reflected(if self.std < 0.0 { 1.0 - u } else { u })
    }

    #[inline]
    fn quantiles(&self, u: &[f64; 8], values: &mut [f64; 8]) {
        let (mut tail, mut z) = ([0.0; 8], [0.0; 8]);
        for (tail, u) in tail.iter_mut().zip(u) {
            let u = if self.std < 0.0 { 1.0 - u } else { *u };
            let p = self.below + u * self.between;
            *tail = if p <= 0.5 { p } else { self.above + (1.0 - u) * self.between };
        }
        quantiles(&tail, &mut z);
        for ((value, u), z) in values.iter_mut().zip(u).zip(z) {
            let u = if self.std < 0.0 { 1.0 - u } else { *u };
            let z = if self.below + u * self.between <= 0.5 { z } else { -z };
            *value = (self.mean + self.std * z).max(self.lower).min(self.upper);
        }
    }

    fn text(&self, words: NumberWords<'_>) -> String {
        let [low, high] = [f64::EPSILON, 1.0 - f64::EPSILON].map(|u| (words.amount)(self.quantile(u)));
        format!("truncated normal, {low} to {high}")
    }
}
