//! `truncated_normal`: normal about the nominal value, conditional on two bounds.

use super::normal::{ONE_SPREAD, SPREAD};
use super::prelude::*;
use crate::math::normal::{probability, quantile, quantiles};

/// Absolute, relative, in sigmas.
const LOWER_KEYS: [&str; 3] = ["lower", "relative_lower", "lower_sigmas"];
const UPPER_KEYS: [&str; 3] = ["upper", "relative_upper", "upper_sigmas"];
const BOTH_KEYS: [&str; 6] = [LOWER_KEYS[0], LOWER_KEYS[1], LOWER_KEYS[2], UPPER_KEYS[0], UPPER_KEYS[1], UPPER_KEYS[2]];

const fn sigmas(key: &'static str, meaning: &'static str) -> Row {
    Row::values(key, meaning).within("> 0", "3 cuts off 0.27% of the normal distribution", above(0.0))
}

fn cut_key(written: &Written) -> &'static str {
    ["sigmas"].into_iter().chain(BOTH_KEYS).find(|key| written.has(key)).unwrap_or("lower")
}

/// Truncated, not clamped: the bounds carry no probability.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TruncatedNormal {
    mean: f64,
    /// Negative after reflection, so that the interval is at or below the mean.
    std: f64,
    lower: f64,
    upper: f64,
    /// Probabilities after reflection.
    below: f64,
    above: f64,
    between: f64,
}

impl TruncatedNormal {
    /// `std` > 0, `lower` < `upper`, which may be infinite; `None` below [`TruncatedNormal::LEAST`].
    pub fn new(mean: f64, std: f64, lower: f64, upper: f64) -> Option<Self> {
        let (a, b) = ((lower - mean) / std, (upper - mean) / std);
        // reflect upper tails, which would lose digits
        let (std, a, b) = if a > 0.0 { (-std, -b, -a) } else { (std, a, b) };
        let (below, above) = (probability(a), probability(-b));
        let between = if b <= 0.0 { probability(b) - below } else { 1.0 - below - above };
        (between >= Self::LEAST).then_some(TruncatedNormal { mean, std, lower, upper, below, above, between })
    }

    fn fixed(mean: f64) -> Self {
        TruncatedNormal {
            mean,
            std: 0.0,
            lower: f64::NEG_INFINITY,
            upper: f64::INFINITY,
            below: 0.0,
            above: 0.0,
            between: 1.0,
        }
    }

    /// Least probability between the bounds: some 8.2 standard deviations.
    pub const LEAST: f64 = 1e-16;

    #[inline]
    fn reflected(&self, u: f64) -> f64 {
        let p = self.below + u * self.between;
        let z = if p <= 0.5 { quantile(p) } else { -quantile(self.above + (1.0 - u) * self.between) };
        (self.mean + self.std * z).clamp(self.lower, self.upper)
    }
}

impl Scalar for TruncatedNormal {
    const NAME: &'static str = "truncated_normal";
    const KEYS: &'static [Row] = &[
        SPREAD[0],
        SPREAD[1],
        SPREAD[2],
        sigmas("sigmas", "Both bounds, as a number of standard deviations from the nominal value"),
        Row::amounts("lower", "Lower bound"),
        Row::values("relative_lower", "Lower bound from the nominal value, as a fraction of it: below zero"),
        sigmas("lower_sigmas", "Lower bound, as a number of standard deviations below the nominal value"),
        Row::amounts("upper", "Upper bound"),
        Row::values("relative_upper", "Upper bound from the nominal value, as a fraction of it"),
        sigmas("upper_sigmas", "Upper bound, as a number of standard deviations above the nominal value"),
    ];
    const RULES: &'static [Rule] = &[
        ONE_SPREAD,
        Rule::One(&[&["sigmas"], &BOTH_KEYS], "3", ALL_BUT_ONE),
        Rule::AtMostOne(&LOWER_KEYS),
        Rule::AtMostOne(&UPPER_KEYS),
    ];
    type Quantile = Self;

    fn of(target: &Target<'_>) -> Result<Vec<Self>> {
        let stds = target.amounts("std", "relative_std")?;
        let (lower, upper) = bounds(target, &stds)?;
        target.all(|k| truncated(target, target.nominals[k], stds[k], lower[k], upper[k]))
    }
}

fn bounds(target: &Target<'_>, stds: &[f64]) -> Result<(Vec<f64>, Vec<f64>)> {
    let end = |[absolute, relative, sigmas]: [&'static str; 3], sign: f64| {
        let away = if target.written.has(sigmas) {
            target.each(sigmas)?.iter().zip(stds).map(|(sigmas, std)| sign * sigmas * std).collect()
        } else if target.written.has(relative) {
            target.amounts(absolute, relative)?
        } else if target.written.has(absolute) {
            return target.each(absolute);
        } else {
            return Ok(vec![sign * f64::INFINITY; stds.len()]);
        };
        Ok(target.nominals.iter().zip(away).map(|(nominal, away): (&f64, f64)| nominal + away).collect())
    };
    if target.written.has("sigmas") {
        let both = ["", "", "sigmas"];
        return Ok((end(both, -1.0)?, end(both, 1.0)?));
    }
    let (lower, upper) = (end(LOWER_KEYS, -1.0)?, end(UPPER_KEYS, 1.0)?);
    match lower.iter().zip(&upper).find(|(lower, upper)| lower >= upper) {
        Some((low, high)) => {
            let larger = "make upper larger, or delete this table";
            let remedy = if low > high { "swap lower and upper" } else { larger };
            target.refused(cut_key(target.written), format!("{low:?}"), format!("< upper ({high:?})"), remedy)
        }
        None => Ok((lower, upper)),
    }
}

fn truncated(target: &Target<'_>, mean: f64, std: f64, lower: f64, upper: f64) -> Result<TruncatedNormal> {
    let refused = || {
        let allowed = format!(
            "bounds with some of the normal distribution of mean {mean:?} and standard deviation {std:?} between them"
        );
        let remedy = "move the bounds to the nominal, or widen them";
        error(target.index, cut_key(target.written), format!("{lower:?} to {upper:?}"), allowed, remedy)
    };
    // NaN is an error of the scene
    if !(mean + std).is_finite() {
        return Ok(TruncatedNormal::fixed(mean));
    }
    if std == 0.0 {
        let inside = lower <= mean && mean <= upper;
        return if inside { Ok(TruncatedNormal::fixed(mean)) } else { Err(refused()) };
    }
    TruncatedNormal::new(mean, std, lower, upper).ok_or_else(refused)
}

impl Quantile for TruncatedNormal {
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
        format!("truncated normal, std {}, {low} to {high}", (words.amount)(self.std.abs()))
    }
}
