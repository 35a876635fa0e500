//! Spearman's rank correlation of two numbers with normal scores of correlation r, and the r for a given rank
//! correlation.
//!
//! In a large sample the rank of a value is its grade G: the probability of smaller values and half of its own. Grades
//! of continuous distributions are the u of the copula, and r = 2 sin(pi rho/6) ([`score_correlation`]). The grade of a
//! discrete distribution is a step function of the score; with steps d_i at scores a_i, e_j at b_j and the bivariate
//! normal density phi_2, dE[G H]/dr = sum d_i e_j phi_2(a_i, b_j; r) (R. L. Plackett, *Biometrika* 41 (1954) 351),
//! integrated from 0 to r over theta = asin r (Z. Drezner & G. O. Wesolowsky, *J. Stat. Comput. Simul.* 35 (1990) 101).
//! Discrete distributions reach rank correlation 1 only with the same steps.

use super::copula::score_correlation;
use super::distribution::Distribution;
use crate::math::normal::quantile;
use core::f64::consts::{FRAC_PI_2, TAU};

#[derive(Clone, Debug, PartialEq)]
enum Grades {
    Continuous,
    /// Steps: probability below each, score, height.
    Steps(Vec<[f64; 3]>),
}

/// Less probable values are joined: the rank correlation changes by about the square.
const FINEST: f64 = 1.0 / 64.0;
/// Errors below 1e-7 for steps more than 0.01 apart.
const INTERVALS: u32 = 128;
/// Ten are usual.
const MOST_STEPS: u32 = 60;
const NEAR: f64 = 1e-9;

impl Grades {
    fn of(distribution: &Distribution) -> Grades {
        let Some(cumulative) = distribution.steps() else { return Grades::Continuous };
        let (mut kept, mut last) = (Vec::new(), 0.0);
        for (index, p) in cumulative.iter().enumerate() {
            // a value is kept if it, or the next one, is probable enough
            let next = cumulative.get(index + 1).copied().unwrap_or(1.0);
            if p - last >= FINEST || next - p >= FINEST {
                kept.push(*p);
                last = *p;
            }
        }
        kept.retain(|p| (f64::EPSILON..1.0 - f64::EPSILON).contains(p));
        let ends = |index: usize| {
            let below = if index == 0 { 0.0 } else { kept[index - 1] };
            (below, kept.get(index + 1).copied().unwrap_or(1.0))
        };
        let step = |index: usize| {
            let (below, above) = ends(index);
            [kept[index], quantile(kept[index]), 0.5 * (above - below)]
        };
        Grades::Steps((0..kept.len()).map(step).collect())
    }

    fn deviation(&self) -> f64 {
        match self {
            Grades::Continuous => (1.0f64 / 12.0).sqrt(),
            Grades::Steps(steps) => {
                let ends = steps.iter().map(|step| step[0]).chain([1.0]);
                let cubes = ends.scan(0.0, |last, p| Some((p - std::mem::replace(last, p)).powi(3)));
                ((1.0 - cubes.sum::<f64>()) / 12.0).sqrt()
            }
        }
    }
}

fn extreme_covariance(a: &Grades, b: &Grades, sign: f64) -> f64 {
    let half = |steps: &[[f64; 3]]| 0.5 * sign * steps.iter().map(|[p, _, d]| d * p * (1.0 - p)).sum::<f64>();
    match (a, b) {
        (Grades::Continuous, Grades::Continuous) => sign / 12.0,
        (Grades::Continuous, Grades::Steps(steps)) | (Grades::Steps(steps), Grades::Continuous) => half(steps),
        (Grades::Steps(a), Grades::Steps(b)) => {
            let both = |p: f64, q: f64| if sign > 0.0 { p.min(q) } else { (p + q - 1.0).max(0.0) };
            a.iter().flat_map(|[p, _, d]| b.iter().map(move |[q, _, e]| d * e * (both(*p, *q) - p * q))).sum()
        }
    }
}

/// Derivative of the covariance of the grades by theta = asin r.
fn slope(a: &Grades, b: &Grades, theta: f64) -> f64 {
    let (sine, cosine) = libm::sincos(theta);
    let mixed = |steps: &[[f64; 3]]| {
        let variance = 2.0 - sine * sine;
        let sum: f64 =
            steps.iter().map(|[_, t, d]| d * libm::exp(-0.5 * t * t - 0.5 * (sine * t) * (sine * t) / variance)).sum();
        cosine * sum / (TAU * variance.sqrt())
    };
    match (a, b) {
        (Grades::Continuous, Grades::Continuous) => cosine / (TAU * (4.0 - sine * sine).sqrt()),
        (Grades::Continuous, Grades::Steps(steps)) | (Grades::Steps(steps), Grades::Continuous) => mixed(steps),
        (Grades::Steps(a), Grades::Steps(b)) => {
            let density = |s: f64, t: f64| {
                // (s^2 + t^2 - 2 s t sin)/(2 cos^2) without cancellation
                let (apart, product) = ((s - t) / cosine, s * t);
                let exponent = 0.5 * apart * apart + product / (1.0 + sine);
                libm::exp(-exponent)
            };
            let sum: f64 = a.iter().flat_map(|[_, s, d]| b.iter().map(move |[_, t, e]| d * e * density(*s, *t))).sum();
            sum / TAU
        }
    }
}

/// At theta = asin r, by Simpson's rule.
fn covariance(a: &Grades, b: &Grades, theta: f64) -> f64 {
    let width = theta / f64::from(INTERVALS);
    let term = |k: u32| {
        let weight = match k {
            0 | INTERVALS => 1.0,
            k if k % 2 == 1 => 4.0,
            _ => 2.0,
        };
        weight * slope(a, b, f64::from(k) * width)
    };
    (0..=INTERVALS).map(term).sum::<f64>() * width / 3.0
}

/// The correlation of the normal scores for a rank correlation; or the lowest and highest possible one.
pub(super) fn scores_of_ranks(rank: f64, a: &Distribution, b: &Distribution) -> Result<f64, [f64; 2]> {
    let (a, b) = (Grades::of(a), Grades::of(b));
    if a == Grades::Continuous && b == Grades::Continuous {
        return Ok(score_correlation(rank));
    }
    let product = a.deviation() * b.deviation();
    if product == 0.0 {
        return if rank == 0.0 { Ok(0.0) } else { Err([0.0; 2]) };
    }
    let scale = 1.0 / product;
    let [low, high] = [-1.0, 1.0].map(|sign| scale * extreme_covariance(&a, &b, sign));
    if rank < low - NEAR || rank > high + NEAR {
        return Err([low, high]);
    }
    if rank == 0.0 {
        return Ok(0.0);
    }
    // regula falsi with halved ordinates (the Illinois variant) between zero and the end on the side of `rank`
    let end = FRAC_PI_2.copysign(rank);
    let (mut near, mut below) = (0.0, -rank);
    let (mut far, mut above) = (end, if rank > 0.0 { high - rank } else { low - rank });
    for _ in 0..MOST_STEPS {
        if above.abs() <= NEAR {
            return Ok(libm::sin(far));
        }
        let middle = (near * above - far * below) / (above - below);
        let found = scale * covariance(&a, &b, middle.clamp(-FRAC_PI_2 + 1e-9, FRAC_PI_2 - 1e-9)) - rank;
        if found.abs() <= NEAR {
            return Ok(libm::sin(middle));
        }
        if (found > 0.0) == (above > 0.0) {
            (far, above) = (middle, found);
            below *= 0.5;
        } else {
            (near, below) = (far, above);
            (far, above) = (middle, found);
        }
    }
    Ok(libm::sin(far))
}

#[cfg(test)]
mod tests {
    use super::super::distribution::choice::Choice;
    use super::super::distribution::normal::Normal;
    use super::*;
    use core::f64::consts::PI;

    fn choice(weights: &[f64]) -> Distribution {
        let values: Vec<f64> = (0..weights.len()).map(|k| k as f64).collect();
        Distribution::Choice(Choice::new(&values, weights))
    }

    fn rank(a: &Distribution, b: &Distribution, r: f64) -> f64 {
        let (a, b) = (Grades::of(a), Grades::of(b));
        covariance(&a, &b, libm::asin(r)) / (a.deviation() * b.deviation())
    }

    /// Truth: Plackett's density integrated in closed form for continuous distributions, and mpmath's bivariate normal
    /// probabilities (30 digits) for steps.
    #[test]
    fn rank_correlations_are_known_ones() {
        let normal = Distribution::Normal(Normal { mean: 0.0, std: 1.0 });
        for r in [-0.9, 0.2, 0.7] {
            // the quadrature over the correlation; measured: 2.9e-11
            assert!((rank(&normal, &normal, r) - 6.0 / PI * libm::asin(0.5 * r)).abs() < 1e-10, "{r}");
        }
        for (a, b, r, expected) in KNOWN {
            let (a, b) = (choice(a), if b.is_empty() { normal.clone() } else { choice(b) });
            // the same, with the digits of the known values; measured: 1.8e-10
            assert!((rank(&a, &b, r) - expected).abs() < 1.5e-9, "{r}: {} {expected}", rank(&a, &b, r));
        }
    }

    /// Weights of one, of the other (none: a normal distribution), r, rank correlation.
    const KNOWN: [(&[f64], &[f64], f64, f64); 4] = [
        (&[1.0, 2.0, 7.0], &[5.0, 5.0], 0.8, 0.53241745830678),
        (&[1.0, 2.0, 7.0], &[1.0, 1.0, 1.0, 1.0], -0.9, -0.692534098489712),
        (&[3.0, 7.0], &[], 0.6, 0.455078008035174),
        (&[1.0, 1.0, 1.0, 1.0, 1.0], &[], -0.95, -0.924616337900792),
    ];
}
